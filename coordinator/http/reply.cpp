// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/reply.h"

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/status.hpp>

namespace eyrie::http {
namespace {

/// The page runs its own scripts and styles only, talks to this server only, and may be framed by
/// it only.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'self'";

}  // namespace

Reply headersOf(const Response& response) {
    using boost::beast::http::field;
    Reply reply(static_cast<boost::beast::http::status>(response.status), 11);
    reply.set(field::content_type, response.contentType);
    reply.set(field::cache_control, response.cacheControl);
    reply.set("Content-Security-Policy", kContentSecurityPolicy);
    reply.set("X-Content-Type-Options", "nosniff");
    reply.set("Referrer-Policy", "no-referrer");
    reply.set("Cross-Origin-Resource-Policy", "same-origin");
    for (const auto& [name, value] : response.headers)
        if (name == "Set-Cookie")
            reply.insert(name, value);  // browsers take one cookie from each
        else
            reply.set(name, value);
    return reply;
}

}  // namespace eyrie::http
