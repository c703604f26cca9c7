// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "coordinator/api/rest_door.h"
#include "coordinator/http/router.h"

namespace eyrie::http {

/// Whether the API answers at `path`.
bool isApiCall(std::string_view path);

Response toResponse(api::RestAnswer answer);

}  // namespace eyrie::http
