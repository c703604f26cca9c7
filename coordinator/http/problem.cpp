// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/problem.h"

#include <memory>
#include <string>

#include "coordinator/api/problem_json.h"

namespace eyrie::http {
namespace {

absl::StatusCode codeOf(int status) {
    switch (status) {
        case 401:
            return absl::StatusCode::kUnauthenticated;
        case 403:
            return absl::StatusCode::kPermissionDenied;
        case 405:
            return absl::StatusCode::kUnimplemented;
        case 413:
        case 429:
        case 431:
            return absl::StatusCode::kResourceExhausted;
        case 503:
            return absl::StatusCode::kUnavailable;
        default:
            return absl::StatusCode::kInvalidArgument;
    }
}

Response problemOf(const absl::Status& problem, int status) {
    Response response;
    response.status = status;
    response.contentType = "application/problem+json";
    response.body = std::make_shared<const std::string>(api::problemJson(problem, status, nullptr));
    return response;
}

}  // namespace

Response problemResponse(int status, std::string_view detail) {
    return problemOf({codeOf(status), {detail.data(), detail.size()}}, status);
}

Response problemResponse(const absl::Status& status) {
    return problemOf(status, api::httpStatusOf(status.code()));
}

}  // namespace eyrie::http
