// SPDX-License-Identifier: Apache-2.0
#include "fabric/replaceable.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::fabric {

absl::Status checkReplaceable(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status there = fs::status(path, error);
    if (fs::is_directory(there))
        return writeError(path, "cannot be written", EISDIR);
    if (fs::is_other(there))
        return absl::InvalidArgumentError(fmt::format(
            "{}: is a pipe or a device, and this is not written from front to back; name a file",
            path));
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
