// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace eyrie::import {

/// A file that appears under its name whole or not at all, also where several processes on several
/// machines write it at once: each has a file of its own beside it, see fabric::createPartial, and
/// the last to commit wins. Without commit() that file is removed. One thread at a time.
class WholeFile {
public:
    /// Errors: those of fabric::createPartial.
    static absl::StatusOr<WholeFile> create(const std::string& path);

    WholeFile(WholeFile&& other) noexcept;
    WholeFile& operator=(WholeFile&&) = delete;
    ~WholeFile();

    /// Errors: ResourceExhausted (disk full), Unavailable.
    absl::Status append(std::span<const std::byte> bytes);
    absl::Status writeAt(std::uint64_t offset, std::span<const std::byte> bytes);
    std::uint64_t sizeBytes() const { return size_; }

    /// Where it is until then, for libraries that write by name.
    const std::string& partialPath() const { return partialPath_; }

    /// Flushes to disk and renames.
    absl::Status commit();

private:
    WholeFile(std::string path, std::string partialPath, int fd);

    std::string path_;
    std::string partialPath_;
    int fd_;
    std::uint64_t size_ = 0;
};

}  // namespace eyrie::import
