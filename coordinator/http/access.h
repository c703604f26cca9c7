// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/gate.h"
#include "coordinator/http/router.h"

namespace eyrie::http {

/// What of a request says who asks, and for what.
struct Asked {
    std::string_view method;
    std::string_view target;
    std::string_view authorization = {};  ///< the header; empty: absent, as of all below
    std::string_view cookie = {};
    std::string_view origin = {};
    std::string_view host = {};
    std::string address = {};  ///< of the peer, without its port
};

/// The role that a request needs; nothing: anybody may make it. The page itself, and whether the
/// server lives, are for everybody; looking is `view`, changing what all see `control`, and every
/// other change, also of paths that are not known here, `admin`.
std::optional<access::Role> roleFor(std::string_view method, std::string_view path);

/// A cookie of a sign-in, at this server or at another of its host.
struct TicketCookie {
    std::string_view name;
    std::string_view ticket;

    bool operator==(const TicketCookie&) const = default;
};

/// Those of a Cookie header that are not empty, in their order.
std::vector<TicketCookie> ticketCookies(std::string_view header);

/// Who comes in by HTTP. A program sends `Authorization: Bearer TOKEN` with every request. A page
/// sends it once, with POST /login, and gets a cookie: its scripts cannot read that, no other site
/// can have it sent (SameSite), and it stands for the token without telling it. Tokens are taken
/// from nowhere else, so that none is in an address, a log or a Referer.
///
///   GET /login     200 {"role":"view"}; 401: a token is needed
///   POST /login    the same, and a cookie for 12 hours; anybody's page but this server's gets 403
///   DELETE /login  204; the browser forgets the cookie
///
/// Browsers send a host's cookies to all its ports and paths, where other servers may be, with
/// other tokens: each cookie has its token's mark (ticket.h) in its name, and only those with marks
/// of this server's tokens are looked at, and taken away.
///
/// Used on the server's thread only.
class Access {
public:
    /// Without a gate everybody may do everything. `localNamesOnly` as in Context; `isSecure`:
    /// over TLS.
    Access(std::shared_ptr<access::Gate> gate, bool localNamesOnly, bool isSecure)
        : gate_(std::move(gate)), localNamesOnly_(localNamesOnly), isSecure_(isSecure) {}

    /// The answer to a request that is turned away (401, 403, also to one under a stranger's name,
    /// 429), or to one that is answered here: /login, and, to who shows no token, /readyz without
    /// what only `view` may know.
    std::optional<Response> answer(const Asked& asked, const coordinator::FrameSource& frames);

    /// The role of a request that answer() let in.
    access::Role roleOf(const Asked& asked);

private:
    absl::StatusOr<access::Role> admit(const Asked& asked, access::Role needed);
    Response login(const Asked& asked);
    std::vector<TicketCookie> ownCookies(const Asked& asked) const;
    bool isKnown(const TicketCookie& cookie) const;
    std::string_view ticketOf(const Asked& asked) const;
    void forgetKnown(const Asked& asked, std::string_view but, Response& response) const;
    std::string cookieOf(std::string_view name, std::string_view ticket,
                         std::chrono::seconds life) const;

    const std::shared_ptr<access::Gate> gate_;
    const bool localNamesOnly_;
    const bool isSecure_;
};

}  // namespace eyrie::http
