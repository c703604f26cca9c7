// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <absl/status/statusor.h>

namespace eyrie::fabric {

/// A file that is not complete yet, beside the one whose place it is to take.
struct PartialFile {
    std::string path;
    int fd = -1;  ///< to read and write; the caller closes it
};

/// Makes `PATH.partial-` and 16 random hexadecimal digits (nameBeside), empty, and removes what
/// killed writers of the same path have left. It is locked for as long as it is open, so that
/// processes on other machines and in other containers, too, see that its writer lives: rename or
/// remove it before it is closed. Errors: those of writeError; Unavailable.
absl::StatusOr<PartialFile> createPartial(const std::string& path);

/// Removes files beside `path` that killed writers of it have left.
void removeAbandoned(const std::string& path);
/// The same of writers of any file in `folder`.
void removeAllAbandoned(const std::filesystem::path& folder);

}  // namespace eyrie::fabric
