// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

namespace eyrie::http {

/// What a target in absolute form says, such as "http://viz:8080/api?x=1".
struct AbsoluteTarget {
    std::string host;    ///< "viz:8080"; it counts in place of the header Host
    std::string target;  ///< "/api?x=1", as most requests have it; "/" where there is no path

    bool operator==(const AbsoluteTarget&) const = default;
};

/// Takes a target in absolute form apart: what clients send to proxies, and every server has to
/// take (RFC 9112, 3.2.2). Nothing: it is in no such form. Nothing is decoded; what comes of it
/// goes through the same checks as any other host and target. Errors: InvalidArgument where its
/// host is none; FailedPrecondition where it is of another scheme than that of the connection, and
/// so meant for another server (421; RFC 9110, 7.4).
absl::StatusOr<std::optional<AbsoluteTarget>> absoluteTarget(std::string_view target,
                                                             bool isEncrypted);

}  // namespace eyrie::http
