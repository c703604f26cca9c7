// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

namespace eyrie::cli {

/// The whole text of a file of this machine, or of a pipe, without the mark that editors of Windows
/// put before UTF-8. Errors: NotFound; InvalidArgument (a
/// URL, a folder, or more than 64 MiB).
absl::StatusOr<std::string> readText(const std::string& path);

}  // namespace eyrie::cli
