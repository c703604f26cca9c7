// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/import_journal.h"

#include <cerrno>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include "fabric/status.h"
#include "fabric/writer_lock.h"

namespace eyrie::import {
namespace {

struct Header {
    std::array<char, 8> magic = {'E', 'Y', 'R', 'I', 'E', 'J', 'N', 'L'};
    std::uint64_t version = 3;
    std::uint64_t key = 0;

    bool operator==(const Header&) const = default;
};

struct RecordHeader {
    std::uint64_t step = 0;
    std::uint64_t bytes = 0;
    std::uint64_t resultBytes = 0;
    std::uint64_t checksum = 0;  ///< XXH64 of the state, seeded with that of what is above
};

std::uint64_t checksumOf(const RecordHeader& record, std::span<const std::byte> state) {
    return XXH64(state.data(), state.size(), XXH64(&record, offsetof(RecordHeader, checksum), 0));
}

std::size_t readUpTo(int fd, void* out, std::size_t bytes, std::uint64_t offset) {
    std::size_t have = 0;
    while (have < bytes) {
        const ssize_t got = pread(fd, static_cast<char*>(out) + have, bytes - have,
                                  static_cast<off_t>(offset + have));
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        have += static_cast<std::size_t>(got);
    }
    return have;
}

/// Who held the lock may have been done, and have removed the file, since it was opened: then
/// another is made.
absl::StatusOr<int> openLocked(const std::string& path) {
    constexpr int kTries = 16;
    for (int i = 0; i < kTries; ++i) {
        const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
        if (fd < 0)
            return fabric::writeError(path, "cannot be written", errno);
        const fabric::WriterLock lock = fabric::takeWriterLock(path, fd);
        if (fabric::mayWrite(lock))
            return fd;
        close(fd);
        if (lock == fabric::WriterLock::Anothers)
            break;
    }
    return absl::FailedPreconditionError(fmt::format(
        "{}: another import into the same file is at work; wait for it, or stop it", path));
}

}  // namespace

ImportJournal::ImportJournal(ImportJournal&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      key_(other.key_),
      steps_(std::move(other.steps_)) {}

ImportJournal::~ImportJournal() {
    if (fd_ >= 0)
        close(fd_);
}

absl::StatusOr<ImportJournal> ImportJournal::open(const std::string& path, std::uint64_t key,
                                                  bool startsOver) {
    ASSIGN_OR_RETURN(const int fd, openLocked(path));
    ImportJournal journal(path, fd, key);
    if (!startsOver)
        journal.read();
    if (!journal.isEmpty())
        return journal;
    if (const absl::Status cleared = journal.clear(); !cleared.ok()) {
        journal.remove();  // on a full disk: it says nothing
        return cleared;
    }
    return journal;
}

void ImportJournal::read() {
    struct stat status {};
    Header header;
    if (fstat(fd_, &status) != 0 || readUpTo(fd_, &header, sizeof header, 0) != sizeof header ||
        header != Header{.key = key_})
        return;
    const auto size = static_cast<std::uint64_t>(status.st_size);
    std::uint64_t offset = sizeof header;  // end of the last whole record
    RecordHeader record;
    while (readUpTo(fd_, &record, sizeof record, offset) == sizeof record) {
        const std::uint64_t first = offset + sizeof record;
        if (record.bytes > size - first)
            break;
        std::vector<std::byte> state(record.bytes);
        if (readUpTo(fd_, state.data(), state.size(), first) != state.size() ||
            checksumOf(record, state) != record.checksum)
            break;
        steps_[static_cast<std::uint32_t>(record.step)] = {offset, record.resultBytes,
                                                           std::move(state)};
        offset = first + record.bytes;
    }
    if (ftruncate(fd_, static_cast<off_t>(steps_.empty() ? 0 : offset)) == 0)
        lseek(fd_, 0, SEEK_END);
}

const std::vector<std::byte>* ImportJournal::find(std::uint32_t step) const {
    const auto found = steps_.find(step);
    return found == steps_.end() ? nullptr : &found->second.state;
}

std::uint64_t ImportJournal::resultBytes() const {
    return steps_.empty() ? 0 : steps_.rbegin()->second.resultBytes;
}

absl::Status ImportJournal::dropFrom(std::uint32_t step) {
    const auto first = steps_.lower_bound(step);
    if (first == steps_.end())
        return absl::OkStatus();
    if (ftruncate(fd_, static_cast<off_t>(first->second.offset)) != 0 ||
        lseek(fd_, 0, SEEK_END) < 0 || fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot be cut", errno);
    steps_.erase(first, steps_.end());
    return absl::OkStatus();
}

absl::Status ImportJournal::append(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done = write(fd_, bytes.data(), bytes.size());
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return fabric::writeError(path_, "cannot be written", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(done));
    }
    return absl::OkStatus();
}

absl::Status ImportJournal::add(std::uint32_t step, std::span<const std::byte> state,
                                std::uint64_t resultBytes) {
    RecordHeader record{step, state.size(), resultBytes};
    record.checksum = checksumOf(record, state);
    RETURN_IF_ERROR(append(std::as_bytes(std::span(&record, 1))));
    RETURN_IF_ERROR(append(state));
    if (fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot be flushed to disk", errno);
    return absl::OkStatus();
}

absl::Status ImportJournal::clear() {
    steps_.clear();
    if (ftruncate(fd_, 0) != 0 || lseek(fd_, 0, SEEK_SET) != 0)
        return fabric::writeError(path_, "cannot be emptied", errno);
    const Header header{.key = key_};
    return append(std::as_bytes(std::span(&header, 1)));
}

void ImportJournal::remove() { unlink(path_.c_str()); }

}  // namespace eyrie::import
