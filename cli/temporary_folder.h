// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include <absl/status/statusor.h>

namespace eyrie::cli {

/// A new folder that only this user can enter and that goes, with what is in it, with its owner.
class TemporaryFolder {
public:
    /// In $TMPDIR, or in /tmp where that name leaves a socket's no room. Unavailable when it cannot
    /// be made.
    static absl::StatusOr<TemporaryFolder> create();

    TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;
    ~TemporaryFolder();

    /// The address of a Unix socket in it, as gRPC spells it.
    std::string socket(const std::string& name) const { return "unix:" + (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

private:
    explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
};

}  // namespace eyrie::cli
