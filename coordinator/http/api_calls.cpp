// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/api_calls.h"

#include <utility>

namespace eyrie::http {

bool isApiCall(std::string_view path) { return path == "/api" || path.starts_with("/api/"); }

Response toResponse(api::RestAnswer answer) {
    Response response;
    response.status = answer.status;
    response.contentType = std::move(answer.contentType);
    response.cacheControl = "no-cache";
    response.headers = std::move(answer.headers);
    response.body = std::move(answer.body);
    return response;
}

}  // namespace eyrie::http
