// SPDX-License-Identifier: Apache-2.0
// Calls that are stopped, cut off or never read to their end.
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "render_server_fixture.h"
#include "service/render_service.h"
#include "tests/service/eventually.h"
#include "wire/frame.h"
#include "wire/listen.h"

namespace eyrie::service {
namespace {

using coordinator::ChannelRenderer;
class RenderGivenUpTest : public RenderServerTest {
protected:
    using Deadline = ChannelRenderer::Clock::time_point;

    /// `call` waits behind a picture until it is given up; the next picture is drawn.
    void giveUpBeforeItsTurn(const std::function<absl::Status(ChannelRenderer&, Deadline)>& call) {
        ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
        control_->hold();
        std::jthread first([&] { EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok()); });
        ASSERT_TRUE(eventually([&] { return control_->begun == 1; }));
        const auto second = coordinator::connectRenderer(server_->address());
        const auto shortly = ChannelRenderer::Clock::now() + std::chrono::milliseconds(50);
        EXPECT_EQ(call(*second, shortly).code(), absl::StatusCode::kDeadlineExceeded);
        // Its cancellation is ahead of these on the same connection.
        for (int i = 0; i < 200; ++i) ASSERT_TRUE(second->setFrameData(frameData(), soon()).ok());
        control_->release();
        first.join();
        ASSERT_TRUE(renderer_->render(task(8, 8, false), soon()).ok());
    }
};

/// Calls for a picture, of which nothing is read.
struct IdleReaders {
    std::unique_ptr<v1::RenderService::Stub> stub;
    std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
    std::vector<std::unique_ptr<grpc::ClientReader<v1::RenderChannelResponse>>> readers;

    IdleReaders(const std::string& address, const fabric::ChannelTask& task, int count)
        : stub(v1::RenderService::NewStub(grpc::CreateCustomChannel(
              address, grpc::InsecureChannelCredentials(), arguments()))) {
        v1::RenderChannelRequest request;
        *request.mutable_task() = wire::toMessage(task);
        for (int i = 0; i < count; ++i) {
            contexts.push_back(std::make_unique<grpc::ClientContext>());
            readers.push_back(stub->RenderChannel(contexts.back().get(), request));
            readers.back()->WaitForInitialMetadata();
        }
    }

    /// The least that a client takes before it is read. By itself it takes more and more, by what
    /// it finds that the connection carries: a whole picture in the end.
    static grpc::ChannelArguments arguments() {
        grpc::ChannelArguments arguments = wire::clientArguments();
        arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
        arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 65'535);
        return arguments;
    }

    /// Reads all to their ends. What those came to.
    std::vector<grpc::StatusCode> ends() const {
        std::vector<grpc::StatusCode> codes;
        for (const auto& reader : readers) {
            v1::RenderChannelResponse message;
            while (reader->Read(&message)) {
            }
            codes.push_back(reader->Finish().error_code());
        }
        return codes;
    }
};

TEST_F(RenderGivenUpTest, ACallGivenUpBeforeItsTurnIsNotDrawn) {
    giveUpBeforeItsTurn([](ChannelRenderer& renderer, Deadline deadline) {
        return renderer.render(task(8, 8, false), deadline).status();
    });
    EXPECT_EQ(control_->drawn, 2);
}

TEST_F(RenderGivenUpTest, AReaderThatGoesAwayMidPictureHoldsNothingUp) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    for (int i = 0; i < 3 * ReplySlots::kMaxOpen; ++i) {
        v1::RenderChannelRequest request;
        *request.mutable_task() = wire::toMessage(task(2000, 1300, true));
        grpc::ClientContext context;
        const auto reader = stub_->RenderChannel(&context, request);
        v1::RenderChannelResponse header;
        ASSERT_TRUE(reader->Read(&header)) << i;
        context.TryCancel();
        EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
    }
    EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok());
}

TEST_F(RenderGivenUpTest, ReadersThatNeverReadAreBounded) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const IdleReaders idle(server_->address(), task(2000, 1300, true), ReplySlots::kMaxOpen);
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kResourceExhausted);
    for (const auto& context : idle.contexts) context->TryCancel();
    EXPECT_TRUE(eventually([&] { return renderer_->render(task(8, 8, false), soon()).ok(); }));
}

TEST_F(RenderGivenUpTest, ReadersThatNeverReadAreGivenUpAfterAWhile) {
    RenderService service(*thread_, {}, std::chrono::milliseconds(300));
    const wire::Listening impatient = wire::listen({"unix:" + folder_.path("i")}, service).value();
    const auto renderer = coordinator::connectRenderer(impatient.addresses.front());
    ASSERT_TRUE(renderer->setFrameData(frameData(), soon()).ok());
    const IdleReaders idle(impatient.addresses.front(), task(2000, 1300, true),
                           ReplySlots::kMaxOpen + 1);
    EXPECT_TRUE(eventually([&] { return renderer->render(task(8, 8, false), soon()).ok(); }));
    // One at least, whichever came first: those read from now on are in time.
    EXPECT_THAT(idle.ends(), testing::Contains(grpc::StatusCode::CANCELLED));
    impatient.server->Shutdown();
}

TEST_F(RenderGivenUpTest, ASceneGivenUpBeforeItsTurnIsNotOpened) {
    giveUpBeforeItsTurn([](ChannelRenderer& renderer, Deadline deadline) {
        return renderer.openScene({}, deadline).status();
    });
    EXPECT_EQ(control_->opened, 0);
}

TEST_F(RenderGivenUpTest, CancelEndsTheCallInProgressAndEveryLaterOne) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::jthread canceller([&] {
        EXPECT_TRUE(eventually([&] { return control_->begun == 1; }));
        renderer_->cancel();
    });
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kCancelled);
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kCancelled);
    control_->release();
}

TEST_F(RenderGivenUpTest, AStoppedChannelIsGivenUpByTheDrawerAndTheNextIsWhole) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::stop_source stop;
    std::jthread stopper([&] {
        EXPECT_TRUE(eventually([&] { return control_->begun == 1; }));
        stop.request_stop();
    });
    EXPECT_TRUE(absl::IsCancelled(
        renderer_->render(task(8, 8, true), soon(), {}, nullptr, stop.get_token()).status()));
    EXPECT_TRUE(eventually([&] { return control_->givenUp == 1; }));
    control_->release();
    const auto next = renderer_->render(task(8, 8, true), soon());
    ASSERT_TRUE(next.ok()) << next.status();
    EXPECT_TRUE(arrivedIn(*next) == FakeDrawer::picture(frameData(), task(8, 8, true)).image);
    EXPECT_EQ(control_->begun, 2);
    EXPECT_EQ(control_->drawn, 1);
}

/// The caller is told at once, the renderer a moment later, which nobody can see: until that has
/// been long enough, it is tried again.
TEST_F(RenderGivenUpTest, AStoppedChannelThatWaitsIsNotBegun) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto other = coordinator::connectRenderer(server_->address());
    const auto begunIfStopped = [&](std::chrono::milliseconds pause) {
        control_->begun = 0;
        control_->hold();
        std::jthread drawing(
            [&] { EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok()); });
        EXPECT_TRUE(eventually([&] { return control_->begun == 1; }));
        std::stop_source stop;
        std::jthread stopper([&] {
            std::this_thread::sleep_for(pause);  // it waits behind the other
            stop.request_stop();
        });
        EXPECT_TRUE(absl::IsCancelled(
            other->render(task(8, 8, false), soon(), {}, nullptr, stop.get_token()).status()));
        std::this_thread::sleep_for(pause);
        control_->release();
        drawing.join();
        EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok());
        return control_->begun.load();
    };
    std::chrono::milliseconds pause(20);
    while (begunIfStopped(pause) != 2) {
        pause *= 2;
        ASSERT_LT(pause, std::chrono::seconds(5));
    }
}

TEST_F(RenderGivenUpTest, StopEndsTheCallInProgress) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::jthread stopper([&] {
        EXPECT_TRUE(eventually([&] { return control_->begun == 1; }));
        server_->stop(std::chrono::milliseconds(0));
    });
    // It ends for the caller, and the drawer gives it up: stop does not wait for its end.
    EXPECT_FALSE(renderer_->render(task(8, 8, false), soon()).ok());
    stopper.join();
    EXPECT_EQ(control_->drawn, 0);
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kUnavailable);
}
}  // namespace
}  // namespace eyrie::service
