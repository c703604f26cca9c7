// SPDX-License-Identifier: Apache-2.0
#include "fabric/no_folder.h"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "fabric/status.h"

namespace eyrie::fabric {

absl::Status checkNoFolder(const std::string& path) {
    std::error_code error;
    return std::filesystem::is_directory(path, error)
               ? writeError(path, "cannot be written", EISDIR)
               : absl::OkStatus();
}

}  // namespace eyrie::fabric
