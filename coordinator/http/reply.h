// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/span_body.hpp>

#include "coordinator/http/router.h"

namespace eyrie::http {

/// Its body belongs to a Response.
using Reply = boost::beast::http::response<boost::beast::http::span_body<const char>>;

/// What every answer says, and what this one does.
Reply headersOf(const Response& response);

}  // namespace eyrie::http
