// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <utility>

#include <absl/status/statusor.h>

namespace eyrie::mesh {

/// A file that appears under its name only when it is complete.
///
/// Bytes go to a file of its own beside it, see fabric::createPartial; commit() flushes that to the
/// disk and renames it. Without a successful commit the partial file is removed. What is no file (a
/// device, a pipe) and the process's own output (`/dev/stdout`) are written as bytes come: nothing
/// takes their place.
class OutputFile {
public:
    /// Once `stop` asks for it, nothing waits any more for room in a pipe that is not read.
    /// Errors: InvalidArgument (a folder has this name), NotFound (no such folder),
    /// PermissionDenied, Unavailable.
    static absl::StatusOr<OutputFile> create(const std::string& path, std::stop_token stop = {});
    /// Whether create() would do. Leaves pipes alone: who reads one would see it end. Errors: as
    /// above.
    static absl::Status check(const std::string& path);
    /// One that never gets a name, on the disk of `path`: for what is read back, and gone with the
    /// object or the process, however that ends. commit() is not for it. Errors: as above.
    static absl::StatusOr<OutputFile> createUnnamed(const std::string& path);

    OutputFile(OutputFile&& other) noexcept
        : path_(std::move(other.path_)),
          partialPath_(std::move(other.partialPath_)),
          fd_(std::exchange(other.fd_, -1)),
          size_(other.size_),
          isUnnamed_(other.isUnnamed_),
          isPipe_(other.isPipe_),
          stop_(std::move(other.stop_)) {}
    OutputFile& operator=(OutputFile&& other) noexcept {
        std::swap(path_, other.path_);
        std::swap(partialPath_, other.partialPath_);
        std::swap(fd_, other.fd_);
        std::swap(size_, other.size_);
        std::swap(isUnnamed_, other.isUnnamed_);
        std::swap(isPipe_, other.isPipe_);
        std::swap(stop_, other.stop_);
        return *this;
    }
    ~OutputFile();

    /// Appends. Errors: ResourceExhausted (disk full), Unavailable; Cancelled (`stop`, of a pipe).
    absl::Status write(std::span<const std::byte> bytes);
    /// Appends zeros up to the next multiple of `alignment`.
    absl::Status padTo(std::uint64_t alignment);
    absl::Status commit();

    /// Puts bytes at a place, wherever write() is; what is left out before it reads as zeros.
    /// size() does not count them. Errors: as write(); InvalidArgument (a pipe).
    absl::Status writeAt(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Of an unnamed file; zeros past its end. Any thread may read. Errors: Unavailable.
    absl::Status readAt(std::uint64_t offset, std::span<std::byte> bytes) const;

    std::uint64_t size() const { return size_; }
    const std::string& path() const { return path_; }

private:
    OutputFile(std::string path, std::string partialPath, int fd, bool isUnnamed = false)
        : path_(std::move(path)),
          partialPath_(std::move(partialPath)),
          fd_(fd),
          isUnnamed_(isUnnamed) {}

    absl::Status awaitRoom() const;

    std::string path_;
    std::string partialPath_;  ///< empty: unnamed, or written in its place
    int fd_;
    std::uint64_t size_ = 0;
    bool isUnnamed_;
    bool isPipe_ = false;
    std::stop_token stop_;
};

}  // namespace eyrie::mesh
