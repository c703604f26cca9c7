// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/scratch.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/status.h"

namespace eyrie::terrain {
namespace {

std::size_t wholePages(std::size_t bytes) {
    constexpr std::size_t kPage = 4096;
    return (bytes + kPage - 1) / kPage * kPage;
}

/// Addresses for pieces. They are asked for many pieces at a time and kept for good, since the
/// system takes longer to change what is mapped where than to take memory from it. Of the pieces
/// given back a few of each size keep their memory, too, to be used again at once.
class SparePieces {
public:
    std::byte* take(std::size_t bytes) {
        std::unique_lock lock(mutex_);
        Spare& spare = spare_[bytes];
        if (!spare.withMemory.empty())
            return last(spare.withMemory);
        if (spare.empty.empty())
            addTo(spare.empty, bytes);
        std::byte* const piece = last(spare.empty);
        lock.unlock();
        madvise(piece, bytes, MADV_POPULATE_WRITE);  // quicker than page by page, if it is known
        return piece;
    }

    void giveBack(std::byte* piece, std::size_t bytes) {
        constexpr std::size_t kMostSpareBytes = 2 << 20;
        std::unique_lock lock(mutex_);
        Spare& spare = spare_[bytes];
        if ((spare.withMemory.size() + 1) * bytes <= kMostSpareBytes) {
            spare.withMemory.push_back(piece);
            return;
        }
        lock.unlock();
        madvise(piece, bytes, MADV_DONTNEED);
        lock.lock();
        spare.empty.push_back(piece);
    }

private:
    struct Spare {
        std::vector<std::byte*> withMemory;
        std::vector<std::byte*> empty;
    };

    static std::byte* last(std::vector<std::byte*>& pieces) {
        std::byte* const piece = pieces.back();
        pieces.pop_back();
        return piece;
    }

    static void addTo(std::vector<std::byte*>& pieces, std::size_t bytes) {
        constexpr std::size_t kPieces = 64;
        void* const fresh = mmap(nullptr, kPieces * bytes, PROT_READ | PROT_WRITE,
                                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (fresh == MAP_FAILED)
            throw std::bad_alloc();
        madvise(fresh, kPieces * bytes, MADV_NOHUGEPAGE);  // a part could not be given back
        for (std::size_t k = kPieces; k-- > 0;)
            pieces.push_back(static_cast<std::byte*>(fresh) + k * bytes);
    }

    std::mutex mutex_;                    ///< guards spare_
    std::map<std::size_t, Spare> spare_;  // by bytes
};

SparePieces& sparePieces() {
    static SparePieces spare;
    return spare;
}

/// Never 0, which stands for none; a piece's at another place is another.
std::uint64_t checksumOf(std::uint64_t place, std::span<const std::byte> piece) {
    return std::max<std::uint64_t>(1, XXH64(piece.data(), piece.size(), place));
}

std::span<std::byte> bytesOf(std::uint64_t& checksum) {
    return std::as_writable_bytes(std::span(&checksum, 1));
}

bool isZeros(std::span<const std::byte> bytes) {
    return std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace

std::shared_ptr<std::byte[]> Scratch::newPiece(std::size_t bytes) {
    const std::size_t whole = wholePages(bytes);
    return {sparePieces().take(whole),
            [whole](std::byte* piece) { sparePieces().giveBack(piece, whole); }};
}

Scratch::Scratch(std::string path, std::uint64_t budgetBytes)
    : path_(std::move(path)), budget_(budgetBytes) {}

/// Of an unlinked file it is the system that takes its time, as it does for memory given back.
Scratch::~Scratch() {
    const std::jthread closing([this] {
        if (fd_ >= 0)
            close(fd_);
    });
    for (Shard& shard : shards_) shard.byUse.clear();
}

std::uint64_t Scratch::reserve(std::size_t bytes, std::uint64_t pieces) {
    constexpr std::uint64_t kAlignment = 4096;
    const std::uint64_t place = reserved_;
    reserved_ += (stride(bytes) * pieces + kAlignment - 1) / kAlignment * kAlignment;
    return place;
}

bool Scratch::takeUp(std::uint64_t bytes) {
    struct stat status {};
    if (file() >= 0 && fstat(fd_, &status) == 0 &&
        static_cast<std::uint64_t>(status.st_size) >= bytes) {
        stored_ = bytes;
        return true;
    }
    if (fd_ >= 0)
        close(fd_.exchange(-1));
    return false;
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

/// A file that was there before may hold something else.
void Scratch::clear(std::uint64_t place, std::size_t bytes) {
    forget(place);
    const std::shared_ptr<std::byte[]> data = newPiece(bytes);
    const std::span<std::byte> all(data.get(), bytes);
    loadBytes(place, all);
    std::uint64_t checksum = 0;
    loadBytes(place + bytes, bytesOf(checksum));
    if (checksum == 0 && isZeros(all))
        return;
    std::ranges::fill(all, std::byte{0});
    write(place, data, bytes);
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
        fd_ = open(path_.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | flags, 0644);
    return fd_;
}

void Scratch::store(std::uint64_t place, const Piece& data, std::size_t bytes) {
    std::uint64_t checksum = checksumOf(place, {data.get(), bytes});
    storeBytes(place, {data.get(), bytes});
    storeBytes(place + bytes, bytesOf(checksum));
    const std::uint64_t end = place + stride(bytes);
    std::uint64_t known = stored_;
    while (known < end && !stored_.compare_exchange_weak(known, end)) {
    }
}

void Scratch::storeBytes(std::uint64_t place, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done =
            pwrite(file(O_CREAT), bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return fail("scratch file cannot be written");
        bytes = bytes.subspan(static_cast<std::size_t>(done));
        place += static_cast<std::uint64_t>(done);
    }
}

/// A hole of the file has neither a piece nor a checksum.
void Scratch::load(std::uint64_t place, std::span<std::byte> out) {
    loadBytes(place, out);
    std::uint64_t checksum = 0;
    loadBytes(place + out.size(), bytesOf(checksum));
    if (checksum == 0 ? isZeros(out) : checksum == checksumOf(place, out))
        return;
    fail(absl::DataLossError(fmt::format(
        "{}: scratch file has something else than what was written to it; see that nothing else "
        "writes there, then run the same command again",
        path_)));
    std::ranges::fill(out, std::byte{0});
}

/// What was never written reads as zeros, as holes of a file do, also beyond its end.
void Scratch::loadBytes(std::uint64_t place, std::span<std::byte> out) {
    const std::uint64_t stored = stored_;  // of old: others write more meanwhile
    std::size_t have = 0;
    while (have < out.size() && (file() >= 0 || errno != ENOENT)) {
        const ssize_t got =
            pread(file(), out.data() + have, out.size() - have, static_cast<off_t>(place + have));
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            fail("scratch file cannot be read");
        if (got == 0 && place + have < stored)
            fail(absl::DataLossError(fmt::format(
                "{}: scratch file is shorter than what was written to it; see that nothing else "
                "writes there, then run the same command again",
                path_)));
        if (got <= 0)
            break;
        have += static_cast<std::size_t>(got);
    }
    std::memset(out.data() + have, 0, out.size() - have);
}

void Scratch::fail(const char* what) {
    const int error = errno;
    absl::Status status = fabric::writeError(path_, what, error);
    if (absl::IsResourceExhausted(status))
        status = absl::ResourceExhaustedError(fmt::format(
            "{}: {}: {}; free some space and run the same command again: it goes on from "
            "here; or start over with --scratch on another disk",
            path_, what, std::strerror(error)));
    fail(std::move(status));
}

/// The first failure counts.
void Scratch::fail(absl::Status status) {
    const std::lock_guard lock(fileMutex_);
    if (!hasFailed_.exchange(true))
        status_ = std::move(status);
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

absl::StatusOr<std::uint64_t> Scratch::flush() {
    for (Shard& shard : shards_) storeDirty(shard);
    const std::uint64_t bytes = stored_;  // others may write more meanwhile
    if (!hasFailed_ && fdatasync(file(O_CREAT)) != 0)
        fail("scratch file cannot be flushed to disk");
    RETURN_IF_ERROR(status());
    return bytes;
}

absl::Status Scratch::status() const {
    if (!hasFailed_)
        return absl::OkStatus();
    const std::lock_guard lock(fileMutex_);
    return status_;
}

}  // namespace eyrie::terrain
