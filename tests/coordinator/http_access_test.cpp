// SPDX-License-Identifier: Apache-2.0
// Who comes in by HTTP, and what those who mean ill cannot do to the others.
#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/http/access.h"
#include "coordinator/http/message_rate.h"
#include "coordinator/http/server.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/certificates.h"

namespace eyrie::http {
namespace {

namespace asio = boost::asio;
using access::Role;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr char kViewToken[] = "view-0123456789abcdef0123456789";
constexpr char kControlToken[] = "control-0123456789abcdef0123456789";
constexpr char kAdminToken[] = "admin-0123456789abcdef0123456789";

std::string bearer(const std::string& token) {
    return fmt::format("Authorization: Bearer {}\r\n", token);
}

constexpr char kUpgrade[] =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

class HttpAccess : public testing::Test {
protected:
    void start(ServerOptions options = {}, bool withTokens = true) {
        options.port = 0;
        if (withTokens)
            options.gate = gate_ = std::make_shared<access::Gate>(
                *access::Tokens::parse(fmt::format("view {}\ncontrol {}\nadmin {}\n", kViewToken,
                                                   kControlToken, kAdminToken),
                                       "t"));
        auto server = Server::start(options, frames_);
        ASSERT_TRUE(server.ok()) << server.status();
        server_ = *std::move(server);
        const std::string url = server_->url();
        port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    }

    /// From another address of this machine, which may stand for another machine.
    tcp::socket connect(const char* from = "127.0.0.1") {
        tcp::socket socket(io_, tcp::v4());
        socket.bind({asio::ip::make_address(from), 0});
        socket.connect({asio::ip::make_address("127.0.0.1"), port_});
        return socket;
    }

    std::string request(const std::string& method, const std::string& target,
                        const std::string& headers = "") const {
        return fmt::format("{} {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: close\r\n{}\r\n",
                           method, target, port_, headers);
    }

    /// The header of the answer, and what of the body comes with it.
    static std::string answerOn(tcp::socket& socket) {
        std::string text;
        error_code error;
        std::array<char, 4096> part{};
        while (text.find("\r\n\r\n") == std::string::npos && !error)
            text.append(part.data(), socket.read_some(asio::buffer(part), error));
        if (!text.starts_with("HTTP/1.1 101"))
            asio::read(socket, asio::dynamic_buffer(text), error);
        return text;
    }

    std::string ask(const std::string& text, const char* from = "127.0.0.1") {
        tcp::socket socket = connect(from);
        asio::write(socket, asio::buffer(text));
        return answerOn(socket);
    }

    int statusOf(const std::string& text) {
        const std::string answer = ask(text);
        return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9)) : 0;
    }

    int upgradeStatus(const std::string& headers) {
        return statusOf(fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n", port_,
                                    kUpgrade, headers));
    }

    coordinator::FakeFrameSource frames_;
    asio::io_context io_;
    std::shared_ptr<access::Gate> gate_;
    std::unique_ptr<Server> server_;
    std::uint16_t port_ = 0;
};

TEST(HttpRoles, LookingIsForViewersAndWhatIsNotKnownForAdministrators) {
    EXPECT_EQ(roleFor("GET", "/"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/assets/main.js"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/healthz"), std::nullopt);
    EXPECT_EQ(roleFor("GET", "/ws"), Role::View);
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

TEST(HttpCookies, AreFoundByTheirWholeName) {
    EXPECT_EQ(cookieNamed("a", "a=1; b=2"), "1");
    EXPECT_EQ(cookieNamed("b", "a=1; b=2"), "2");
    EXPECT_EQ(cookieNamed("b", "ab=1;b=2"), "2");
    EXPECT_EQ(cookieNamed("b", "a=b=1"), "");
    EXPECT_EQ(cookieNamed("b", "b"), "");
    EXPECT_EQ(cookieNamed("b", ";;b="), "");
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

TEST_F(HttpAccess, FiveHundredSlowConnectionsAreCutOffAndKeepNobodyOut) {
    ServerOptions options;  // and its usual patience
    options.limits.connections = 256;
    start(options, false);
    std::deque<tcp::socket> slow;
    for (int i = 0; i < 500; ++i) {
        slow.push_back(connect("127.0.0.2"));
        error_code ignored;  // the first of them are being cut off while the last come
        asio::write(slow.back(), asio::buffer(std::string("GET / HTTP/1.1\r\nX-a: ")), ignored);
        if (i % 10 == 0) {
            ASSERT_EQ(statusOf(request("GET", "/healthz")), 200) << "beside " << i << " slow ones";
        }
    }
    const auto isCut = [](tcp::socket& socket) {
        error_code error;
        socket.non_blocking(true, error);
        char byte = 'x';
        static_cast<void>(asio::write(socket, asio::buffer(&byte, 1), error));
        error.clear();
        std::array<char, 4096> answer{};
        while (!error) socket.read_some(asio::buffer(answer), error);
        return error != asio::error::would_block;
    };
    const auto end = std::chrono::steady_clock::now() + seconds(60);
    while (!slow.empty() && std::chrono::steady_clock::now() < end) {
        std::erase_if(slow, isCut);  // each gets a byte a round until then
        ASSERT_EQ(statusOf(request("GET", "/healthz")), 200)
            << slow.size() << " slow ones are left";
        std::this_thread::sleep_for(milliseconds(100));
    }
    EXPECT_TRUE(slow.empty()) << slow.size() << " are still connected";
}

TEST_F(HttpAccess, ARequestThatDoesNotComeToItsEndIsToldSoAndCounted) {
    ServerOptions options;
    options.headerTimeout = milliseconds(200);
    start(options, false);
    for (const char* part :
         {"GET / HT", "POST /login HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nab"}) {
        tcp::socket slow = connect();
        asio::write(slow, asio::buffer(std::string(part)));
        const std::string answer = answerOn(slow);
        EXPECT_THAT(answer, HasSubstr("HTTP/1.1 408")) << part;
        EXPECT_THAT(answer, HasSubstr("Connection: close")) << part;
    }
    tcp::socket idle = connect();
    EXPECT_EQ(answerOn(idle), "") << "nothing was asked";
    EXPECT_THAT(ask(request("GET", "/metrics")),
                HasSubstr("eyrie_requests_refused_total{reason=\"too_slow\"} 2\n"));
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

TEST_F(HttpAccess, AnIdleConnectionMakesRoomAndOneBeingServedDoesNot) {
    ServerOptions options;
    options.limits.connections = 4;
    start(options, false);
    tcp::socket viewer = connect("127.0.0.3");
    asio::write(viewer, asio::buffer(fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n",
                                                 port_, kUpgrade)));
    EXPECT_THAT(answerOn(viewer), HasSubstr("HTTP/1.1 101"));
    tcp::socket patient = connect("127.0.0.4");  // waits longest, but alone of its address
    std::deque<tcp::socket> idle;
    for (int i = 0; i < 20; ++i) idle.push_back(connect("127.0.0.2"));
    EXPECT_EQ(statusOf(request("GET", "/healthz")), 200);
    asio::write(patient, asio::buffer(request("GET", "/healthz")));
    EXPECT_THAT(answerOn(patient), HasSubstr("HTTP/1.1 200"));
    error_code error;
    viewer.non_blocking(true);
    std::array<char, 65536> part{};
    while (!error) viewer.read_some(asio::buffer(part), error);
    EXPECT_EQ(error, asio::error::would_block) << "the viewer is still connected";
}

TEST_F(HttpAccess, OneAddressCannotTakeAllSeats) {
    ServerOptions options;
    options.limits.viewersPerAddress = 3;
    start(options, false);
    const std::string upgrade =
        fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n", port_, kUpgrade);
    std::deque<tcp::socket> viewers;
    for (int i = 0; i < 3; ++i) {
        viewers.push_back(connect("127.0.0.2"));
        asio::write(viewers.back(), asio::buffer(upgrade));
        EXPECT_THAT(answerOn(viewers.back()), HasSubstr("HTTP/1.1 101"));
    }
    const std::string refused = ask(upgrade, "127.0.0.2");
    EXPECT_THAT(refused, HasSubstr("HTTP/1.1 429"));
    EXPECT_THAT(refused, HasSubstr("application/problem+json"));
    EXPECT_THAT(refused, HasSubstr("Retry-After"));
    EXPECT_THAT(refused, HasSubstr("too many viewers"));
    const std::string why = request("GET", "/ws");
    EXPECT_THAT(ask(why, "127.0.0.2"),
                testing::AllOf(HasSubstr("HTTP/1.1 429"), HasSubstr("Retry-After"),
                               HasSubstr("too many viewers")))
        << "a script that asks is told the same";
    for (int i = 0; i < 5; ++i)
        EXPECT_THAT(ask(why, "127.0.0.3"), HasSubstr("HTTP/1.1 426")) << "asking takes no seat";
    EXPECT_THAT(ask(upgrade, "127.0.0.3"), HasSubstr("HTTP/1.1 101"));
    viewers.clear();
    const auto end = std::chrono::steady_clock::now() + seconds(20);
    while (ask(upgrade, "127.0.0.2").starts_with("HTTP/1.1 429")) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "no seat is given up";
        std::this_thread::sleep_for(milliseconds(20));
    }
}

TEST_F(HttpAccess, OneAddressCannotBeginAllSessions) {
    ServerOptions options;
    options.limits.sessions = 3;
    options.limits.sessionsPerAddress = 2;
    start(options, false);
    std::deque<tcp::socket> viewers;
    const auto join = [&](const char* address, const std::string& session) {
        viewers.push_back(connect(address));
        asio::write(viewers.back(),
                    asio::buffer(fmt::format("GET /ws{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n",
                                             session, port_, kUpgrade)));
        return answerOn(viewers.back()).substr(0, 12);
    };
    const std::string yes = "HTTP/1.1 101";
    const std::string no = "HTTP/1.1 429";
    EXPECT_EQ(join("127.0.0.2", "?session=a"), yes);
    EXPECT_EQ(join("127.0.0.2", ""), yes);
    EXPECT_EQ(join("127.0.0.2", ""), no);
    EXPECT_EQ(join("127.0.0.2", "?session=b"), no);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(join("127.0.0.2", "?session=a"), yes) << "it is there";
    EXPECT_EQ(join("127.0.0.3", "?session=a"), yes);
    EXPECT_EQ(join("127.0.0.3", "?session=b"), yes);
    EXPECT_EQ(join("127.0.0.4", "?session=c"), no) << "three of all";
    viewers.clear();
    const auto end = std::chrono::steady_clock::now() + seconds(20);
    while (join("127.0.0.4", "?session=c") != yes) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "no place is given up";
        std::this_thread::sleep_for(milliseconds(20));
    }
}

TEST_F(HttpAccess, WhatIsTooLargeIsRefusedBeforeItIsRead) {
    start();
    const std::map<std::string, int> cases = {
        {"GET /" + std::string(17'000, 'a') + " HTTP/1.1\r\n\r\n", 431},
        {"GET / HTTP/1.1\r\nCookie: " + std::string(17'000, 'a') + "\r\n\r\n", 431},
        {"POST /login HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999\r\n\r\n", 413},
        {"POST /login HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400},
        {"POST /login HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFFF\r\n", 413},
        {"GET / HTTP/9.9\r\n\r\n", 400},
        {std::string("\0\0\0\0\r\n\r\n", 8), 400}};
    for (const auto& [text, status] : cases)
        EXPECT_EQ(statusOf(text), status) << text.substr(0, 60);
    EXPECT_EQ(statusOf(request("GET", "/healthz")), 200);
}

TEST(MessageRate, LetsBurstsOfASecondPassAndSlowsTheRest) {
    MessageRate rate(100);
    MessageRate::Clock::time_point now{seconds(1000)};
    int taken = 0;
    while (rate.take(now) == MessageRate::Clock::duration::zero()) ++taken;
    EXPECT_EQ(taken, 100);
    int inTenSeconds = 0;
    for (const auto end = now + seconds(10); now < end; ++inTenSeconds) now += rate.take(now);
    EXPECT_NEAR(inTenSeconds, 1000, 10);
}

/// As HttpAccess, over TLS.
class Https : public HttpAccess {
protected:
    void start(const test::Authority::Holder& holder = {}) {
        ServerOptions options;
        options.tls = authority_.issue("server", holder);
        HttpAccess::start(options);
    }

    /// The answer to a request by who believes `authority`; empty: no connection was made.
    std::string ask(const std::string& text, const test::Authority& authority) {
        asio::ssl::context context(asio::ssl::context::tls_client);
        context.load_verify_file(authority.file());
        context.set_verify_mode(asio::ssl::verify_peer);
        asio::ssl::stream<tcp::socket> stream(connect(), context);
        stream.set_verify_callback(asio::ssl::host_name_verification("127.0.0.1"));
        error_code error;
        stream.handshake(asio::ssl::stream_base::client, error);
        std::string answer;
        if (!error)
            asio::write(stream, asio::buffer(text), error);
        if (!error)
            asio::read(stream, asio::dynamic_buffer(answer), error);
        return answer;
    }

    test::Authority authority_{"the authority"};
};

TEST_F(Https, ServesWhoBelievesItsAuthorityAndNobodyInTheClear) {
    start();
    EXPECT_TRUE(server_->url().starts_with("https://"));
    const std::string answer = ask(request("POST", "/login", bearer(kViewToken)), authority_);
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("; Secure"));
    const test::Authority other("another");
    EXPECT_EQ(ask(request("GET", "/healthz"), other), "");
    EXPECT_THAT(HttpAccess::ask(request("GET", "/healthz")), Not(HasSubstr("HTTP/1.1 200")));
    EXPECT_THAT(ask(request("GET", "/healthz"), authority_), HasSubstr("HTTP/1.1 200"));
    connect().close();  // who only looks whether the port is open
    EXPECT_THAT(ask(request("GET", "/metrics", bearer(kViewToken)), authority_),
                HasSubstr("eyrie_peers_refused_total{door=\"http\",reason=\"handshake\"} 2\n"));
}

TEST_F(Https, IsMeantByTargetsOfItsSchemeAndByNoOthers) {
    start();
    const auto statusOf = [this](const std::string& scheme) {
        return ask(request("GET", fmt::format("{}://127.0.0.1:{}/healthz", scheme, port_)),
                   authority_)
            .substr(0, 12);
    };
    EXPECT_EQ(statusOf("https"), "HTTP/1.1 200");
    EXPECT_EQ(statusOf("http"), "HTTP/1.1 421");
}

TEST_F(Https, CarriesWebSockets) {
    start();
    asio::ssl::context context(asio::ssl::context::tls_client);
    asio::ssl::stream<tcp::socket> stream(connect(), context);
    stream.handshake(asio::ssl::stream_base::client);
    asio::write(stream,
                asio::buffer(fmt::format("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}{}\r\n",
                                         port_, kUpgrade, bearer(kViewToken))));
    std::string received(4096, '\0');
    received.resize(stream.read_some(asio::buffer(received)));
    EXPECT_THAT(received, HasSubstr("HTTP/1.1 101"));
    while (received.find("hill") == std::string::npos) {  // the state names the scene's object
        std::string more(4096, '\0');
        error_code error;
        more.resize(stream.read_some(asio::buffer(more), error));
        ASSERT_FALSE(error) << error.message();
        received += more;
    }
}

TEST_F(Https, TakesAReplacedCertificateForNewConnectionsAndKeepsTheOldOnes) {
    start();
    asio::ssl::context context(asio::ssl::context::tls_client);
    asio::ssl::stream<tcp::socket> old(connect(), context);
    old.handshake(asio::ssl::stream_base::client);
    EXPECT_THAT(ask(request("GET", "/healthz"), authority_), HasSubstr("HTTP/1.1 200"));
    // For another host, so that it shows which one is used.
    authority_.issue("server", {.name = "elsewhere.example"});
    const auto end = std::chrono::steady_clock::now() + seconds(20);
    while (!ask(request("GET", "/healthz"), authority_).empty()) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "the new certificate is not taken";
        std::this_thread::sleep_for(milliseconds(100));
    }
    asio::write(old, asio::buffer(request("GET", "/healthz")));
    std::string answer;
    error_code ignored;
    asio::read(old, asio::dynamic_buffer(answer), ignored);
    EXPECT_THAT(answer, HasSubstr("HTTP/1.1 200"));
    authority_.issue("server");
    while (ask(request("GET", "/healthz"), authority_).empty()) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << "the third certificate is not taken";
        std::this_thread::sleep_for(milliseconds(100));
    }
}

TEST_F(Https, RefusesToStartWithFilesThatNobodyCouldUse) {
    const auto statusWith = [&](const access::TlsFiles& files) {
        ServerOptions options;
        options.port = 0;
        options.tls = files;
        return Server::start(options, frames_).status();
    };
    EXPECT_THAT(
        std::string(statusWith(authority_.issue("old", {.validToSeconds = -1800})).message()),
        HasSubstr("has expired"));
    EXPECT_THAT(
        std::string(statusWith(authority_.issue("new", {.validFromSeconds = 1800})).message()),
        HasSubstr("is not valid yet"));
    access::TlsFiles mixed = authority_.issue("one");
    mixed.key = authority_.issue("two").key;
    EXPECT_THAT(std::string(statusWith(mixed).message()), HasSubstr("goes with the certificate"));
    EXPECT_TRUE(absl::IsNotFound(statusWith({"/none.crt", mixed.key, ""})));
    std::filesystem::permissions(mixed.key, std::filesystem::perms(0644));
    EXPECT_TRUE(absl::IsPermissionDenied(statusWith({mixed.certificate, mixed.key, ""})));
}

TEST_F(Https, CutsOffAHandshakeThatIsNotFinished) {
    ServerOptions options;
    options.headerTimeout = milliseconds(200);
    options.tls = authority_.issue("server");
    HttpAccess::start(options);
    tcp::socket mute = connect();
    asio::write(mute, asio::buffer(std::string("\x16\x03\x01", 3)));
    char byte = 0;
    error_code error;
    asio::read(mute, asio::buffer(&byte, 1), error);
    EXPECT_TRUE(error);
}

}  // namespace
}  // namespace eyrie::http
