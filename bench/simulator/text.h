// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

namespace eyrie::simulator {

/// The whole text of a file. Errors: NotFound; InvalidArgument (a folder).
absl::StatusOr<std::string> textOf(const std::string& path);

}  // namespace eyrie::simulator
