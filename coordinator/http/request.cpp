// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/request.h"

#include <cstddef>
#include <optional>

#include <boost/beast/core/string.hpp>
#include <fmt/format.h>

#include "coordinator/http/api_calls.h"
#include "coordinator/http/request_target.h"
#include "coordinator/http/router.h"
#include "fabric/status.h"

namespace eyrie::http {

namespace beast = boost::beast;

Asked askedBy(const Request& request, const std::string& address) {
    using beast::http::field;
    return {view(request.method_string()),
            view(request.target()),
            view(request[field::authorization]),
            view(request[field::cookie]),
            view(request[field::origin]),
            view(request[field::host]),
            address};
}

api::RestRequest restRequest(const Request& request, const std::stop_source& gone,
                             access::Role role) {
    namespace http = beast::http;
    const auto header = [&](auto name) { return std::string(view(request[name])); };
    return {std::string(view(request.method_string())),
            std::string(view(request.target())),
            request.body(),
            header(http::field::content_type),
            header(http::field::accept),
            header(http::field::if_none_match),
            header(http::field::if_match),
            header("Idempotency-Key"),
            gone.get_token(),
            role};
}

absl::Status takeHost(Request& request, bool isEncrypted) {
    using beast::http::field;
    constexpr unsigned kFirstWithHosts = 11;  // HTTP/1.1
    const std::size_t hosts = request.count(field::host);
    if (hosts > 1 || (hosts == 0 && request.version() >= kFirstWithHosts))
        return absl::InvalidArgumentError(
            fmt::format("the request has {} headers Host; send one", hosts));
    ASSIGN_OR_RETURN(const std::optional<AbsoluteTarget> absolute,
                     absoluteTarget(view(request.target()), isEncrypted));
    if (absolute) {
        request.set(field::host, absolute->host);
        request.target(absolute->target);
    }
    return absl::OkStatus();
}

bool waitsToGoOn(const Request& header) {
    return header.version() >= 11 &&
           beast::iequals(header[beast::http::field::expect], "100-continue");
}

bool isChange(const Asked& asked) {
    const std::string_view path = pathOf(asked.target);
    return isApiCall(path) && roleFor(asked.method, path) >= access::Role::Control;
}

}  // namespace eyrie::http
