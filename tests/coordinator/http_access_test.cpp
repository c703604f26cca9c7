// SPDX-License-Identifier: Apache-2.0
// Who comes in by HTTP, to do what.
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/http/access.h"
#include "tests/coordinator/http_access_fixture.h"

namespace eyrie::http {
namespace {

using access::Role;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(HttpRoles, LookingIsForViewersAndWhatIsNotKnownForAdministrators) {
    EXPECT_EQ(roleFor("GET", "/"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/assets/main.js"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/healthz"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/ws"), Role::View);
    EXPECT_EQ(roleFor("GET", "/readyz"), Role::View);
    EXPECT_EQ(roleFor("GET", "/metrics"), Role::View);
    EXPECT_EQ(roleFor("GET", "/api/v1/scene"), Role::View);
    EXPECT_EQ(roleFor("POST", "/api/v1/image"), Role::View);
    EXPECT_EQ(roleFor("PUT", "/api/v1/scene"), Role::Control);
    EXPECT_EQ(roleFor("PATCH", "/api/v1/configuration"), Role::Control);
    EXPECT_EQ(roleFor("DELETE", "/api/v1/flights/one"), Role::Control);
    EXPECT_EQ(roleFor("POST", "/api/v1/imports"), Role::Admin);
    EXPECT_EQ(roleFor("POST", "/api/v1/imports/1/cancel"), Role::Admin);
    EXPECT_EQ(roleFor("POST", "/api/v1/anything"), Role::Admin);
    EXPECT_EQ(roleFor("POST", "/api/v1/sceneries"), Role::Admin);
    EXPECT_EQ(roleFor("POST", "/anything"), Role::Admin);
}

TEST(HttpCookies, AreFoundByTheirNames) {
    const TicketCookie one{"eyrie_ticket_0a", "2=3"};
    const TicketCookie other{"eyrie_ticket_0b", "1"};
    EXPECT_THAT(ticketCookies("a=1; eyrie_ticket_0b=1; b=2"), ElementsAre(other));
    EXPECT_THAT(ticketCookies("eyrie_ticket_0a=2=3;eyrie_ticket_0b=1"), ElementsAre(one, other));
    for (const char* none :
         {"", "eyrie_ticket_0a", "eyrie_ticket=1", ";;eyrie_ticket_0a=;", "a=eyrie_ticket_0a=1",
          "my_eyrie_ticket_0a=1", "eyrie_tickets=1", "=1"})
        EXPECT_THAT(ticketCookies(none), IsEmpty()) << none;
}

/// What a browser keeps and sends to every port of a host.
class Jar {
public:
    int ask(Access& server, std::string_view method, const std::string& token = "") {
        const std::string authorization = token.empty() ? "" : "Bearer " + token;
        const std::string cookies = header();
        Asked asked{method, "/login", authorization, cookies};
        asked.address = "10.0.0.1";
        const std::optional<Response> response = server.answer(asked, frames_);
        for (const auto& [name, value] : response->headers)
            if (name == "Set-Cookie")
                take(value);
        return response->status;
    }
    Role roleAt(Access& server) const {
        const std::string cookies = header();
        return server.roleOf({"GET", "/", {}, cookies});
    }
    std::size_t size() const { return cookies_.size(); }

private:
    void take(const std::string& value) {
        const std::size_t equals = value.find('=');
        const std::string name = value.substr(0, equals);
        if (value.find("Max-Age=0;") != std::string::npos)
            cookies_.erase(name);
        else
            cookies_[name] = value.substr(equals + 1, value.find(';') - equals - 1);
    }
    std::string header() const {
        std::string text;
        for (const auto& [name, value] : cookies_) text += fmt::format("{}={}; ", name, value);
        return text;
    }

    std::map<std::string, std::string> cookies_;
    coordinator::FakeFrameSource frames_;
};

std::shared_ptr<access::Gate> gateFor(const std::string& tokens) {
    return std::make_shared<access::Gate>(*access::Tokens::parse(tokens, "t"));
}

TEST(HttpCookies, OfServersOfOneHostLeaveEachOtherAlone) {
    const auto gate = gateFor(fmt::format("admin {}\n", kAdminToken));
    Access one(gate, false, false);
    Access other(gateFor(fmt::format("view {}\n", kViewToken)), false, false);
    Jar browser;
    EXPECT_EQ(browser.ask(one, "POST", kAdminToken), 200);
    EXPECT_EQ(browser.ask(other, "POST", kViewToken), 200);
    EXPECT_EQ(browser.ask(one, "GET"), 200);
    EXPECT_EQ(browser.ask(other, "GET"), 200);
    EXPECT_EQ(browser.roleAt(one), Role::Admin);
    EXPECT_EQ(gate->refusals(access::Door::Http), access::Refusals{});
    EXPECT_EQ(browser.ask(one, "DELETE"), 204);
    EXPECT_EQ(browser.ask(one, "GET"), 401);
    EXPECT_EQ(gate->refusals(access::Door::Http).missing, 1U) << "what is another's is not its own";
    EXPECT_EQ(browser.ask(other, "GET"), 200);
}

TEST(HttpCookies, OfOneServerAreFoundAmongThoseOfManyOthers) {
    const auto gate = gateFor(fmt::format("admin {}\n", kAdminToken));
    Access server(gate, false, false);
    const auto cookieFor = [](const std::string& token) {
        const std::string authorization = "Bearer " + token;
        return fmt::format("eyrie_ticket_{}={}; ", access::Gate::markFor(authorization),
                           access::Gate::ticketFor(authorization));
    };
    std::string others;
    for (int i = 0; i < 50; ++i) others += cookieFor(fmt::format("{}{}", kViewToken, i));
    for (const std::string& cookies :
         {cookieFor(kAdminToken) + others, others + cookieFor(kAdminToken)})
        EXPECT_EQ(server.roleOf({"GET", "/", {}, cookies}), Role::Admin);
    EXPECT_EQ(server.roleOf({"GET", "/", {}, others}), Role::View);
}

TEST(HttpCookies, OfTheNewestSignInCount) {
    Access server(gateFor(fmt::format("view {}\nadmin {}\n", kViewToken, kAdminToken)), false,
                  false);
    Jar browser;
    for (const auto& [token, role] : {std::pair{kViewToken, Role::View},
                                      {kAdminToken, Role::Admin},
                                      {kViewToken, Role::View},
                                      {kViewToken, Role::View}}) {
        EXPECT_EQ(browser.ask(server, "POST", token), 200);
        EXPECT_EQ(browser.roleAt(server), role);
        EXPECT_EQ(browser.size(), 1U);
    }
    EXPECT_EQ(browser.ask(server, "DELETE"), 204);
    EXPECT_EQ(browser.size(), 0U);
}

TEST_F(HttpAccess, WithoutAGateEverybodyMayDoEverything) {
    start({}, false);
    EXPECT_EQ(statusOf(request("GET", "/metrics")), 200);
    EXPECT_EQ(upgradeStatus(""), 101);
    EXPECT_THAT(ask(request("GET", "/login")), HasSubstr(R"({"role":"admin"})"));
}

TEST_F(HttpAccess, StrangersSeeThePageAndThatTheServerLives) {
    start();
    EXPECT_EQ(statusOf(request("GET", "/")), 503);  // not built in this test, and not 401
    EXPECT_EQ(statusOf(request("GET", "/healthz")), 200);
    const std::string ready = ask(request("GET", "/readyz"));
    EXPECT_THAT(ready, HasSubstr("HTTP/1.1 200"));
    EXPECT_THAT(ready, Not(HasSubstr("renderers")));
    EXPECT_THAT(ask(request("GET", "/readyz", bearer(kViewToken))), HasSubstr("renderers"));
    for (const char* target : {"/api/v1/status", "/ws", "/metrics", "/login", "/api/v1/none"}) {
        const std::string answer = ask(request("GET", target));
        EXPECT_THAT(answer, HasSubstr("HTTP/1.1 401 Unauthorized")) << target;
        EXPECT_THAT(answer, HasSubstr("WWW-Authenticate: Bearer")) << target;
        EXPECT_THAT(answer, HasSubstr("application/problem+json")) << target;
        EXPECT_THAT(answer, HasSubstr(R"("status":401)")) << target;
    }
    EXPECT_EQ(upgradeStatus(""), 401);
}

TEST_F(HttpAccess, ReadinessIsToldInFullToRightTokensOnlyAndWrongOnesAreLimited) {
    start();
    const std::string wrong = request("GET", "/readyz", bearer("wrong-0123456789abcdefgh"));
    EXPECT_EQ(statusOf(request("GET", "/readyz", "Authorization: x\r\n")), 401);
    for (int i = 1; i < access::Gate::kMaxWrong; ++i) {
        const std::string answer = ask(wrong);
        EXPECT_THAT(answer, HasSubstr("HTTP/1.1 401"));
        EXPECT_THAT(answer, Not(HasSubstr("renderers")));
    }
    EXPECT_EQ(statusOf(wrong), 429);
    EXPECT_EQ(statusOf(request("GET", "/readyz")), 200) << "probes show no token";
    EXPECT_EQ(statusOf(request("GET", "/readyz", bearer(kViewToken))), 200);
}

TEST_F(HttpAccess, TokensDoWhatTheirRoleMay) {
    start();
    EXPECT_EQ(statusOf(request("GET", "/metrics", bearer(kViewToken))), 200);
    EXPECT_EQ(upgradeStatus(bearer(kViewToken)), 101);
    const std::string refused = ask(request("PUT", "/api/v1/scene", bearer(kViewToken)));
    EXPECT_THAT(refused, HasSubstr("HTTP/1.1 403 Forbidden"));
    EXPECT_THAT(refused, HasSubstr("role control; the one presented is of role view"));
    EXPECT_EQ(statusOf(request("POST", "/api/v1/imports", bearer(kControlToken))), 403);
    // What is let in meets the router, which has no such paths of its own here.
    EXPECT_EQ(statusOf(request("PUT", "/api/v1/scene", bearer(kControlToken))), 405);
    EXPECT_EQ(statusOf(request("POST", "/api/v1/imports", bearer(kAdminToken))), 405);
    EXPECT_EQ(gate_->refusals(access::Door::Http), (access::Refusals{0, 0, 0, 2}));
}

TEST_F(HttpAccess, TargetsInAbsoluteFormNeedTheSameTokens) {
    start();
    const std::string here = fmt::format("http://127.0.0.1:{}", port_);
    for (const char* target : {"/api/v1/status", "/ws", "/metrics", "/login", "/api/v1/none"})
        EXPECT_EQ(statusOf(request("GET", here + target)), 401) << target;
    EXPECT_EQ(statusOf(request("GET", here + "/metrics", bearer(kViewToken))), 200);
    EXPECT_EQ(statusOf(request("PUT", here + "/api/v1/scene", bearer(kViewToken))), 403);
    EXPECT_EQ(statusOf(request("PUT", here + "/api/v1/scene", bearer(kControlToken))), 405);
    EXPECT_EQ(statusOf(fmt::format("GET {}/ws HTTP/1.1\r\nHost: x\r\nOrigin: {}\r\n{}{}\r\n", here,
                                   here, kUpgrade, bearer(kViewToken))),
              101);
    EXPECT_EQ(statusOf(fmt::format("GET {}/ws HTTP/1.1\r\nHost: x\r\nOrigin: http://x\r\n{}{}\r\n",
                                   here, kUpgrade, bearer(kViewToken))),
              403);
}

TEST_F(HttpAccess, TokensInAddressesAreNotTaken) {
    start();
    for (const char* key : {"token", "access_token", "authorization"})
        EXPECT_EQ(statusOf(request("GET", fmt::format("/metrics?{}={}", key, kAdminToken))), 401);
}

TEST_F(HttpAccess, ACookieStandsForATokenAndDoesNotTellIt) {
    start();
    const std::string answer = ask(request("POST", "/login", bearer(kViewToken)));
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr(R"({"role":"view"})"));
    EXPECT_THAT(answer, HasSubstr("; HttpOnly; SameSite=Strict"));
    EXPECT_THAT(answer, Not(HasSubstr(kViewToken)));
    const std::size_t begin = answer.find("Set-Cookie: ") + 12;
    const std::string cookie =
        "Cookie: theme=dark; " + answer.substr(begin, answer.find(';', begin) - begin) + "\r\n";
    EXPECT_EQ(statusOf(request("GET", "/metrics", cookie)), 200);
    EXPECT_EQ(upgradeStatus(cookie), 101);
    EXPECT_EQ(statusOf(request("PUT", "/api/v1/scene", cookie)), 403);
    EXPECT_EQ(statusOf(request("GET", "/metrics", cookie + bearer("wrong-0123456789abcdefgh"))),
              401);
    EXPECT_THAT(ask(request("DELETE", "/login", cookie)), HasSubstr("Max-Age=0"));
    EXPECT_EQ(statusOf(request("GET", "/metrics", "Cookie: eyrie_ticket=1.2\r\n")), 401);
}

TEST_F(HttpAccess, SigningInWithAnotherTokenTakesTheCookieOfTheOneBeforeAway) {
    start();
    const auto cookieIn = [](const std::string& answer) {
        const std::size_t begin = answer.find("Set-Cookie: eyrie_ticket_") + 12;
        return answer.substr(begin, answer.find(';', begin) - begin);
    };
    const std::string first = cookieIn(ask(request("POST", "/login", bearer(kViewToken))));
    const std::string answer =
        ask(request("POST", "/login", "Cookie: " + first + "\r\n" + bearer(kControlToken)));
    EXPECT_THAT(answer, HasSubstr(fmt::format("Set-Cookie: {}; Path=/; Max-Age=0;",
                                              first.substr(0, first.find('=') + 1))));
    EXPECT_THAT(answer, HasSubstr("; Path=/; Max-Age=43200; HttpOnly; SameSite=Strict"));
}

TEST_F(HttpAccess, PagesOfOtherSitesChangeNothingWithTheUsersCookie) {
    start();
    for (const char* method : {"POST", "PUT", "PATCH", "DELETE"}) {
        const std::string origin = "Origin: http://evil.example\r\n" + bearer(kAdminToken);
        EXPECT_EQ(statusOf(request(method, "/api/v1/scene", origin)), 403) << method;
        EXPECT_EQ(statusOf(request(method, "/login", origin)), 403) << method;
    }
    EXPECT_EQ(statusOf(request(
                  "POST", "/login",
                  fmt::format("Origin: http://127.0.0.1:{}\r\n", port_) + bearer(kAdminToken))),
              200);
}

TEST_F(HttpAccess, WrongTokensAreLimitedAndRightOnesStillPass) {
    start();
    const std::string wrong = request("GET", "/metrics", bearer("wrong-0123456789abcdefgh"));
    for (int i = 0; i < access::Gate::kMaxWrong; ++i) EXPECT_EQ(statusOf(wrong), 401);
    EXPECT_THAT(ask(wrong), HasSubstr("HTTP/1.1 429"));
    EXPECT_THAT(ask(wrong), HasSubstr("Retry-After: 60"));
    EXPECT_THAT(ask(wrong, "127.0.0.2"), HasSubstr("HTTP/1.1 401")) << "others are not limited";
    EXPECT_EQ(statusOf(request("GET", "/metrics", bearer(kViewToken))), 200);
}

TEST_F(HttpAccess, WhoIsTurnedAwayIsCounted) {
    start();
    EXPECT_EQ(statusOf(request("GET", "/api/v1/scene")), 401);
    for (int i = 0; i < access::Gate::kMaxWrong + 2; ++i)
        ask(request("GET", "/api/v1/scene", bearer("wrong-0123456789abcdef0123456789")));
    EXPECT_EQ(statusOf(request("PUT", "/api/v1/scene", bearer(kViewToken))), 403);
    ask(request("GET", "/readyz"));  // a probe's, which is answered
    const std::string metrics = ask(request("GET", "/metrics", bearer(kViewToken)));
    const auto expectCount = [&](const char* reason, int count) {
        EXPECT_THAT(metrics, HasSubstr(fmt::format(
                                 "eyrie_peers_refused_total{{door=\"http\",reason=\"{}\"}} {}\n",
                                 reason, count)));
    };
    expectCount("no_token", 1);
    expectCount("wrong_token", access::Gate::kMaxWrong);
    expectCount("too_many_wrong", 2);
    expectCount("forbidden", 1);
    expectCount("handshake", 0);
    EXPECT_THAT(metrics,
                HasSubstr("eyrie_peers_refused_total{door=\"grpc\",reason=\"wrong_token\"} 0\n"));
}

}  // namespace
}  // namespace eyrie::http
