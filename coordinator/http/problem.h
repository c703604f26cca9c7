// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/status.h>

#include "coordinator/http/router.h"

namespace eyrie::http {

/// application/problem+json (RFC 9457): {"title":"Forbidden","status":403,"detail":"…"}.
Response problemResponse(int status, std::string_view detail);

/// The same of a refusal: 401, 403, 429, 503, or 400.
Response problemResponse(const absl::Status& status);

}  // namespace eyrie::http
