// SPDX-License-Identifier: Apache-2.0
// Viewers on WebSockets: their frames, their pace, and how they end.
#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "coordinator/stream/session.h"
#include "coordinator/stream/session_book.h"
#include "tests/coordinator/http_server_fixture.h"
#include "tests/service/eventually.h"

namespace eyrie::http {
namespace {

using std::chrono::milliseconds;

using ViewerConnection = HttpServer;

TEST_F(ViewerConnection, StreamsFramesToAViewer) {
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

TEST_F(ViewerConnection, RefusesPagesOfOtherSites) {
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

TEST_F(ViewerConnection, TellsAPageThatAProxyMadeAStrangerWhatToDo) {
    start();
    const auto ask = [this](const std::string& origin) {
        return exchange(fmt::format("GET /ws HTTP/1.1\r\nHost: {}\r\nEyrie-Page-Origin: {}\r\n\r\n",
                                    hostAndPort(), origin));
    };
    const Response refused = ask("https://eyrie.example");
    EXPECT_EQ(refused.result_int(), 403u);
    EXPECT_EQ(refused["Content-Type"], "application/problem+json");
    EXPECT_EQ(refused["Retry-After"], "5");
    EXPECT_THAT(refused.body(),
                testing::HasSubstr("\"detail\":\"pages of https://eyrie.example may not connect to "
                                   "this server, which was asked as " +
                                   hostAndPort() + "; a proxy in between has to pass"));
    const Response own = ask("http://" + hostAndPort());
    EXPECT_EQ(own.result_int(), 426u);
    EXPECT_THAT(own.body(), testing::HasSubstr("pass on the headers Upgrade and Connection"));
}

TEST_F(ViewerConnection, ClosesOnMessagesOutsideTheProtocol) {
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

TEST_F(ViewerConnection, AViewerThatNeverReadsNeitherBlocksOthersNorPilesUpFrames) {
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

TEST_F(ViewerConnection, AViewerThatNeverAcknowledgesGetsNoMoreThanAFewFrames) {
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

TEST_F(ViewerConnection, CutsOffAViewerThatAcknowledgesNothing) {
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

TEST_F(ViewerConnection, KeepsAViewerThatHasNothingToAcknowledge) {
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

TEST_F(ViewerConnection, AViewerHearsThatTheServerIsThereThoughNothingChanges) {
    ServerOptions options;
    options.lifeSign = milliseconds(20);
    start(options);
    const auto idle = openSocket();
    read(*idle);  // the state
    for (int i = 0; i < 3; ++i) {
        beast::flat_buffer buffer;
        beast::error_code error;
        idle->read(buffer, error);
        ASSERT_FALSE(error) << error.message();
        EXPECT_EQ(buffer.size(), 0u);
    }
    idle->write(asio::buffer(viewBytes(1)));
    EXPECT_EQ(readFrame(*idle).view_sequence(), 1u);
}

TEST_F(ViewerConnection, GivesEachViewerItsOwnViewAndPace) {
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

TEST_F(ViewerConnection, SurvivesViewersThatVanish) {
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

TEST_F(ViewerConnection, SendsViewersAwayWhoseSessionAProgramCloses) {
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

TEST_F(ViewerConnection, TellsViewersThatItShutsDown) {
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

/// What viewers have asked for may take long; the answer to a goodbye may not.
TEST_F(ViewerConnection, AViewerThatDoesNotAnswerTheGoodbyeIsNotWaitedFor) {
    ServerOptions options;
    options.drainTimeout = std::chrono::minutes(10);
    start(options);
    const auto silent = openSocket();
    read(*silent);
    const std::future<void> stopped = std::async(std::launch::async, [this] { server_->stop(); });
    EXPECT_EQ(stopped.wait_for(std::chrono::minutes(1)), std::future_status::ready);
    for (beast::error_code error; !error;) {  // of an answer that comes too late
        beast::flat_buffer buffer;
        silent->read(buffer, error);
    }
    EXPECT_EQ(silent->reason().code, websocket::close_code::going_away) << "it was told";
}

TEST_F(ViewerConnection, SendsWhatWasAskedForBeforeItStopsAndTakesNoNewViews) {
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

TEST_F(ViewerConnection, StopsAlthoughViewersDoNotListen) {
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

}  // namespace
}  // namespace eyrie::http
