// SPDX-License-Identifier: Apache-2.0
// What those who come by HTTP and mean ill cannot do to the others.
#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <string>
#include <thread>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/http/message_rate.h"
#include "coordinator/http/server.h"
#include "tests/coordinator/http_access_fixture.h"

namespace eyrie::http {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

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
    options.headerTimeout = milliseconds(1000);
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

/// As Python's urllib does, which then finds out whether there is an answer.
TEST_F(HttpAccess, WhoSendsAllOfABodyThatIsTooLongFirstReadsThatItIs) {
    start({}, false);
    tcp::socket socket = connect();
    const std::string body(50'000'000, ' ');
    asio::write(socket, asio::buffer(fmt::format("POST /login HTTP/1.1\r\nHost: localhost\r\n"
                                                 "Content-Length: {}\r\n\r\n",
                                                 body.size())));
    error_code error;
    EXPECT_EQ(asio::write(socket, asio::buffer(body), error), body.size()) << error.message();
    EXPECT_THAT(answerOn(socket), testing::AllOf(testing::StartsWith("HTTP/1.1 413"),
                                                 HasSubstr("longer than 8 MiB")));
}

TEST_F(HttpAccess, ALongChangeThatDoesNotSayItsLengthIsToldTo) {
    start({}, false);
    const std::string piece = fmt::format("100000\r\n{}\r\n", std::string(0x100000, ' '));
    for (const auto& [target, saysWhat] :
         {std::pair<const char*, bool>{"PUT /api/v1/flights/a", true}, {"POST /login", false}}) {
        tcp::socket socket = connect();
        error_code ignored;
        asio::write(socket,
                    asio::buffer(fmt::format("{} HTTP/1.1\r\nHost: localhost\r\n"
                                             "Transfer-Encoding: chunked\r\n\r\n{}{}",
                                             target, piece, piece)),
                    ignored);
        const std::string answer = answerOn(socket);
        EXPECT_THAT(answer, HasSubstr("longer than 1 MiB")) << target;
        EXPECT_EQ(answer.find("say its Content-Length") != answer.npos, saysWhat) << target;
    }
}

TEST_F(HttpAccess, WhatWouldStillComeOfARefusedRequestIsNotWaitedForForEver) {
    ServerOptions options;
    options.headerTimeout = milliseconds(500);
    start(options, false);
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(std::string("POST /login HTTP/1.1\r\nHost: localhost\r\n"
                                                 "Content-Length: 2000000\r\n\r\n")));
    EXPECT_THAT(answerOn(socket), testing::StartsWith("HTTP/1.1 413"));
    error_code error;
    const auto end = std::chrono::steady_clock::now() + seconds(20);
    while (!error && std::chrono::steady_clock::now() < end) {
        asio::write(socket, asio::buffer(std::string(" ")), error);
        std::this_thread::sleep_for(milliseconds(20));
    }
    EXPECT_TRUE(error) << "it is still connected";
}

TEST_F(HttpAccess, OnlyWhoMayMakeAChangeMaySayItAtLength) {
    start();
    const auto put = [this](const char* token, std::size_t length) {
        return statusOf(request("PUT", "/api/v1/flights/a",
                                fmt::format("{}Content-Length: {}\r\n", bearer(token), length)) +
                        std::string(length, ' '));
    };
    EXPECT_EQ(put(kViewToken, 2'000'000), 403);
    EXPECT_EQ(put("wrong-0123456789abcdef0123456789", 2'000'000), 401);
    EXPECT_EQ(put(kControlToken, 2'000'000), 405) << "it was read, by a server without API";
    EXPECT_EQ(put(kAdminToken, 8 * 1024 * 1024), 405);
    EXPECT_EQ(put(kAdminToken, 8 * 1024 * 1024 + 1), 413);
    EXPECT_EQ(statusOf(request("POST", "/api/v1/profile",
                               bearer(kAdminToken) + "Content-Length: 2000000\r\n")),
              413)
        << "no change";
}

TEST_F(HttpAccess, FewLongBodiesAreHeldAtOnce) {
    start({}, false);
    const std::string header = request("PUT", "/api/v1/scene", "Content-Length: 2000000\r\n");
    const std::string whole = header + std::string(2'000'000, ' ');
    std::deque<tcp::socket> slow;
    for (int i = 0; i < 16; ++i) {
        slow.push_back(connect());
        asio::write(slow.back(), asio::buffer(header));
    }
    const auto end = std::chrono::steady_clock::now() + seconds(8);
    int status = 0;
    while (status != 503 && std::chrono::steady_clock::now() < end) status = statusOf(whole);
    EXPECT_EQ(status, 503);
    EXPECT_EQ(statusOf(request("PUT", "/api/v1/scene", "Content-Length: 2\r\n") + "{}"), 405);
    slow.clear();
    while (status == 503 && std::chrono::steady_clock::now() < end + seconds(20))
        status = statusOf(whole);
    EXPECT_EQ(status, 405) << "there is room again";
}

TEST_F(HttpAccess, WhoWaitsToSendABodyIsToldToGoOn) {
    start({}, false);
    tcp::socket socket = connect();
    const std::string header =
        "POST /login HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Length: 2\r\n";
    const std::string goOn = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::write(socket, asio::buffer(header + "Expect: 100-Continue\r\n\r\n"));
    std::string told(goOn.size(), ' ');
    asio::read(socket, asio::buffer(told));
    ASSERT_EQ(told, goOn);
    asio::write(socket, asio::buffer(std::string("{}")));
    EXPECT_THAT(answerOn(socket), testing::StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(ask(header + "\r\n{}"), testing::StartsWith("HTTP/1.1 200")) << "who does not wait";
}

TEST_F(HttpAccess, NobodyIsToldToGoOnWithWhatIsTooLongOrNotThere) {
    start({}, false);
    const std::string waiting = "Host: localhost\r\nConnection: close\r\nExpect: 100-continue\r\n";
    EXPECT_EQ(statusOf("POST /login HTTP/1.1\r\nContent-Length: 2000000\r\n" + waiting + "\r\n"),
              413);
    EXPECT_EQ(statusOf("GET /healthz HTTP/1.1\r\n" + waiting + "\r\n"), 200);
    EXPECT_EQ(statusOf("POST /login HTTP/1.0\r\nContent-Length: 2\r\n" + waiting + "\r\n{}"), 200)
        << "HTTP/1.0 knows no such answer";
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

}  // namespace
}  // namespace eyrie::http
