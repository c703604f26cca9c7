// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <utility>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace eyrie::fabric {

/// `status` with "context: " before its message; OK stays OK.
absl::Status withContext(const absl::Status& status, std::string_view context);

/// What the system said (`error`, of errno) when `path` could not be written: "path: what: reason",
/// and the remedy where there is one. NotFound (no such folder), InvalidArgument (a folder has the
/// file's name, or the name is too long or a loop of links), PermissionDenied, ResourceExhausted
/// (disk full), Unavailable.
absl::Status writeError(std::string_view path, std::string_view what, int error);

}  // namespace eyrie::fabric

#define EYRIE_CONCAT_INNER(a, b) a##b
#define EYRIE_CONCAT(a, b) EYRIE_CONCAT_INNER(a, b)

/// Returns from the enclosing function when `expression` (an absl::Status) is not OK.
#define RETURN_IF_ERROR(expression)                                     \
    do {                                                                \
        if (absl::Status eyrieStatus = (expression); !eyrieStatus.ok()) \
            return eyrieStatus;                                         \
    } while (false)

/// Declares or assigns `target` from an absl::StatusOr, or returns its status.
#define ASSIGN_OR_RETURN(target, expression) \
    ASSIGN_OR_RETURN_IMPL(EYRIE_CONCAT(eyrieStatusOr, __LINE__), target, expression)
#define ASSIGN_OR_RETURN_IMPL(statusOr, target, expression) \
    auto statusOr = (expression);                           \
    if (!statusOr.ok())                                     \
        return std::move(statusOr).status();                \
    target = *std::move(statusOr)
