// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>

#include <absl/status/statusor.h>

namespace eyrie::api {

/// A file that one process at a time has for itself, among those that ask for it so (flock). Given
/// up with this object, or when the process ends, however it does. The file itself stays: who
/// removed it would have it beside who has it still.
class FileLock {
public:
    /// Of the file `path`, which is made where there is none. Does not wait. Errors:
    /// FailedPrecondition (another has it), Unimplemented (its file system has no locks),
    /// Unavailable (it can be neither opened nor made).
    static absl::StatusOr<FileLock> take(const std::filesystem::path& path);

    FileLock(FileLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
    FileLock& operator=(FileLock&&) = delete;
    ~FileLock();

private:
    explicit FileLock(int file) : file_(file) {}
    int file_;
};

}  // namespace eyrie::api
