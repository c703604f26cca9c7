// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

namespace eyrie::coordinator {

/// A renderer answered what it must not: its bug, not the caller's.
template <typename... Values>
absl::Status brokenProtocol(fmt::format_string<Values...> format, Values&&... values) {
    return absl::InternalError("the renderer broke the protocol: " +
                               fmt::format(format, std::forward<Values>(values)...));
}

/// `status` as such an error; OK stays OK.
inline absl::Status brokenProtocol(const absl::Status& status) {
    return status.ok() ? status : brokenProtocol("{}", status.ToString());
}

}  // namespace eyrie::coordinator
