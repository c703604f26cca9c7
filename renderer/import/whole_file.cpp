// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

constexpr const char* kMark = ".partial-";

/// Takes the lock that a living writer holds.
bool lock(int fd) {
    struct stat status {};
    return flock(fd, LOCK_EX | LOCK_NB) == 0 && fstat(fd, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

WholeFile::WholeFile(std::string path, std::string partialPath, int fd)
    : path_(std::move(path)), partialPath_(std::move(partialPath)), fd_(fd) {}

WholeFile::WholeFile(WholeFile&& other) noexcept
    : path_(std::move(other.path_)),
      partialPath_(std::move(other.partialPath_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_) {}

WholeFile::~WholeFile() {
    if (fd_ < 0)
        return;
    unlink(partialPath_.c_str());
    close(fd_);
}

/// Between its making and its lock another writer may take a file for abandoned and remove it: then
/// one of another name is made.
absl::StatusOr<WholeFile> WholeFile::create(const std::string& path) {
    constexpr int kTries = 16;
    removeAbandoned(path);
    std::random_device random;
    for (int i = 0; i < kTries; ++i) {
        const std::uint64_t number = std::uint64_t{random()} << 32 | random();
        std::string partialPath = fmt::format("{}{}{:016x}", path, kMark, number);
        const int fd = open(partialPath.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        if (fd < 0)
            return fabric::writeError(path, "cannot be written", errno);
        WholeFile file(path, std::move(partialPath), fd);
        errno = 0;
        // Where a file system has no locks, nobody can take it for abandoned either.
        if (lock(fd) || errno == ENOLCK || errno == EOPNOTSUPP)
            return file;
    }
    return absl::UnavailableError(fmt::format(
        "{}: other processes take its partial files for abandoned; run the same command "
        "again",
        path));
}

absl::Status WholeFile::append(std::span<const std::byte> bytes) {
    RETURN_IF_ERROR(writeAt(size_, bytes));
    size_ += bytes.size();
    return absl::OkStatus();
}

absl::Status WholeFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done = pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return fabric::writeError(path_, "cannot be written", errno);
        bytes = bytes.subspan(static_cast<std::size_t>(done));
        offset += static_cast<std::uint64_t>(done);
    }
    return absl::OkStatus();
}

absl::Status WholeFile::commit() {
    if (fsync(fd_) != 0)
        return fabric::writeError(path_, "cannot be flushed to disk", errno);
    if (std::rename(partialPath_.c_str(), path_.c_str()) != 0)
        return fabric::writeError(path_, "cannot be renamed from its partial file", errno);
    close(std::exchange(fd_, -1));
    return absl::OkStatus();
}

void removeAbandoned(const std::string& path) {
    namespace fs = std::filesystem;
    const fs::path whole = fs::absolute(path);
    const std::string mark = whole.filename().string() + kMark;
    std::error_code error;
    for (fs::directory_iterator entry(whole.parent_path(), error), end; !error && entry != end;
         entry.increment(error)) {
        if (!entry->path().filename().string().starts_with(mark))
            continue;
        const int fd = open(entry->path().c_str(), O_RDWR | O_CLOEXEC);
        if (fd < 0)
            continue;
        if (lock(fd))
            unlink(entry->path().c_str());
        close(fd);
    }
}

}  // namespace eyrie::import
