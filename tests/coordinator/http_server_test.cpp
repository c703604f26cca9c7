// SPDX-License-Identifier: Apache-2.0
// What is asked for by HTTP: the page, readiness, metrics, and what is refused.
#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "coordinator/http/write_pace.h"
#include "tests/coordinator/http_server_fixture.h"
#include "tests/service/eventually.h"
#include "tests/support/ways_out.h"

namespace eyrie::http {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;

TEST_F(HttpServer, ServesTheBuiltPage) {
    start();
    const Response page = get("/");
    EXPECT_EQ(page.result_int(), 200u);
    EXPECT_EQ(page["Content-Type"], "text/html; charset=utf-8");
    EXPECT_EQ(page["Cache-Control"], "no-cache");
    EXPECT_EQ(page["X-Content-Type-Options"], "nosniff");
    EXPECT_THAT(std::string(page["Content-Security-Policy"]),
                testing::AllOf(HasSubstr("script-src 'self'"), Not(HasSubstr("unsafe"))));
    EXPECT_THAT(page.body(), HasSubstr("<title>page</title>"));

    const Response script = get("/assets/main-1234.js?v=1");
    EXPECT_EQ(script["Content-Type"], "text/javascript; charset=utf-8");
    EXPECT_THAT(std::string(script["Cache-Control"]), HasSubstr("immutable"));
    EXPECT_EQ(get("/icon.svg")["Content-Type"], "image/svg+xml");
}

TEST_F(HttpServer, NeverServesAnythingOutsideTheFolder) {
    start();
    std::vector<std::string> paths = {"/link.txt", "/assets", "/assets/", "//secret.txt",
                                      "/assets/%00/../../secret.txt"};
    for (const std::string& way : test::waysOut()) {
        if (!way.empty())
            paths.push_back("/" + way);
        paths.push_back("/assets/" + way);
    }
    for (const std::string& path : paths)
        for (const std::string& server : {std::string(), "http://" + hostAndPort()}) {
            const Response response = get(server + path);
            // 400: with such characters it is no HTTP.
            EXPECT_TRUE(response.result_int() == 404 || response.result_int() == 400)
                << server << path << response.result_int();
            EXPECT_THAT(response.body(), Not(HasSubstr("SECRET"))) << path;
            EXPECT_THAT(response.body(), Not(HasSubstr("root:"))) << path;
        }
    EXPECT_EQ(get("file:///etc/passwd").result_int(), 421u);
    EXPECT_EQ(get("*").result_int(), 404u);
}

TEST_F(HttpServer, SaysHowToBuildThePageWhereItIsMissing) {
    ServerOptions options;
    options.port = 0;
    options.webFolder = web_.path() / "absent";
    server_ = *Server::start(options, frames_);
    const Response page = get("/");
    EXPECT_EQ(page.result_int(), 503u);
    EXPECT_THAT(page.body(), HasSubstr("EYRIE_BUILD_WEB=ON"));
}

TEST_F(HttpServer, IsReadyOnlyWithARendererAndAScene) {
    start();
    EXPECT_EQ(get("/healthz").result_int(), 200u);
    const Response ready = get("/readyz");
    EXPECT_EQ(ready.result_int(), 200u);
    EXPECT_EQ(ready["Content-Type"], "application/json");
    EXPECT_EQ(
        ready.body(),
        R"({"ready":true,"problem":"","note":"","renderers":[{"id":"renderer-1","address":"",)"
        R"("alive":true,"condition":"ready","why":"","sinceUnixMilliseconds":0,)"
        R"("device":"fake","driver":"","platform":"","software":true}],)"
        R"("scene":{"objects":["hill"],"triangles":1000000}})"
        "\n");

    coordinator::Status status = coordinator::readyStatus();
    status.renderers[0].condition = coordinator::RendererCondition::Dead;
    frames_.setStatus(status);
    EXPECT_EQ(get("/readyz").result_int(), 503u);

    status = coordinator::readyStatus();
    status.sceneInfo = {};
    status.problem = "opening \"hill\"\n";
    frames_.setStatus(status);
    EXPECT_EQ(get("/readyz").result_int(), 503u);
    EXPECT_THAT(get("/readyz").body(), HasSubstr(R"("problem":"opening \"hill\"\u000a")"));
    EXPECT_EQ(get("/healthz").result_int(), 200u);
}

TEST_F(HttpServer, AnswersHeadWithoutABodyAndRefusesOtherMethods) {
    start();
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(std::string(
                            "HEAD / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")));
    std::string received;
    beast::error_code error;
    asio::read(socket, asio::dynamic_buffer(received), error);
    EXPECT_THAT(received, HasSubstr("Content-Length: 34"));
    EXPECT_TRUE(received.ends_with("\r\n\r\n"));

    const Response post =
        exchange("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 2\r\n\r\nhi");
    EXPECT_EQ(post.result_int(), 405u);
    EXPECT_EQ(post["Allow"], "GET, HEAD");
}

TEST_F(HttpServer, SaysWhatIsWrongWithWhatComesAfterAHead) {
    start();
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(std::string("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n"
                                                 "what is this?\r\n\r\n")));
    std::string received;
    beast::error_code error;
    asio::read(socket, asio::dynamic_buffer(received), error);
    EXPECT_THAT(received, HasSubstr("HTTP/1.1 400"));
    EXPECT_THAT(received, HasSubstr("this is not HTTP/1.1"));
}

TEST_F(HttpServer, KeepsAConnectionForManyRequests) {
    start();
    tcp::socket socket = connect();
    for (int i = 0; i < 5; ++i) {
        asio::write(socket, asio::buffer(std::string("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")));
        EXPECT_EQ(readResponse(socket).result_int(), 200u);
    }
}

TEST_F(HttpServer, RefusesWhatIsTooLargeOrNoHttp) {
    start();
    EXPECT_EQ(
        exchange("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n").result_int(),
        431u);
    EXPECT_EQ(exchange("POST / HTTP/1.1\r\nContent-Length: 2000000\r\n\r\n").result_int(), 413u);
    EXPECT_EQ(exchange("\x16\x03\x01 hello\r\n\r\n").result_int(), 400u);
    EXPECT_EQ(get("/ws").result_int(), 426u);
    EXPECT_EQ(get("/healthz").result_int(), 200u);
}

TEST_F(HttpServer, AsksForOneHost) {
    start();
    const std::string host = "Host: " + hostAndPort() + "\r\n";
    EXPECT_EQ(exchange("GET /healthz HTTP/1.1\r\n" + host + "\r\n").result_int(), 200u);
    EXPECT_EQ(exchange("GET /healthz HTTP/1.1\r\n\r\n").result_int(), 400u);
    EXPECT_EQ(exchange("GET /healthz HTTP/1.1\r\n" + host + host + "\r\n").result_int(), 400u);
    EXPECT_EQ(exchange("GET /healthz HTTP/1.0\r\n\r\n").result_int(), 200u);
}

TEST_F(HttpServer, CutsOffAPeerThatNeverFinishesItsRequest) {
    ServerOptions options;
    options.headerTimeout = milliseconds(1000);
    start(options);
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(std::string("GET / HT")));
    std::string answer;
    beast::error_code error;
    asio::read(socket, asio::dynamic_buffer(answer), error);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 408")) << answer;
    EXPECT_TRUE(error == asio::error::eof || error == asio::error::connection_reset)
        << error.message();
}

/// More than the systems at both ends hold.
constexpr std::size_t kLongAnswer = 16 << 20;

TEST_F(HttpServer, LongAnswersTakeAsLongAsTheirReadersNeed) {
    web_.write("web/long.bin", std::string(kLongAnswer, 'x'));
    ServerOptions options;
    options.headerTimeout = options.writeTimeout = milliseconds(2000);
    start(options);
    tcp::socket socket = connect(
        "GET /long.bin HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", 64 * 1024);
    std::string piece(512 * 1024, '\0');
    std::size_t bytes = 0;
    beast::error_code end;
    while (!end) {
        bytes += asio::read(socket, asio::buffer(piece), end);
        std::this_thread::sleep_for(milliseconds(150));  // 32 times
    }
    EXPECT_EQ(end, asio::error::eof) << end.message();
    EXPECT_GT(bytes, kLongAnswer);
}

TEST_F(HttpServer, CutsOffAndCountsAPeerThatTakesNoAnswer) {
    web_.write("web/long.bin", std::string(kLongAnswer, 'x'));
    ServerOptions options;
    options.writeTimeout = milliseconds(500);
    start(options);
    tcp::socket socket = connect("GET /long.bin HTTP/1.1\r\nHost: localhost\r\n\r\n", 64 * 1024);
    EXPECT_TRUE(eventually([&] {
        return get("/metrics")
                   .body()
                   .find("eyrie_requests_refused_total{reason=\"too_slow\"} 1\n") !=
               std::string::npos;
    }));
    std::string taken;
    beast::error_code end;
    asio::read(socket, asio::dynamic_buffer(taken), end);
    EXPECT_LT(taken.size(), kLongAnswer);
}

TEST(WritePace, EndsWithSilenceAndWithATrickleAndNotWithLength) {
    const WritePace::Clock::time_point begin{std::chrono::hours(1)};
    const auto after = [&](int seconds) { return begin + std::chrono::seconds(seconds); };
    WritePace pace(begin, std::chrono::seconds(10));
    EXPECT_EQ(pace.deadline(begin), after(10));
    pace.took(100 * WritePace::kSlowestBytesPerSecond);
    EXPECT_EQ(pace.deadline(after(90)), after(100)) << "as long from now as ever";
    EXPECT_EQ(pace.deadline(after(105)), after(110)) << "behind what the slowest have";
    pace.took(1);
    EXPECT_EQ(pace.deadline(after(115)), after(110)) << "for all that a byte comes now and then";
}

TEST_F(HttpServer, AnswersConnectionsAboveTheLimitWith503AndRecovers) {
    ServerOptions options;
    options.limits.connections = 2;
    start(options);
    {
        const auto first = openSocket();
        const auto second = openSocket();
        read(*first);  // the places belong to viewers now
        read(*second);
        tcp::socket third = connect();
        EXPECT_EQ(readResponse(third).result_int(), 503u);
    }
    EXPECT_TRUE(eventually([this] {
        tcp::socket again = connect();
        beast::error_code ignored;
        asio::write(again, asio::buffer(std::string("GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")),
                    ignored);
        beast::flat_buffer buffer;
        Response response;
        beast::http::read(again, buffer, response, ignored);
        return response.result_int() == 200u && !ignored;
    }));
}

TEST_F(HttpServer, SaysThatThePortIsInUse) {
    start();
    ServerOptions options;
    options.port = port();
    const auto second = Server::start(options, frames_);
    EXPECT_EQ(second.status().message(),
              fmt::format("cannot listen on 127.0.0.1:{}: another program does already", port()));
    EXPECT_TRUE(absl::IsUnavailable(second.status()));
}

TEST_F(HttpServer, RefusesAHostThatIsNoAddressOfThisMachine) {
    for (const char* host : {"no.such.host.invalid", "203.0.113.7", ""}) {
        ServerOptions options;
        options.host = host;
        options.port = 0;
        const auto server = Server::start(options, frames_);
        EXPECT_TRUE(absl::IsInvalidArgument(server.status())) << host;
        EXPECT_THAT(std::string(server.status().message()), HasSubstr("--listen HOST:PORT"));
    }
}
TEST_F(HttpServer, TellsPrometheusOfViewersBytesAndRefusals) {
    start();
    const auto socket = openSocket();
    socket->write(asio::buffer(viewBytes(1)));
    ASSERT_EQ(readFrame(*socket).view_sequence(), 1u);
    EXPECT_EQ(get("/nothing").result_int(), 404u);
    const Response response = get("/metrics");
    EXPECT_EQ(response.result_int(), 200u);
    EXPECT_EQ(response[beast::http::field::content_type],
              "text/plain; version=0.0.4; charset=utf-8");
    EXPECT_THAT(response.body(), HasSubstr("\neyrie_viewers 1\n"));
    EXPECT_THAT(response.body(), HasSubstr("\neyrie_renderers{condition=\"ready\"} 1\n"));
    EXPECT_THAT(response.body(),
                HasSubstr("\neyrie_requests_refused_total{reason=\"not_found\"} 1\n"));
    EXPECT_THAT(response.body(),
                Not(HasSubstr("\neyrie_received_bytes_total{peer=\"websocket\"} 0\n")));
    EXPECT_THAT(response.body(),
                Not(HasSubstr("\neyrie_sent_bytes_total{peer=\"websocket\"} 0\n")));
    EXPECT_THAT(response.body(),
                Not(HasSubstr("eyrie_frame_stage_seconds_count{stage=\"encode\"} 0\n")));
}

}  // namespace
}  // namespace eyrie::http
