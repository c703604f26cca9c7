// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <boost/beast/core/string_type.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "coordinator/api/rest_door.h"
#include "coordinator/http/access.h"

namespace eyrie::http {

/// As it came; what is said of it here is its header's.
using Request = boost::beast::http::request<boost::beast::http::string_body>;

inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Who asks, from `address`. Refers to `request`.
Asked askedBy(const Request& request, const std::string& address);

/// What a call of the API is told; `gone`: stops it when the client goes.
api::RestRequest restRequest(const Request& request, const std::stop_source& gone,
                             access::Role role);

/// Sees that a request says once which host it is for, and where its target does so, too, that this
/// is the one it says. Errors: InvalidArgument, and those of absoluteTarget().
absl::Status takeHost(Request& request, bool isEncrypted);

/// Whether a client waits to be asked for the body (RFC 9110, 10.1.1).
bool waitsToGoOn(const Request& header);

/// Not only looks, and not at what is no call of the API.
bool isChange(const Asked& asked);

}  // namespace eyrie::http
