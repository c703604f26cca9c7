// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

namespace eyrie::cli {

/// The whole text of a file of this machine, or of a pipe. Errors: NotFound; InvalidArgument (a
/// URL, a folder, or more than 64 MiB).
absl::StatusOr<std::string> readText(const std::string& path);

}  // namespace eyrie::cli
