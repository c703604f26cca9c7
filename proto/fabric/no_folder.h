// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

namespace eyrie::fabric {

/// Whether a file may be written at `path` as far as folders go, found out before the work and not
/// when the file is to take the folder's place. Errors: InvalidArgument (a folder is there).
absl::Status checkNoFolder(const std::string& path);

}  // namespace eyrie::fabric
