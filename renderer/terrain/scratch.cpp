// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/scratch.h"

#include <cerrno>
#include <cstring>
#include <map>
#include <new>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::terrain {
namespace {

std::size_t wholePages(std::size_t bytes) {
    constexpr std::size_t kPage = 4096;
    return (bytes + kPage - 1) / kPage * kPage;
}

/// Pieces just given back, to be used again without asking the system: a few of each size.
class SparePieces {
public:
    ~SparePieces() {
        for (auto& [bytes, pieces] : spare_)
            for (std::byte* const piece : pieces) munmap(piece, bytes);
    }

    std::byte* take(std::size_t bytes) {
        {
            const std::lock_guard lock(mutex_);
            std::vector<std::byte*>& pieces = spare_[bytes];
            if (!pieces.empty()) {
                std::byte* const piece = pieces.back();
                pieces.pop_back();
                return piece;
            }
        }
        void* const fresh = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
        if (fresh == MAP_FAILED)
            throw std::bad_alloc();
        return static_cast<std::byte*>(fresh);
    }

    void giveBack(std::byte* piece, std::size_t bytes) {
        constexpr std::size_t kMostSpareBytes = 2 << 20;
        {
            const std::lock_guard lock(mutex_);
            std::vector<std::byte*>& pieces = spare_[bytes];
            if ((pieces.size() + 1) * bytes <= kMostSpareBytes) {
                pieces.push_back(piece);
                return;
            }
        }
        munmap(piece, bytes);
    }

private:
    std::mutex mutex_;                                      ///< guards spare_
    std::map<std::size_t, std::vector<std::byte*>> spare_;  // by bytes
};

SparePieces& sparePieces() {
    static SparePieces spare;
    return spare;
}

}  // namespace

std::shared_ptr<std::byte[]> Scratch::newPiece(std::size_t bytes) {
    const std::size_t whole = wholePages(bytes);
    return {sparePieces().take(whole),
            [whole](std::byte* piece) { sparePieces().giveBack(piece, whole); }};
}

Scratch::Scratch(std::string path, std::uint64_t budgetBytes)
    : path_(std::move(path)), budget_(budgetBytes) {}

Scratch::~Scratch() {
    if (fd_ >= 0)
        close(fd_);
}

std::uint64_t Scratch::reserve(std::uint64_t bytes) {
    constexpr std::uint64_t kAlignment = 4096;
    const std::uint64_t place = reserved_;
    reserved_ += (bytes + kAlignment - 1) / kAlignment * kAlignment;
    return place;
}

Scratch::Piece Scratch::read(std::uint64_t place, std::size_t bytes) {
    Shard& shard = shardOf(place);
    const std::lock_guard lock(shard.mutex);
    if (const auto found = shard.byPlace.find(place); found != shard.byPlace.end()) {
        shard.byUse.splice(shard.byUse.begin(), shard.byUse, found->second);
        return found->second->data;
    }
    const std::shared_ptr<std::byte[]> data = newPiece(bytes);
    load(place, {data.get(), bytes});
    keep(shard, {place, data, bytes, false});
    return data;
}

void Scratch::write(std::uint64_t place, Piece data, std::size_t bytes) {
    Shard& shard = shardOf(place);
    const std::lock_guard lock(shard.mutex);
    drop(shard, place);
    keep(shard, {place, std::move(data), bytes, true});
}

void Scratch::forget(std::uint64_t place) {
    Shard& shard = shardOf(place);
    const std::lock_guard lock(shard.mutex);
    drop(shard, place);
}

/// Precondition: the shard's mutex is held.
void Scratch::drop(Shard& shard, std::uint64_t place) {
    const auto found = shard.byPlace.find(place);
    if (found == shard.byPlace.end())
        return;
    shard.bytes -= wholePages(found->second->bytes);
    shard.byUse.erase(found->second);
    shard.byPlace.erase(found);
}

/// Precondition: the shard's mutex is held, and the place is not in it.
void Scratch::keep(Shard& shard, Entry entry) {
    shard.bytes += wholePages(entry.bytes);
    shard.byUse.push_front(std::move(entry));
    shard.byPlace[shard.byUse.front().place] = shard.byUse.begin();
    if (fitsInMemory())
        return;
    while (shard.bytes > budget_ / kShards && shard.byUse.size() > 1) {
        const Entry& oldest = shard.byUse.back();
        if (oldest.isDirty)
            store(oldest.place, oldest.data, oldest.bytes);
        shard.bytes -= wholePages(oldest.bytes);
        shard.byPlace.erase(oldest.place);
        shard.byUse.pop_back();
    }
}

/// Made with `flags` O_CREAT; without, -1 while there is none.
int Scratch::file(int flags) {
    if (fd_ >= 0)
        return fd_;
    const std::lock_guard lock(fileMutex_);
    if (fd_ < 0)
        fd_ = open(path_.c_str(), O_RDWR | O_CLOEXEC | flags, 0644);
    return fd_;
}

void Scratch::store(std::uint64_t place, const Piece& data, std::size_t bytes) {
    const std::byte* next = data.get();
    std::size_t left = bytes;
    auto offset = static_cast<off_t>(place);
    while (left > 0) {
        const ssize_t done = pwrite(file(O_CREAT), next, left, offset);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return fail("scratch file cannot be written");
        next += done;
        left -= static_cast<std::size_t>(done);
        offset += done;
    }
}

/// What was never written reads as zeros, as holes of a file do.
void Scratch::load(std::uint64_t place, std::span<std::byte> out) {
    std::size_t have = 0;
    while (have < out.size() && (file() >= 0 || errno != ENOENT)) {
        const ssize_t got =
            pread(file(), out.data() + have, out.size() - have, static_cast<off_t>(place + have));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            fail("scratch file cannot be read");
        if (got <= 0)
            break;
        have += static_cast<std::size_t>(got);
    }
    std::memset(out.data() + have, 0, out.size() - have);
}

void Scratch::fail(const char* what) {
    const int error = errno;
    const std::lock_guard lock(fileMutex_);
    if (hasFailed_.exchange(true))
        return;
    status_ = fabric::writeError(path_, what, error);
    if (absl::IsResourceExhausted(status_))
        status_ = absl::ResourceExhaustedError(
            fmt::format("{}: {}: {}; free some space or name a folder on another disk with "
                        "--scratch, then run the same command again: it goes on from here",
                        path_, what, std::strerror(error)));
}

/// Nobody waits while the disk is written to: the mutex is not held then.
void Scratch::storeDirty(Shard& shard) {
    std::vector<std::uint64_t> dirty;
    {
        const std::lock_guard lock(shard.mutex);
        for (const Entry& entry : shard.byUse)
            if (entry.isDirty)
                dirty.push_back(entry.place);
    }
    for (const std::uint64_t place : dirty) {
        Piece data;
        std::size_t bytes = 0;
        const auto find = [&] {
            const auto found = shard.byPlace.find(place);
            return found == shard.byPlace.end() ? shard.byUse.end() : found->second;
        };
        {
            const std::lock_guard lock(shard.mutex);
            const auto entry = find();
            if (entry == shard.byUse.end() || !entry->isDirty)
                continue;
            data = entry->data;
            bytes = entry->bytes;
        }
        store(place, data, bytes);
        const std::lock_guard lock(shard.mutex);
        if (const auto entry = find(); entry != shard.byUse.end() && entry->data == data)
            entry->isDirty = false;
    }
}

absl::Status Scratch::flush() {
    for (Shard& shard : shards_) storeDirty(shard);
    if (!hasFailed_ && fdatasync(file(O_CREAT)) != 0)
        fail("scratch file cannot be flushed to disk");
    return status();
}

absl::Status Scratch::status() const {
    if (!hasFailed_)
        return absl::OkStatus();
    const std::lock_guard lock(fileMutex_);
    return status_;
}

}  // namespace eyrie::terrain
