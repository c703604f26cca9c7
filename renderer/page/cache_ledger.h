// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include <absl/status/statusor.h>

namespace eyrie::page {

/// Owns a file descriptor; negative: none.
class Descriptor {
public:
    explicit Descriptor(int fd = -1) : fd_(fd) {}
    ~Descriptor();
    Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
    Descriptor& operator=(Descriptor&&) = delete;
    int get() const { return fd_; }

private:
    int fd_;
};

/// The books of a cache folder, held by one process and thread while this object lives: the sum of
/// the sizes of all parts, kept in the file that is locked.
class CacheLedger {
public:
    /// Waits for the lock. An error when the folder cannot be made or written to.
    static absl::StatusOr<CacheLedger> lock(const std::filesystem::path& folder);

    CacheLedger(CacheLedger&&) = default;

    /// Adds up what is there, removing what writers that were killed have left.
    void count();
    /// Drops what has not been used longest until `bytes` more fit. False when they never will.
    bool makeRoom(std::uint64_t bytes, std::uint64_t limitBytes);
    void add(std::uint64_t bytes);
    /// Removes a part, if it is there.
    void remove(const std::filesystem::path& part);

private:
    CacheLedger(std::filesystem::path folder, Descriptor file);
    void write() const;

    std::filesystem::path folder_;
    Descriptor file_;
    std::uint64_t total_ = 0;
};

/// Name of what is being written: beside the parts, so that a rename puts it in its place.
std::filesystem::path partialPath(const std::filesystem::path& folder);

}  // namespace eyrie::page
