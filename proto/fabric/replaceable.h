// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

namespace eyrie::fabric {

/// Whether a file that is written beside `path` may take its place, found out before the work and
/// not after it: nothing is there yet, or a file.
/// Errors: InvalidArgument (a folder, a pipe or a device is there).
absl::Status checkReplaceable(const std::string& path);

}  // namespace eyrie::fabric
