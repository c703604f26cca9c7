// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/problem.h"

#include <memory>
#include <string>

#include <boost/beast/http/status.hpp>
#include <fmt/format.h>

#include "coordinator/http/status_json.h"

namespace eyrie::http {
namespace {

int httpStatusOf(absl::StatusCode code) {
    switch (code) {
        case absl::StatusCode::kUnauthenticated:
            return 401;
        case absl::StatusCode::kPermissionDenied:
            return 403;
        case absl::StatusCode::kResourceExhausted:
            return 429;
        case absl::StatusCode::kUnavailable:
            return 503;
        default:
            return 400;
    }
}

}  // namespace

Response problemResponse(int status, std::string_view detail) {
    const auto title =
        boost::beast::http::obsolete_reason(static_cast<boost::beast::http::status>(status));
    Response response;
    response.status = status;
    response.contentType = "application/problem+json";
    response.body = std::make_shared<const std::string>(
        fmt::format("{{\"title\":{},\"status\":{},\"detail\":{}}}\n",
                    quotedJson({title.data(), title.size()}), status, quotedJson(detail)));
    return response;
}

Response problemResponse(const absl::Status& status) {
    const auto message = status.message();
    return problemResponse(httpStatusOf(status.code()), {message.data(), message.size()});
}

}  // namespace eyrie::http
