// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

namespace eyrie::cli {

/// An options file as CLI11 reads it rightly: no mark that editors of Windows put before UTF-8, no
/// comments (a `#` outside quotes and what follows on its line), and each list on a line of its
/// own. Errors: InvalidArgument (a list without its end), naming the line.
absl::StatusOr<std::string> withoutComments(std::string_view text);

}  // namespace eyrie::cli
