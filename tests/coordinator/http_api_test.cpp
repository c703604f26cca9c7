// SPDX-License-Identifier: Apache-2.0
// Calls of the API over connections: what they hold up, and what ends them.
#include <future>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include "coordinator/api/api.h"
#include "coordinator/api/call_roles.h"
#include "coordinator/api/coordinator_service.h"
#include "coordinator/api/rest_routes.h"
#include "coordinator/http/access.h"
#include "coordinator/http/server.h"
#include "coordinator/stream/session_book.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::http {
namespace {

using boost::asio::ip::tcp;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;

class NoConfiguration : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>&) override {
        return absl::FailedPreconditionError("there is none");
    }
};

class HttpApi : public testing::Test {
protected:
    HttpApi() { start(); }

    void start(ServerOptions options = {}) {
        options.port = 0;
        if (options.api == nullptr)
            options.api = &api_.rest();
        options.sessions = api_.sessions();
        options.writeTimeout = milliseconds(1500);
        server_ = Server::start(options, frames_).value();
        const std::string url = server_->url();
        port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
    }

    tcp::socket send(const std::string& request) {
        tcp::socket socket(io_);
        socket.connect({boost::asio::ip::make_address("127.0.0.1"), port_});
        boost::asio::write(socket, boost::asio::buffer(request));
        return socket;
    }

    bool isListening() {
        tcp::socket socket(io_);
        boost::system::error_code error;
        socket.connect({boost::asio::ip::make_address("127.0.0.1"), port_}, error);
        return !error;
    }

    static std::string receive(tcp::socket socket) {
        std::string answer;
        boost::system::error_code end;
        boost::asio::read(socket, boost::asio::dynamic_buffer(answer), end);
        return answer;
    }

    std::string ask(const std::string& line, const std::string& headers = "") {
        return receive(send(fmt::format(
            "{} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n{}\r\n", line, headers)));
    }

    std::string profile() const {
        const std::string body = R"({"samples":512})";
        return fmt::format(
            "POST /api/v1/profile HTTP/1.1\r\nHost: localhost\r\n"
            "Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
            body.size(), body);
    }

    coordinator::FakeFrameSource frames_;
    NoConfiguration configuration_;
    api::Api api_{{frames_, configuration_, [](fabric::Scene) {}}};
    boost::asio::io_context io_;
    std::unique_ptr<Server> server_;
    std::uint16_t port_ = 0;
};

TEST_F(HttpApi, OthersAreAnsweredWhileAPictureIsDrawn) {
    frames_.hold(true);
    auto picture = std::async(std::launch::async, [this] {
        return receive(
            send("GET /api/v1/image?width=20&height=10 HTTP/1.1\r\nHost: localhost\r\n"
                 "Connection: close\r\n\r\n"));
    });
    ASSERT_TRUE(frames_.waitForRequests(1));
    EXPECT_THAT(ask("GET /healthz"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(ask("GET /api/v1/status"), StartsWith("HTTP/1.1 200"));
    frames_.hold(false);
    const std::string answer = picture.get();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Type: image/png"));
}

TEST_F(HttpApi, SeveralPicturesAreAskedForAtOnce) {
    frames_.hold(true);
    std::vector<std::future<std::string>> pictures;
    for (int i = 0; i < 4; ++i)
        pictures.push_back(
            std::async(std::launch::async, [this] { return ask("GET /api/v1/image?width=20"); }));
    EXPECT_TRUE(frames_.waitForRequests(4));
    frames_.hold(false);
    for (auto& picture : pictures) EXPECT_THAT(picture.get(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpApi, CallsEndWithTheirConnection) {
    frames_.setPick([](const fabric::PickRequest&) {
        std::this_thread::sleep_for(milliseconds(50));  // all of them take longer than the test
        return fabric::Picked();
    });
    {
        const tcp::socket client = send(profile());
        ASSERT_TRUE(frames_.waitForPicks(1));
    }
    std::size_t before = 0;
    for (int i = 0; i < 40 && before != frames_.picks().size(); ++i) {
        before = frames_.picks().size();
        std::this_thread::sleep_for(milliseconds(500));
    }
    EXPECT_LT(frames_.picks().size(), 512U);
    EXPECT_EQ(frames_.picks().size(), before);
}

TEST_F(HttpApi, PicturesEndWithTheirConnection) {
    frames_.hold(true);
    {
        const tcp::socket client =
            send("GET /api/v1/image?width=20 HTTP/1.1\r\nHost: localhost\r\n\r\n");
        ASSERT_TRUE(frames_.waitForRequests(1));
        EXPECT_FALSE(frames_.requests().front().stop.stop_requested());
    }
    EXPECT_TRUE(eventually([&] { return frames_.requests().front().stop.stop_requested(); }));
    frames_.hold(false);
}

/// As over TLS, which says good-bye before the connection ends.
TEST_F(HttpApi, PicturesEndWithAConnectionThatSaidMoreBeforeItsEnd) {
    frames_.hold(true);
    {
        tcp::socket client = send("GET /api/v1/image?width=20 HTTP/1.1\r\nHost: localhost\r\n\r\n");
        ASSERT_TRUE(frames_.waitForRequests(1));
        boost::asio::write(client, boost::asio::buffer(std::string("GET /healthz HTTP/1.1")));
        EXPECT_FALSE(frames_.requests().front().stop.stop_requested());
    }
    EXPECT_TRUE(eventually([&] { return frames_.requests().front().stop.stop_requested(); }));
    frames_.hold(false);
}

TEST_F(HttpApi, CallsInProgressAreAnsweredByAServerThatStops) {
    ServerOptions options;
    options.drainTimeout = std::chrono::seconds(30);
    start(options);
    frames_.hold(true);
    tcp::socket client = send("GET /api/v1/image?width=20 HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(frames_.waitForRequests(1));
    std::jthread stopping([this] { server_->stop(); });
    EXPECT_TRUE(eventually([this] { return !isListening(); }));
    frames_.hold(false);
    const std::string answer = receive(std::move(client));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Type: image/png"));
    EXPECT_THAT(answer, HasSubstr("Connection: close"));
}

TEST_F(HttpApi, CallsThatAServerCannotWaitForAreToBeMadeAgain) {
    ServerOptions options;
    options.drainTimeout = milliseconds(300);
    start(options);
    frames_.setPick([](const fabric::PickRequest&) {
        std::this_thread::sleep_for(milliseconds(50));
        return fabric::Picked();
    });
    tcp::socket client = send(profile());
    ASSERT_TRUE(frames_.waitForPicks(1));
    server_->stop();
    EXPECT_LT(frames_.picks().size(), 512U);
    const std::string answer = receive(std::move(client));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(answer, HasSubstr("Retry-After: "));
    EXPECT_THAT(answer, HasSubstr("Connection: close"));
    EXPECT_THAT(answer, HasSubstr("this server is stopping"));
}

/// Numbers have as many digits as there are at most.
TEST_F(HttpApi, AFlightOfAsManyKeysAsItMayHaveCanBePutBackAsItIsGot) {
    const test::TemporaryFolder folder;
    api::Api api{{frames_, configuration_, [](fabric::Scene) {},
                  access::DataFolder::open(folder.path()).value()}};
    ServerOptions options;
    options.api = &api.rest();
    start(options);
    const auto put = [this](std::string_view flight) {
        return receive(send(
            fmt::format("PUT /api/v1/flights/a HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
                        "Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
                        flight.size(), flight)));
    };
    std::string keys;
    for (int i = 0; i < 10'000; ++i) {
        const auto number = [i](int n) {
            return fmt::format("-1.{:05}{:02}8901234567e-100", i, n);
        };
        keys +=
            fmt::format(R"({}{{"seconds":1.{:05}78901234567e-100,"camera":{{"eye":[{},{},{}],)"
                        R"("target":[{},{},-1.2345678901234567],"up":[{},1.2345678901234567,{}],)"
                        R"("fovyDegrees":12.345678901234567}}}})",
                        i == 0 ? "" : ",", i, number(1), number(2), number(3), number(4), number(5),
                        number(6), number(7));
    }
    ASSERT_THAT(put(fmt::format(R"({{"keys":[{}]}})", keys)), StartsWith("HTTP/1.1 200"));
    const std::string got = ask("GET /api/v1/flights/a");
    ASSERT_THAT(got.substr(0, 20), StartsWith("HTTP/1.1 200"));
    const std::string flight = got.substr(got.find("\r\n\r\n") + 4);
    EXPECT_LT(keys.size(), flight.size());
    EXPECT_THAT(put(flight).substr(0, 20), StartsWith("HTTP/1.1 200"));
    server_->stop();  // before its API goes
}

/// Reads until `text` has come; what has come so far.
std::string readUntil(tcp::socket& socket, const std::string& text) {
    std::string answer;
    boost::system::error_code end;
    boost::asio::read_until(socket, boost::asio::dynamic_buffer(answer), text, end);
    return answer;
}

TEST_F(HttpApi, StatisticsAreEventsThatGoOn) {
    tcp::socket client = send("GET /api/v1/statistics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::string head = readUntil(client, "\r\n\r\n");
    EXPECT_THAT(head, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(head, HasSubstr("Content-Type: text/event-stream"));
    EXPECT_THAT(head, HasSubstr("Transfer-Encoding: chunked"));
    EXPECT_THAT(head, HasSubstr("Content-Security-Policy"));
    for (int i = 1; i <= 3; ++i) {
        EXPECT_THAT(ask("GET /api/v1/image?width=20&height=10"), StartsWith("HTTP/1.1 200"));
        EXPECT_THAT(readUntil(client, "}\n\n"), HasSubstr(fmt::format("\"frame\":\"{}\"", i)));
    }
    server_->stop();
    EXPECT_THAT(receive(std::move(client)), testing::EndsWith("0\r\n\r\n")) << "a whole answer";
}

TEST_F(HttpApi, StatisticsEndWithTheirConnection) {
    for (int i = 0; i < 100; ++i) {  // there are places for 64
        tcp::socket client = send("GET /api/v1/statistics HTTP/1.1\r\nHost: localhost\r\n\r\n");
        const std::string head = readUntil(client, "\r\n\r\n");
        ASSERT_THAT(head, testing::AnyOf(StartsWith("HTTP/1.1 200"), StartsWith("HTTP/1.1 429")));
        client.close();
    }
    EXPECT_TRUE(eventually([this] {
        tcp::socket client = send("GET /api/v1/statistics HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return readUntil(client, "\r\n\r\n").starts_with("HTTP/1.1 200");
    }));
}

TEST_F(HttpApi, WhoTakesNoStatisticsIsCutOff) {
    tcp::socket client = send("GET /api/v1/statistics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    readUntil(client, "\r\n\r\n");
    coordinator::FrameRequest request;
    request.width = request.height = 1;
    coordinator::RenderedFrame frame = coordinator::plainFrame(request, {});
    coordinator::DrawnPart part;
    part.renderer = std::string(60, 'r');
    frame.parts.resize(20'000, part);
    // Until the system takes no more of it, and then for the write's time.
    std::jthread drawing([&](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            api_.sessions()->statistics().drawn("", frame);
            std::this_thread::sleep_for(milliseconds(5));
        }
    });
    EXPECT_TRUE(eventually([&] {
        boost::system::error_code error;
        boost::asio::write(client, boost::asio::buffer("x", 1), error);
        return bool(error);
    }));
    EXPECT_THAT(ask("GET /metrics"),
                HasSubstr("eyrie_requests_refused_total{reason=\"too_slow\"} 1\n"));
}

TEST_F(HttpApi, AddressesInScenesAreWholeForThoseAloneWhoMayShowThemAgain) {
    const std::string address = "https://joe:sekret@host/a.eyt?sig=S";
    coordinator::Status status = frames_.status();
    status.scene.objects = {{"a", fabric::ObjectKind::Terrain, address}};
    frames_.setStatus(status);
    EXPECT_THAT(ask("GET /api/v1/scene"), HasSubstr(address)) << "all may all without tokens";

    const std::string view = "view-0123456789abcdef0123456789";
    const std::string control = "control-0123456789abcdef0123456789";
    ServerOptions options;
    options.gate = std::make_shared<access::Gate>(
        *access::Tokens::parse(fmt::format("view {}\ncontrol {}\n", view, control), "t"));
    start(options);
    const auto shownTo = [this](const std::string& token) {
        return ask("GET /api/v1/scene", fmt::format("Authorization: Bearer {}\r\n", token));
    };
    EXPECT_THAT(shownTo(view), HasSubstr("\"https://…@host/a.eyt?…\""));
    EXPECT_THAT(shownTo(control), HasSubstr(address));
}

TEST_F(HttpApi, PagesOfOtherSitesGetNothing) {
    EXPECT_THAT(ask("GET /api/v1/status", "Origin: http://evil.example\r\n"),
                StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(ask("GET /api/v1/image?width=20", "Origin: http://evil.example\r\n"),
                StartsWith("HTTP/1.1 403"));
    EXPECT_TRUE(frames_.requests().empty());
}

/// As a page gets whose name its owner has pointed at this machine after it was loaded.
TEST_F(HttpApi, NothingIsReadUnderAStrangersName) {
    std::vector<std::string> targets = {
        "/", "/api", "/api/v1/openapi.json", "/login", "/metrics", "/none", "/readyz", "/ws"};
    for (const api::Route& route : api::restRoutes())
        if (route.rest.method() == "GET")
            targets.push_back("/api/v1" + route.rest.path());
    const auto asked = [this](const std::string& target, const std::string& host) {
        return receive(send(
            fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", target, host)));
    };
    for (const std::string& target : targets)
        for (const std::string& answer :
             {asked(target, "evil.example"), asked("http://evil.example" + target, "localhost")}) {
            EXPECT_THAT(answer, StartsWith("HTTP/1.1 403")) << target;
            EXPECT_THAT(answer, HasSubstr("as localhost")) << target;
        }
    EXPECT_THAT(asked("/healthz", "evil.example"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(asked("/metrics", "localhost"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(asked("/readyz", "127.0.0.1:80"), StartsWith("HTTP/1.1 200"));
}

/// As of a container's port that its machine publishes to itself alone.
TEST_F(HttpApi, OnAllAddressesStrangersNamesAreRefusedWhereItIsAskedFor) {
    const auto asked = [this](const std::string& line, const std::string& host) {
        return receive(send(
            fmt::format("{} HTTP/1.1\r\nHost: {}\r\nOrigin: http://{}\r\nConnection: close\r\n\r\n",
                        line, host, host)));
    };
    ServerOptions options;
    options.host = "0.0.0.0";
    start(options);
    EXPECT_THAT(asked("GET /api/v1/status", "viz.example"), StartsWith("HTTP/1.1 200"));
    options.localNamesOnly = true;
    start(options);
    EXPECT_THAT(asked("GET /api/v1/status", "evil.example"), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(asked("POST /api/v1/imports", "evil.example"), StartsWith("HTTP/1.1 403"));
    for (const char* host : {"localhost", "127.0.0.1:80", "[::1]:80"})
        EXPECT_THAT(asked("GET /api/v1/status", host), StartsWith("HTTP/1.1 200")) << host;
}

/// RFC 9112, 3.2.2: what a client sends that takes this server for a proxy.
TEST_F(HttpApi, TargetsInAbsoluteFormAreAnsweredAsOthers) {
    const std::string here = fmt::format("http://127.0.0.1:{}", port_);
    EXPECT_THAT(ask("GET " + here + "/api/v1/status"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(ask("GET HTTP://LocalHost/api/v1/status"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(ask("GET " + here), StartsWith("HTTP/1.1 503")) << "the page is not built here";
    EXPECT_THAT(ask("GET " + here + "?a=/api/v1/status"), StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(ask("GET " + here + "/api/v1/image?width=0"), HasSubstr(R"("field":"width")"));
    EXPECT_THAT(ask("GET " + here + "/ws"), StartsWith("HTTP/1.1 426"));
    EXPECT_THAT(ask("GET https://localhost/api/v1/status"), StartsWith("HTTP/1.1 421"));
    EXPECT_THAT(ask("GET ftp://localhost/api/v1/status"), StartsWith("HTTP/1.1 421"));
    for (const char* host : {"", ":80", "user@localhost", "localhost:80@evil.example",
                             "[::1].evil.example", "local%68ost", "localhost:x", "[::1", "a\\b"})
        EXPECT_THAT(ask(fmt::format("GET http://{}/healthz", host)), StartsWith("HTTP/1.1 400"))
            << host;
}

TEST_F(HttpApi, TheHostOfATargetTakesThePlaceOfTheHeader) {
    const std::string here = fmt::format("127.0.0.1:{}", port_);
    const auto statusOf = [&](const std::string& line, const std::string& host,
                              const std::string& origin) {
        const std::string headers =
            fmt::format("Host: {}\r\nConnection: close\r\n{}\r\n", host,
                        origin.empty() ? "" : fmt::format("Origin: {}\r\n", origin));
        return receive(send(fmt::format("{} HTTP/1.1\r\n{}", line, headers))).substr(9, 3);
    };
    const std::string asked = fmt::format("GET http://{}/api/v1/status", here);
    EXPECT_EQ(statusOf(asked, "evil.example", ""), "200");
    EXPECT_EQ(statusOf(asked, "evil.example", "http://" + here), "200");
    EXPECT_EQ(statusOf(asked, "evil.example", "http://evil.example"), "403");
    EXPECT_EQ(statusOf(asked, here, "http://evil.example"), "403");
    EXPECT_EQ(statusOf("GET http://evil.example/api/v1/status", here, ""), "403");
    EXPECT_EQ(statusOf("GET http://evil.example/api/v1/status", here, "http://" + here), "403");
    EXPECT_EQ(statusOf("GET http://evil.example/metrics", here, ""), "403");
    EXPECT_EQ(statusOf("GET http://evil.example/healthz", here, ""), "200") << "tells nothing";
    EXPECT_EQ(statusOf(fmt::format("DELETE http://{}/api/v1/sessions/none", here), here,
                       "http://evil.example"),
              "403");
    EXPECT_EQ(statusOf(fmt::format("DELETE http://{}/api/v1/sessions/none", here), "evil.example",
                       "http://" + here),
              "404");
}

TEST_F(HttpApi, ConditionsInHeadersHold) {
    EXPECT_THAT(ask("GET /api/v1/status", "If-None-Match: *\r\n"), StartsWith("HTTP/1.1 304"));
    EXPECT_THAT(ask("DELETE /api/v1/sessions/none"), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(ask("DELETE /api/v1/sessions/none", "If-Match: \"a\"\r\n"),
                StartsWith("HTTP/1.1 412"));
}

TEST_F(HttpApi, ErrorsAreProblems) {
    const std::string wrong = ask("GET /api/v1/image?width=0");
    EXPECT_THAT(wrong, StartsWith("HTTP/1.1 400"));
    EXPECT_THAT(wrong, HasSubstr("Content-Type: application/problem+json"));
    EXPECT_THAT(ask("DELETE /api/v1/image"), HasSubstr("Allow: POST, GET"));
    EXPECT_THAT(ask("GET /api"), HasSubstr("<title>Eyrie"));
}

TEST_F(HttpApi, WhatOnlyDescribesItIsReadAndNothingElse) {
    for (const char* path : {"/api", "/api/", "/api/style.css", "/api/v1/openapi.json"}) {
        for (const std::string& query : {std::string(), std::string("?x=1")})
            for (const std::string& method : {std::string("GET "), std::string("HEAD ")})
                EXPECT_THAT(ask(method + path + query), StartsWith("HTTP/1.1 200"))
                    << method << path << query;
        for (const std::string& method : {std::string("POST "), std::string("DELETE ")}) {
            const std::string answer = ask(method + path);
            EXPECT_THAT(answer, StartsWith("HTTP/1.1 405")) << method << path;
            EXPECT_THAT(answer, HasSubstr("Allow: GET\r\n")) << method << path;
        }
    }
    EXPECT_THAT(ask("POST /api/none"), StartsWith("HTTP/1.1 404"));
}

TEST(Roles, OfACallAreTheSameByEitherDoor) {
    ASSERT_FALSE(api::restRoutes().empty());
    for (const api::Route& route : api::restRoutes())
        EXPECT_EQ(roleFor(route.rest.method(), "/api/v1" + route.rest.path()),
                  api::roleFor(route.call->name()))
            << route.call->name();
}

}  // namespace
}  // namespace eyrie::http
