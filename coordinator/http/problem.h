// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/status.h>

#include "coordinator/http/router.h"

namespace eyrie::http {

/// application/problem+json (RFC 9457): as api/problem_json.h says.
Response problemResponse(int status, std::string_view detail);

/// The same of an error, with the status that api::httpStatusOf has for it.
Response problemResponse(const absl::Status& status);

}  // namespace eyrie::http
