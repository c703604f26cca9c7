// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include <absl/status/statusor.h>

namespace eyrie::access {

/// The one folder in which clients may name files. What a client sends is a name below it, with '/'
/// between its parts: "survey/dem.eyt". Nothing outside can be named, neither by "..", by absolute
/// or Windows paths, by a scheme or a drive, nor through a link that leads outside.
///
/// A name is checked when it is asked for: who can write to the folder on this machine can still
/// put a link in a file's place afterwards. Immutable; any thread.
class DataFolder {
public:
    static constexpr std::size_t kMaxNameBytes = 1024;

    /// Errors: NotFound, InvalidArgument (no folder), PermissionDenied.
    static absl::StatusOr<DataFolder> open(const std::filesystem::path& folder);

    /// Without links or "..".
    const std::filesystem::path& path() const { return path_; }

    /// Unavailable where the folder cannot be looked into any more: it was moved away, or what it
    /// was mounted from has gone.
    absl::Status check() const;

    /// Where the file or folder `name` lies; the path has no links in it. Errors: InvalidArgument
    /// (no such name can be), NotFound, PermissionDenied (it leads outside), those of check().
    absl::StatusOr<std::filesystem::path> existing(std::string_view name) const;

    /// Where a file `name` can be written: its folder exists; the file, which may not yet, is no
    /// link. Errors: as existing(), and FailedPrecondition where a folder or link is in its place.
    absl::StatusOr<std::filesystem::path> place(std::string_view name) const;

private:
    explicit DataFolder(std::filesystem::path path) : path_(std::move(path)) {}
    absl::StatusOr<std::filesystem::path> resolve(const std::filesystem::path& path,
                                                  std::string_view name) const;

    std::filesystem::path path_;
};

/// InvalidArgument unless `name` can be a name below a data folder: 1 to kMaxNameBytes bytes of
/// UTF-8 without control characters, backslashes or colons; parts of 1 to 255 bytes, none of them
/// "." or "..".
absl::Status checkDataName(std::string_view name);

}  // namespace eyrie::access
