// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "coordinator/http/origin.h"
#include "coordinator/http/server.h"
#include "coordinator/stream/session.h"
#include "coordinator/stream/session_book.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"

namespace eyrie::http {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace fs = std::filesystem;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using coordinator::FakeFrameSource;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Not;
using Response = beast::http::response<beast::http::string_body>;

/// A built UI with a secret beside it.
class WebFolder {
public:
    WebFolder() : root_(fs::temp_directory_path() / fmt::format("eyrie-web-{}", ::getpid())) {
        write("web/index.html", "<!doctype html><title>page</title>");
        write("web/assets/main-1234.js", "export {};");
        write("web/icon.svg", "<svg/>");
        write("secret.txt", "SECRET");
        fs::create_symlink(root_ / "secret.txt", root_ / "web" / "link.txt");
    }
    ~WebFolder() { fs::remove_all(root_); }

    fs::path path() const { return root_ / "web"; }

private:
    void write(const fs::path& name, std::string_view text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }

    fs::path root_;
};

/// Whether `isTrue` becomes true within ten seconds.
template <typename Condition>
bool eventually(Condition isTrue) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!isTrue()) {
        if (std::chrono::steady_clock::now() >= deadline)
            return false;
        std::this_thread::sleep_for(milliseconds(5));
    }
    return true;
}

class HttpServer : public testing::Test {
protected:
    void start(ServerOptions options = {}) {
        options.port = 0;
        options.webFolder = web_.path();
        auto server = Server::start(options, frames_);
        ASSERT_TRUE(server.ok()) << server.status();
        server_ = *std::move(server);
    }

    std::string hostAndPort() const {
        std::string url = server_->url();
        return url.substr(7, url.size() - 8);
    }
    std::uint16_t port() const {
        return static_cast<std::uint16_t>(
            std::stoi(hostAndPort().substr(hostAndPort().rfind(':') + 1)));
    }

    tcp::socket connect() {
        tcp::socket socket(io_);
        socket.connect({asio::ip::make_address("127.0.0.1"), port()});
        return socket;
    }

    /// Sends `bytes` and reads until the server closes or a whole response has come.
    Response exchange(const std::string& bytes) {
        tcp::socket socket = connect();
        asio::write(socket, asio::buffer(bytes));
        return readResponse(socket);
    }

    static Response readResponse(tcp::socket& socket) {
        beast::flat_buffer buffer;
        Response response;
        beast::error_code error;
        beast::http::read(socket, buffer, response, error);
        EXPECT_FALSE(error) << error.message();
        return response;
    }

    Response get(const std::string& target) {
        return exchange(fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n\r\n", target, hostAndPort()));
    }

    using Socket = websocket::stream<beast::tcp_stream>;

    std::unique_ptr<Socket> openSocket(const std::string& origin = "") {
        auto socket = std::make_unique<Socket>(beast::tcp_stream(connect()));
        socket->set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
            if (!origin.empty())
                request.set(beast::http::field::origin, origin);
        }));
        beast::error_code error;
        socket->handshake(hostAndPort(), "/ws", error);
        EXPECT_FALSE(error) << error.message();
        socket->binary(true);
        return socket;
    }

    static v1::ViewerResponse read(Socket& socket) {
        beast::flat_buffer buffer;
        beast::error_code error;
        socket.read(buffer, error);
        EXPECT_FALSE(error) << error.message();
        v1::ViewerResponse response;
        EXPECT_TRUE(response.ParseFromArray(buffer.data().data(), static_cast<int>(buffer.size())));
        return response;
    }

    static v1::Frame readFrame(Socket& socket) {
        for (;;) {
            v1::ViewerResponse response = read(socket);
            if (response.has_frame())
                return response.frame();
            if (!response.has_state())
                return {};
        }
    }

    static std::string viewBytes(std::uint64_t sequence, int width = 64, int height = 48) {
        v1::ViewerRequest request;
        v1::ViewRequest& view = *request.mutable_view();
        view.set_sequence(sequence);
        view.set_width(width);
        view.set_height(height);
        view.set_tau_pixels(1);
        for (const double value : {static_cast<double>(sequence), -10.0, 3.0})
            view.mutable_camera()->add_eye(value);
        for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
        return request.SerializeAsString();
    }

    static std::string ackBytes(std::uint64_t frameNumber) {
        v1::ViewerRequest request;
        request.mutable_frame_ack()->set_frame_number(frameNumber);
        return request.SerializeAsString();
    }

    /// The code with which the server closes the connection.
    static int closeCode(Socket& socket) {
        beast::error_code error;
        while (!error) {
            beast::flat_buffer buffer;
            socket.read(buffer, error);
        }
        EXPECT_EQ(error, websocket::error::closed);
        return socket.reason().code;
    }

    WebFolder web_;
    FakeFrameSource frames_;
    asio::io_context io_;
    std::unique_ptr<Server> server_;
};

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
    const std::string attempts[] = {"/../secret.txt",
                                    "/assets/../../secret.txt",
                                    "/./../secret.txt",
                                    "//secret.txt",
                                    "/..%2fsecret.txt",
                                    "/%2e%2e/secret.txt",
                                    "/%2e%2e%2fsecret.txt",
                                    "/..%5csecret.txt",
                                    "/..\\secret.txt",
                                    "/assets/%00/../../secret.txt",
                                    "/....//secret.txt",
                                    "/..;/secret.txt",
                                    "/%252e%252e/secret.txt",
                                    "/%c0%ae%c0%ae/secret.txt",
                                    "/link.txt",
                                    "/assets",
                                    "/assets/",
                                    "//etc/passwd",
                                    "/etc/passwd",
                                    "/proc/self/environ",
                                    "http://127.0.0.1/../secret.txt",
                                    "file:///etc/passwd",
                                    "*"};
    for (const std::string& target : attempts) {
        const Response response = get(target);
        EXPECT_EQ(response.result_int(), 404u) << target;
        EXPECT_THAT(response.body(), Not(HasSubstr("SECRET"))) << target;
        EXPECT_THAT(response.body(), Not(HasSubstr("root:"))) << target;
    }
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
    EXPECT_EQ(ready.body(),
              R"({"ready":true,"problem":"","renderers":[{"id":"renderer-1","address":"",)"
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
    asio::write(
        socket,
        asio::buffer(std::string("HEAD / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")));
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

TEST_F(HttpServer, CutsOffAPeerThatNeverFinishesItsRequest) {
    ServerOptions options;
    options.headerTimeout = milliseconds(50);
    start(options);
    tcp::socket socket = connect();
    asio::write(socket, asio::buffer(std::string("GET / HT")));
    char byte = 0;
    beast::error_code error;
    asio::read(socket, asio::buffer(&byte, 1), error);
    EXPECT_TRUE(error == asio::error::eof || error == asio::error::connection_reset)
        << error.message();
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

TEST_F(HttpServer, StreamsFramesToAViewer) {
    start();
    const auto socket = openSocket("http://" + hostAndPort());
    EXPECT_EQ(read(*socket).state().scene_triangles(), 1'000'000u);
    for (std::uint64_t sequence = 1; sequence <= 20; ++sequence) {
        socket->write(asio::buffer(viewBytes(sequence)));
        v1::Frame frame = readFrame(*socket);
        while (frame.view_sequence() < sequence) frame = readFrame(*socket);
        EXPECT_GT(frame.jpeg().size(), 100u);
        socket->write(asio::buffer(ackBytes(frame.frame_number())));
    }
}

TEST_F(HttpServer, RefusesPagesOfOtherSites) {
    start();
    for (const std::string& origin : {std::string("http://evil.example"), std::string("null"),
                                      fmt::format("http://{}.evil.example", hostAndPort()),
                                      std::string("http://127.0.0.1:1")}) {
        const Response response = exchange(
            fmt::format("GET /ws HTTP/1.1\r\nHost: {}\r\nOrigin: {}\r\nConnection: Upgrade\r\n"
                        "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
                        hostAndPort(), origin));
        EXPECT_EQ(response.result_int(), 403u) << origin;
    }
}

TEST_F(HttpServer, ClosesOnMessagesOutsideTheProtocol) {
    start();
    const auto garbage = openSocket();
    garbage->write(asio::buffer(std::string("\xff\xfe\xfd garbage")));
    EXPECT_EQ(closeCode(*garbage), websocket::close_code::bad_payload);

    const auto text = openSocket();
    text->text(true);
    text->write(asio::buffer(std::string("hello")));
    EXPECT_EQ(closeCode(*text), websocket::close_code::unknown_data);

    const auto oversize = openSocket();
    oversize->write(asio::buffer(std::string(65 * 1024, 'x')));
    EXPECT_EQ(closeCode(*oversize), websocket::close_code::too_big);

    const auto fine = openSocket();
    fine->write(asio::buffer(viewBytes(1)));
    EXPECT_EQ(readFrame(*fine).view_sequence(), 1u);
}

TEST_F(HttpServer, AViewerThatNeverReadsNeitherBlocksOthersNorPilesUpFrames) {
    ServerOptions options;
    options.writeTimeout = milliseconds(1500);  // which who reads keeps, however busy the machine
    start(options);
    frames_.setDraw([](const coordinator::FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {});
        for (std::size_t i = 0; i < frame.image.colour.size(); ++i)  // noise hardly compresses
            frame.image.colour[i].r = static_cast<std::uint8_t>(i * 2654435761u >> 13);
        return frame;
    });
    const auto other = openSocket();
    const auto deaf = openSocket();
    std::uint64_t sequence = 0;
    EXPECT_TRUE(eventually([&] {
        ++sequence;
        beast::error_code ignored;
        deaf->write(asio::buffer(viewBytes(sequence, 1024, 1024)), ignored);
        const std::vector<coordinator::FrameRequest> drawn = frames_.requests();
        const auto forDeaf = std::count_if(
            drawn.begin(), drawn.end(), [](const auto& request) { return request.width == 1024; });
        if (forDeaf > 1)  // a liar, too: acknowledges what it has not read
            deaf->write(asio::buffer(ackBytes(static_cast<std::uint64_t>(forDeaf - 1))), ignored);
        other->write(asio::buffer(viewBytes(sequence)));
        v1::Frame frame = readFrame(*other);
        while (frame.view_sequence() < sequence) frame = readFrame(*other);
        other->write(asio::buffer(ackBytes(frame.frame_number())));
        return frames_.listenerCount() == 1;
    })) << "the viewer that does not read was not cut off";
}

TEST_F(HttpServer, AViewerThatNeverAcknowledgesGetsNoMoreThanAFewFrames) {
    start();
    const auto socket = openSocket();
    std::uint64_t sequence = 0;
    EXPECT_TRUE(eventually([&] {
        socket->write(asio::buffer(viewBytes(++sequence)));
        return frames_.requests().size() >= 2;
    }));
    for (int i = 0; i < 50; ++i) socket->write(asio::buffer(viewBytes(++sequence)));
    const auto other = openSocket();
    other->write(asio::buffer(viewBytes(1)));
    EXPECT_EQ(readFrame(*other).view_sequence(), 1u);
    EXPECT_LE(frames_.requests().size(), 4u);
}

TEST_F(HttpServer, CutsOffAViewerThatAcknowledgesNothing) {
    ServerOptions options;
    options.writeTimeout = milliseconds(200);
    start(options);
    const auto mute = openSocket();  // reads, and says nothing
    mute->write(asio::buffer(viewBytes(1)));
    for (beast::error_code error; !error;) {
        beast::flat_buffer buffer;
        mute->read(buffer, error);
    }
    EXPECT_TRUE(eventually([&] { return frames_.listenerCount() == 0; }));

    const auto deaf = openSocket();  // small frames, which the system's buffers take
    deaf->write(asio::buffer(viewBytes(1)));
    EXPECT_TRUE(eventually([&] { return frames_.requests().size() >= 2; }));
    EXPECT_TRUE(eventually([&] { return frames_.listenerCount() == 0; }));
}

TEST_F(HttpServer, KeepsAViewerThatHasNothingToAcknowledge) {
    ServerOptions options;
    options.writeTimeout = milliseconds(1000);  // for its acknowledgements, on a busy machine
    start(options);
    const auto idle = openSocket();
    idle->write(asio::buffer(viewBytes(1)));
    for (bool isExact = false; !isExact;) {
        const v1::Frame frame = readFrame(*idle);
        isExact = frame.has_png();
        idle->write(asio::buffer(ackBytes(frame.frame_number())));
    }
    std::this_thread::sleep_for(1.5 * options.writeTimeout);
    idle->write(asio::buffer(viewBytes(2)));
    EXPECT_EQ(readFrame(*idle).view_sequence(), 2u);
}

TEST_F(HttpServer, GivesEachViewerItsOwnViewAndPace) {
    start();
    const auto slow = openSocket();
    const auto fast = openSocket();
    slow->write(asio::buffer(viewBytes(1, 32, 32)));
    EXPECT_EQ(readFrame(*slow).width(), 32);  // and does not acknowledge it
    for (std::uint64_t sequence = 1; sequence <= 30; ++sequence) {
        slow->write(asio::buffer(viewBytes(sequence + 1, 32, 32)));
        fast->write(asio::buffer(viewBytes(sequence)));
        v1::Frame frame = readFrame(*fast);
        while (frame.view_sequence() < sequence) frame = readFrame(*fast);
        EXPECT_EQ(frame.width(), 64);
        fast->write(asio::buffer(ackBytes(frame.frame_number())));
    }
    const std::vector<coordinator::FrameRequest> drawn = frames_.requests();
    EXPECT_LE(std::count_if(drawn.begin(), drawn.end(),
                            [](const auto& request) { return request.width == 32; }),
              4);
}

TEST_F(HttpServer, SurvivesViewersThatVanish) {
    ServerOptions options;
    // They go as fast as this machine lets them.
    options.limits.viewersPerAddress = options.limits.sessionsPerAddress = 0;
    options.limits.viewers = options.limits.sessions = 128;
    start(options);
    for (int i = 0; i < 100; ++i) {
        const auto socket = openSocket();
        socket->write(asio::buffer(viewBytes(1)));
        beast::error_code ignored;
        beast::get_lowest_layer(*socket).socket().close(ignored);
    }
    EXPECT_EQ(get("/healthz").result_int(), 200u);
    server_->stop();
    EXPECT_EQ(frames_.listenerCount(), 0u);
}

TEST_F(HttpServer, SendsViewersAwayWhoseSessionAProgramCloses) {
    ServerOptions options;
    options.sessions = std::make_shared<stream::SessionBook>();
    start(options);
    const auto socket = openSocket();
    const auto other = openSocket();
    socket->write(asio::buffer(viewBytes(1)));
    readFrame(*socket);
    read(*other);
    const auto sessions = options.sessions->all();
    ASSERT_EQ(sessions.size(), 2u);
    sessions.front()->close();
    EXPECT_EQ(closeCode(*socket), 4001);
    other->write(asio::buffer(viewBytes(1)));
    EXPECT_EQ(readFrame(*other).view_sequence(), 1u) << "the other session goes on";
}

TEST_F(HttpServer, TellsViewersThatItShutsDown) {
    start();
    const auto socket = openSocket();
    read(*socket);
    std::thread stopping([this] { server_->stop(); });
    EXPECT_EQ(closeCode(*socket), websocket::close_code::going_away);
    stopping.join();
    server_->stop();
    beast::error_code error;
    tcp::socket late(io_);
    late.connect({asio::ip::make_address("127.0.0.1"), port()}, error);
    EXPECT_EQ(error, asio::error::connection_refused);
}

TEST_F(HttpServer, SendsWhatWasAskedForBeforeItStopsAndTakesNoNewViews) {
    ServerOptions options;
    options.drainTimeout = std::chrono::seconds(20);
    start(options);
    const auto socket = openSocket();
    frames_.hold(true);
    socket->write(asio::buffer(viewBytes(1)));
    ASSERT_TRUE(frames_.waitForRequests(1));
    std::thread stopping([this] { server_->stop(); });
    EXPECT_TRUE(eventually([this] {
        beast::error_code error;
        tcp::socket late(io_);
        late.connect({asio::ip::make_address("127.0.0.1"), port()}, error);
        return error == asio::error::connection_refused;
    }));
    socket->write(asio::buffer(viewBytes(2)));
    frames_.hold(false);
    EXPECT_EQ(readFrame(*socket).view_sequence(), 1u);
    EXPECT_EQ(closeCode(*socket), websocket::close_code::going_away);
    stopping.join();
    EXPECT_EQ(frames_.requests().size(), 1u);
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

TEST_F(HttpServer, GivesTracesOfAsManyFramesAsAskedFor) {
    ServerOptions options;
    options.telemetry = std::make_shared<observe::Telemetry>();
    const auto now = observe::Clock::now();
    for (std::uint64_t frame = 1; frame <= 20; ++frame)
        options.telemetry->traces.add({"coordinator", "frames", "frame", frame,
                                       now + milliseconds(frame), now + milliseconds(frame + 1)});
    start(options);
    const auto count = [](const std::string& text) {
        std::size_t spans = 0;
        for (auto at = text.find("\"ph\":\"X\""); at != std::string::npos;
             at = text.find("\"ph\":\"X\"", at + 1))
            ++spans;
        return spans;
    };
    EXPECT_EQ(get("/api/v1/trace")[beast::http::field::content_type], "application/json");
    EXPECT_EQ(count(get("/api/v1/trace").body()), 10u);
    EXPECT_EQ(count(get("/api/v1/trace?frames=3").body()), 3u);
    EXPECT_EQ(count(get("/api/v1/trace?frames=1000").body()), 20u);
    for (const char* wrong : {"0", "-1", "1001", "x", "", "3x", "99999999999999999999"})
        EXPECT_EQ(get(std::string("/api/v1/trace?frames=") + wrong).result_int(), 400u) << wrong;
    EXPECT_EQ(get("/api/v1/trace?frame=3").result_int(), 400u);
}

TEST_F(HttpServer, StopsAlthoughViewersDoNotListen) {
    start();
    const auto deaf = openSocket();
    frames_.hold(true);
    deaf->write(asio::buffer(viewBytes(1)));
    ASSERT_TRUE(frames_.waitForRequests(1));
    std::thread stopping([this] { server_->stop(); });
    frames_.hold(false);
    stopping.join();
    EXPECT_EQ(frames_.listenerCount(), 0u);
}

TEST(Origin, MustBeTheVeryHostAndOnLoopbackNoStrangersName) {
    EXPECT_TRUE(isAllowedOrigin("", "127.0.0.1:8080", true));
    EXPECT_TRUE(isAllowedOrigin("http://localhost:8080", "LOCALHOST:8080", true));
    EXPECT_TRUE(isAllowedOrigin("http://[::1]:8080", "[::1]:8080", true));
    EXPECT_TRUE(isAllowedOrigin("https://eyrie.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://evil.example:8080", "evil.example:8080", true));
    EXPECT_FALSE(isAllowedOrigin("", "evil.example:8080", true));
    EXPECT_FALSE(isAllowedOrigin("http://evil.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://", "", false));
    EXPECT_FALSE(isAllowedOrigin("ftp://eyrie.example", "eyrie.example", false));
    EXPECT_FALSE(isAllowedOrigin("http://127.0.0.1", "[", true));
}

}  // namespace
}  // namespace eyrie::http
