// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/status.h>
#include <fmt/format.h>

namespace eyrie::mesh {

/// What checks of an .eym file's tables say of a field.
template <typename Found, typename Expected>
absl::Status damaged(std::string_view field, const Found& found, const Expected& expected) {
    return absl::DataLossError(
        fmt::format("{}: found {}, expected {}; the file is truncated or damaged: import the mesh "
                    "again",
                    field, found, expected));
}

}  // namespace eyrie::mesh
