// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/access.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/call_roles.h"
#include "coordinator/http/origin.h"
#include "coordinator/http/problem.h"
#include "coordinator/http/status_json.h"

namespace eyrie::http {
namespace {

using access::Role;

constexpr std::string_view kCookie = "eyrie_ticket_";  // and the token's mark
constexpr std::size_t kMaxOwnCookies = 16;
constexpr std::string_view kApi = "/api/v1";

bool reads(std::string_view method) { return method == "GET" || method == "HEAD"; }

Response jsonResponse(int status, std::string text) {
    Response response;
    response.status = status;
    response.contentType = "application/json";
    response.body = std::make_shared<const std::string>(std::move(text));
    return response;
}

/// For probes, which have no token.
Response readyResponse(bool ready) {
    return jsonResponse(ready ? 200 : 503, fmt::format("{{\"ready\":{}}}\n", ready));
}

Response refusalOf(const absl::Status& status) {
    Response response = problemResponse(status);
    if (response.status == 401)
        response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"eyrie\"");
    if (response.status == 429)
        response.headers.emplace_back(
            "Retry-After", std::to_string(std::chrono::seconds(access::Gate::kWindow).count()));
    return response;
}

}  // namespace

std::optional<Role> roleFor(std::string_view method, std::string_view path) {
    if (path == "/ws" || path == "/metrics" || path == "/readyz")
        return Role::View;
    if (path.starts_with(kApi) && path.substr(kApi.size()).starts_with('/'))
        return api::roleForRest(method, path.substr(kApi.size()));
    return reads(method) ? std::nullopt : std::optional(Role::Admin);
}

std::vector<TicketCookie> ticketCookies(std::string_view header) {
    std::vector<TicketCookie> cookies;
    while (!header.empty()) {
        const std::size_t end = std::min(header.find(';'), header.size());
        std::string_view pair = header.substr(0, end);
        header.remove_prefix(std::min(end + 1, header.size()));
        pair.remove_prefix(std::min(pair.find_first_not_of(' '), pair.size()));
        const std::size_t equals = pair.find('=');
        if (equals == pair.npos || equals + 1 == pair.size() ||
            !pair.substr(0, equals).starts_with(kCookie))
            continue;
        cookies.push_back({pair.substr(0, equals), pair.substr(equals + 1)});
    }
    return cookies;
}

/// Those of this server's own tokens by their marks, at most 16: what is to be verified.
std::vector<TicketCookie> Access::ownCookies(const Asked& asked) const {
    std::vector<TicketCookie> cookies = ticketCookies(asked.cookie);
    std::erase_if(cookies, [this](const TicketCookie& cookie) {
        return !gate_->hasMark(cookie.name.substr(kCookie.size()));
    });
    cookies.resize(std::min(cookies.size(), kMaxOwnCookies));
    return cookies;
}

bool Access::isKnown(const TicketCookie& cookie) const {
    return gate_->roleOf({{}, cookie.ticket}).has_value();
}

/// Where none is known, any other of its own, which is turned away as such. Not looked for where a
/// token is shown.
std::string_view Access::ticketOf(const Asked& asked) const {
    if (!asked.authorization.empty())
        return {};
    const std::vector<TicketCookie> cookies = ownCookies(asked);
    if (cookies.empty())
        return {};
    const auto known = std::ranges::find_if(
        cookies, [this](const TicketCookie& cookie) { return isKnown(cookie); });
    return known == cookies.end() ? cookies.front().ticket : known->ticket;
}

absl::StatusOr<Role> Access::admit(const Asked& asked, Role needed) {
    if (gate_ == nullptr)
        return Role::Admin;
    return gate_->admit({asked.authorization, ticketOf(asked)}, asked.address, needed);
}

Role Access::roleOf(const Asked& asked) {
    if (gate_ == nullptr)
        return Role::Admin;
    return gate_->roleOf({asked.authorization, ticketOf(asked)}).value_or(Role::View);
}

std::optional<Response> Access::answer(const Asked& asked, const coordinator::FrameSource& frames) {
    const std::string_view path = pathOf(asked.target);
    // A page whose name leads here reads what this server answers as its own. Browsers say the
    // name.
    if (path != "/healthz" && !asked.host.empty() &&
        !isAllowedOrigin("", asked.host, localNamesOnly_))
        return problemResponse(
            absl::PermissionDeniedError("Host is the name of another machine, and this server is "
                                        "for its own machine; ask under "
                                        "its address or as localhost"));
    // A cookie comes with what any page asks for: only this server's own may change something.
    if (!reads(asked.method) && !isAllowedOrigin(asked.origin, asked.host, localNamesOnly_))
        return problemResponse(
            absl::PermissionDeniedError("pages of other sites may not change anything here"));
    if (path == "/login")
        return login(asked);
    if (path == "/readyz" && gate_ != nullptr && asked.authorization.empty() &&
        !gate_->roleOf({{}, ticketOf(asked)}))
        return readyResponse(isReady(frames.status()));
    const std::optional<Role> needed = roleFor(asked.method, path);
    if (!needed)
        return std::nullopt;
    const absl::StatusOr<Role> role = admit(asked, *needed);
    return role.ok() ? std::nullopt : std::optional(refusalOf(role.status()));
}

Response Access::login(const Asked& asked) {
    if (asked.method == "DELETE") {
        Response gone;
        gone.status = 204;
        forgetKnown(asked, {}, gone);
        return gone;
    }
    const bool isPost = asked.method == "POST";
    if (!isPost && !reads(asked.method)) {
        Response refused = problemResponse(405, "/login answers GET, POST and DELETE");
        refused.headers.emplace_back("Allow", "GET, HEAD, POST, DELETE");
        return refused;
    }
    const absl::StatusOr<Role> role = admit(asked, Role::View);
    if (!role.ok())
        return refusalOf(role.status());
    Response response =
        jsonResponse(200, fmt::format("{{\"role\":\"{}\"}}\n", access::nameOf(*role)));
    if (isPost && gate_ != nullptr && !asked.authorization.empty()) {
        const std::string name =
            fmt::format("{}{}", kCookie, access::Gate::markFor(asked.authorization));
        forgetKnown(asked, name, response);  // so that this one counts
        response.headers.emplace_back("Set-Cookie",
                                      cookieOf(name, access::Gate::ticketFor(asked.authorization),
                                               access::Gate::kTicketLife));
    }
    return response;
}

/// All `but` that of this name.
void Access::forgetKnown(const Asked& asked, std::string_view but, Response& response) const {
    if (gate_ == nullptr)
        return;
    for (const TicketCookie& cookie : ownCookies(asked))
        if (cookie.name != but && isKnown(cookie))
            response.headers.emplace_back("Set-Cookie",
                                          cookieOf(cookie.name, "", std::chrono::seconds(0)));
}

std::string Access::cookieOf(std::string_view name, std::string_view ticket,
                             std::chrono::seconds life) const {
    return fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Strict{}", name, ticket,
                       life.count(), isSecure_ ? "; Secure" : "");
}

}  // namespace eyrie::http
