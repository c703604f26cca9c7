// SPDX-License-Identifier: Apache-2.0
#include "service/render_server.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>

#include "coordinator/farm/grpc_renderer.h"
#include "eyrie/v1/render_service.grpc.pb.h"
#include "fake_drawer.h"
#include "service/render_service.h"
#include "tests/service/eventually.h"
#include "tests/support/temporary_folder.h"
#include "wire/frame.h"
#include "wire/jpeg.h"
#include "wire/listen.h"
#include "wire/picture_header.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

using coordinator::ChannelRenderer;

ChannelRenderer::Clock::time_point soon() {
    return ChannelRenderer::Clock::now() + std::chrono::seconds(20);
}

/// Its picture, in messages or in memory.
fabric::Image arrivedIn(const fabric::ChannelResult& result) {
    return result.lent ? fabric::copied(result.lent->view()) : result.image;
}

class RenderServerTest : public testing::Test {
protected:
    RenderServerTest()
        : thread_(GlThread::start(fakeDrawers(control_)).value()),
          server_(RenderServer::start("unix:" + folder_.path("s"), *thread_).value()),
          renderer_(coordinator::connectRenderer(server_->address())),
          stub_(v1::RenderService::NewStub(grpc::CreateCustomChannel(
              server_->address(), grpc::InsecureChannelCredentials(), wire::clientArguments()))) {}

    static fabric::FrameData frameData() { return {1, {}, 2, fabric::Shading::Flat}; }
    static fabric::ChannelTask task(int width, int height, bool wantsDepth) {
        return {1, 1, width, height, {0, 0, width, height}, {}, wantsDepth};
    }

    test::TemporaryFolder folder_;
    std::shared_ptr<FakeDrawerControl> control_ = std::make_shared<FakeDrawerControl>();
    std::unique_ptr<GlThread> thread_;
    std::unique_ptr<RenderServer> server_;
    std::shared_ptr<ChannelRenderer> renderer_;
    std::unique_ptr<v1::RenderService::Stub> stub_;
};

TEST_F(RenderServerTest, APictureOfTwentyMegabytesArrivesAsItWasDrawn) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const fabric::ChannelTask large = task(2000, 1300, true);
    const auto result = renderer_->render(large, soon());
    ASSERT_TRUE(result.ok()) << result.status();
    const fabric::ChannelResult expected = FakeDrawer::picture(frameData(), large);
    EXPECT_TRUE(arrivedIn(*result) == expected.image);
    EXPECT_EQ(result->statistics, expected.statistics);
}

TEST_F(RenderServerTest, ChunksAreOfOneMebibyteAtMost) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(1000, 700, true));
    grpc::ClientContext context;
    const auto reader = stub_->RenderChannel(&context, request);
    v1::RenderChannelResponse part;
    ASSERT_TRUE(reader->Read(&part));
    EXPECT_EQ(part.header().pixel_bytes(), 1000U * 700 * 8);
    std::size_t bytes = 0;
    while (reader->Read(&part)) {
        EXPECT_LE(part.chunk().size(), wire::kChunkBytes);
        bytes += part.chunk().size();
    }
    EXPECT_EQ(bytes, 1000U * 700 * 8);
    EXPECT_TRUE(reader->Finish().ok());
}

/// Expected are the pixels of what was drawn and, beside it, the scene's background, within what a
/// JPEG changes.
TEST_F(RenderServerTest, AChannelComesAsAJpegOfAllOfItWhereItIsWantedSo) {
    fabric::Scene scene;
    scene.background = {200, 100, 0, 255};
    ASSERT_TRUE(renderer_->openScene(scene, soon()).ok());
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->image = fabric::makeImage({40, 30, 100, 60}, {10, 20, 230, 255}, false);
    fabric::ChannelTask asked = task(320, 200, false);
    asked.pixelViewport = {20, 10, 250, 150};
    asked.jpegQuality = 90;
    const auto result = renderer_->render(asked, soon());
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->image.area, control_->image->area);
    const auto picture = wire::decodeJpeg(result->jpeg);
    ASSERT_TRUE(picture.ok()) << picture.status();
    ASSERT_EQ(picture->area, (fabric::PixelViewport{0, 0, 250, 150}));
    const auto at = [&](int x, int y) {
        return picture->colour[static_cast<std::size_t>((y - 10) * 250 + x - 20)];
    };
    for (const auto& [x, y] : {std::pair(25, 15), {200, 150}, {90, 110}})
        EXPECT_NEAR(at(x, y).r, 200, 4) << x << ',' << y;
    EXPECT_NEAR(at(90, 60).b, 230, 4);
    EXPECT_NEAR(at(60, 40).r, 10, 4);
}

TEST_F(RenderServerTest, AJpegOfDepthIsRefused) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    fabric::ChannelTask asked = task(64, 48, true);
    asked.jpegQuality = 90;
    const absl::Status status = renderer_->render(asked, soon()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("a JPEG has no depth"));
}

using HardCase24 = RenderServerTest;

/// Any bits at all, also such that are no number, less than none or next to none.
fabric::Image noise(const fabric::PixelViewport& area, std::uint32_t seed) {
    std::mt19937 random(seed);
    fabric::Image image = fabric::makeImage(area, {}, true);
    constexpr std::array<std::uint32_t, 6> kOdd = {0x7fc00000, 0xffffffff, 0x80000000,
                                                   0x00000001, 0x7f800000, 0xff800000};
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        image.colour[i] = std::bit_cast<fabric::Rgba>(static_cast<std::uint32_t>(random()));
        image.depth[i] = std::bit_cast<float>(i % 3 == 0 ? kOdd[random() % kOdd.size()]
                                                         : static_cast<std::uint32_t>(random()));
    }
    return image;
}

/// Every other pixel of `image` as nothing that was drawn.
fabric::Image checkered(fabric::Image image) {
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        if ((i % static_cast<std::size_t>(image.area.width) +
             i / static_cast<std::size_t>(image.area.width)) %
                2 ==
            0) {
            image.colour[i] = {};
            image.depth[i] = 0;
        }
    return image;
}

/// Expected is what was drawn, to the bit: colour and depth, as active runs, and colour alone, over
/// a Unix socket, raw, and over TCP; and in memory, where it fits.
TEST_F(HardCase24, WhateverBitsWereDrawnArriveInPicturesOfAnyShape) {
    const auto overTcp = RenderServer::start("127.0.0.1:0", *thread_).value();
    const auto far = coordinator::connectRenderer(overTcp->address(), {}, nullptr, false);
    const auto near = coordinator::connectRenderer(server_->address(), {}, nullptr, false);
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    ASSERT_TRUE(far->setFrameData(frameData(), soon()).ok());
    for (const fabric::Image& drawn :
         {noise({0, 0, 640, 360}, 1), noise({0, 0, 16384, 1}, 2), noise({7, 0, 1, 16384}, 3),
          noise({16383, 16383, 1, 1}, 4), checkered(noise({3, 5, 511, 257}, 5)),
          fabric::makeImage({0, 0, 640, 360}, {9, 8, 7, 6}, true),
          // A chunk's bytes of colour, and four more.
          noise({0, 0, 512, 512}, 6), noise({0, 0, 37, 7085}, 7), fabric::Image{}}) {
        control_->image = drawn;
        fabric::ChannelTask whole = task(16384, 16384, true);
        if (!drawn.area.isEmpty())
            whole.pixelViewport = drawn.area;
        const auto isSame = [](const auto& one, const auto& other) {
            return std::ranges::equal(std::as_bytes(std::span(one)),
                                      std::as_bytes(std::span(other)));
        };
        for (ChannelRenderer* renderer : {renderer_.get(), near.get(), far.get()})
            for (const auto& [wantsDepth, usesRoom] :
                 {std::pair(true, false), {false, false}, {true, true}, {false, true}}) {
                control_->usesRoom = usesRoom;
                whole.wantsDepth = wantsDepth;
                if (!wantsDepth)
                    control_->image->depth.clear();
                const auto arrived = renderer->render(whole, soon());
                ASSERT_TRUE(arrived.ok()) << arrived.status();
                const fabric::Image picture = arrivedIn(*arrived);
                EXPECT_EQ(picture.area, drawn.area);
                EXPECT_TRUE(isSame(picture.colour, drawn.colour));
                EXPECT_TRUE(isSame(picture.depth, control_->image->depth));
                control_->image = drawn;
            }
    }
}

TEST_F(RenderServerTest, WhetherAPictureCameInMemoryOrMessagesIsCounted) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto telemetry = std::make_shared<observe::Telemetry>();
    for (const bool offersMemory : {true, false})
        ASSERT_TRUE(coordinator::connectRenderer(server_->address(), {}, telemetry, offersMemory)
                        ->render(task(640, 360, true), soon())
                        .ok());
    const std::string text = telemetry->metrics.text({}, {});
    EXPECT_THAT(text, testing::HasSubstr("eyrie_renderer_pictures_total{way=\"memory\"} 1"));
    EXPECT_THAT(text, testing::HasSubstr("eyrie_renderer_pictures_total{way=\"messages\"} 1"));
}

/// Expected is the message form of what could not go into memory.
TEST_F(RenderServerTest, MemoryThatIsNotThereIsAnsweredInMessages) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto memory = wire::PictureMemory::create(64 * 64 * 4).value();
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(64, 64, false));
    *request.mutable_memory() = wire::toMessage(memory->offer());
    const auto answer = [&] {
        grpc::ClientContext context;
        const auto reader = stub_->RenderChannel(&context, request);
        v1::RenderChannelResponse part;
        EXPECT_TRUE(reader->Read(&part));
        const bool isInMemory = part.header().is_in_memory();
        std::size_t bytes = 0;
        while (reader->Read(&part)) bytes += part.chunk().size();
        EXPECT_TRUE(reader->Finish().ok());
        EXPECT_EQ(bytes, isInMemory ? 0U : 64U * 64 * 4);
        return isInMemory;
    };
    EXPECT_TRUE(answer());
    EXPECT_TRUE(fabric::copied(memory->picture({0, 0, 64, 64}, false).value()) ==
                FakeDrawer::picture(frameData(), task(64, 64, false)).image);
    request.mutable_memory()->set_bytes(64 * 64 * 4 + 1);
    EXPECT_FALSE(answer());
    *request.mutable_memory() = wire::toMessage(memory->offer());
    request.mutable_memory()->set_key(std::string(32, 'x'));
    EXPECT_FALSE(answer());
    const auto small = wire::PictureMemory::create(64 * 64 * 4 - 1).value();
    *request.mutable_memory() = wire::toMessage(small->offer());
    EXPECT_FALSE(answer());
}

TEST_F(RenderServerTest, PixelsDrawnIntoTheMemoryAreInItAndThoseThatDoNotFitAreInMessages) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->usesRoom = true;
    const fabric::Image drawn = FakeDrawer::picture(frameData(), task(64, 64, true)).image;
    for (const bool fits : {true, false}) {
        const auto memory = wire::PictureMemory::create(64 * 64 * 8 - (fits ? 0 : 1)).value();
        v1::RenderChannelRequest request;
        *request.mutable_task() = wire::toMessage(task(64, 64, true));
        *request.mutable_memory() = wire::toMessage(memory->offer());
        grpc::ClientContext context;
        const auto reader = stub_->RenderChannel(&context, request);
        v1::RenderChannelResponse part;
        ASSERT_TRUE(reader->Read(&part));
        EXPECT_EQ(part.header().is_in_memory(), fits);
        EXPECT_TRUE(part.header().has_depth());
        std::size_t bytes = 0;
        while (reader->Read(&part)) bytes += part.chunk().size();
        EXPECT_TRUE(reader->Finish().ok());
        EXPECT_EQ(bytes, fits ? 0U : 64U * 64 * 8);
        if (fits) {
            EXPECT_TRUE(fabric::copied(memory->picture(drawn.area, true).value()) == drawn);
        }
    }
}

/// Expected: the second task is at the renderer while the first is drawn, and says how long it
/// waited there.
TEST_F(RenderServerTest, OneThatHasNearlyDrawnTakesTheNextTask) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->saysNearlyDrawn = true;
    control_->hold();
    std::atomic<int> told{0};
    std::atomic<std::chrono::nanoseconds> waited{};
    std::jthread first([&] {
        const auto drawn = renderer_->render(task(8, 8, true), soon(), {[&] { ++told; }, {}});
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        EXPECT_TRUE(arrivedIn(*drawn) == FakeDrawer::picture(frameData(), task(8, 8, true)).image);
    });
    ASSERT_TRUE(eventually([&] { return told == 1; }));
    EXPECT_EQ(control_->drawn, 0);
    std::jthread second([&] {
        const auto note = [&](std::chrono::nanoseconds time) { waited = time; };
        const auto drawn = renderer_->render(task(9, 7, false), soon(), {[&] { ++told; }, note});
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        EXPECT_TRUE(arrivedIn(*drawn) == FakeDrawer::picture(frameData(), task(9, 7, false)).image);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(control_->begun, 1);
    control_->release();
    first.join();
    second.join();
    EXPECT_EQ(told, 2) << "each once";
    EXPECT_GT(waited.load(), std::chrono::nanoseconds(0));
    EXPECT_LT(waited.load(), std::chrono::seconds(20));
}

TEST_F(RenderServerTest, OneThatFailsAfterItHadNearlyDrawnSaysWhy) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->saysNearlyDrawn = true;
    control_->fails = true;
    int told = 0;
    const auto drawn = renderer_->render(task(8, 8, true), soon(), {[&] { ++told; }, {}});
    EXPECT_TRUE(absl::IsDataLoss(drawn.status())) << drawn.status();
    EXPECT_EQ(told, 1);
    control_->saysNearlyDrawn = false;
    EXPECT_FALSE(renderer_->render(task(8, 8, true), soon(), {[&] { ++told; }, {}}).ok());
    EXPECT_EQ(told, 1) << "an error is no picture";
    control_->fails = false;
    EXPECT_TRUE(renderer_->render(task(8, 8, true), soon()).ok());
}

TEST_F(RenderServerTest, FrameDataMayComeWithTheTask) {
    fabric::FrameData second = frameData();
    second.version = 2;
    second.tauPixels = 7;
    fabric::ChannelTask next = task(8, 8, false);
    next.frameDataVersion = 2;
    const auto drawn = renderer_->render(next, soon(), {}, &second);
    ASSERT_TRUE(drawn.ok()) << drawn.status();
    EXPECT_EQ(drawn->statistics.tauAskedPixels, 7);
    EXPECT_TRUE(renderer_->render(next, soon()).ok()) << "it is kept";
}

TEST_F(RenderServerTest, AnUnknownFrameDataVersionIsAFailedPrecondition) {
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kFailedPrecondition);
}

TEST_F(RenderServerTest, ATaskBeyondTheLimitsIsRefusedUndrawn) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto status = renderer_->render(task(100'000, 8, false), soon()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("task.view_width"));
    EXPECT_EQ(control_->drawn, 0);
}

TEST_F(RenderServerTest, SceneErrorsKeepTheirCodeAndMessage) {
    fabric::Scene scene;
    scene.objects.push_back({"ghost", fabric::ObjectKind::Mesh, "absent", fabric::Mat4(1.0), {}});
    const auto info = renderer_->openScene(scene, soon());
    EXPECT_EQ(info.status().code(), absl::StatusCode::kNotFound);
    EXPECT_THAT(std::string(info.status().message()), testing::HasSubstr("absent: no such file"));
}

TEST_F(RenderServerTest, ASceneThatTakesAllMemoryIsRefusedAndTheNextOneOpens) {
    fabric::Scene scene;
    scene.objects.push_back({"ghost", fabric::ObjectKind::Mesh, "endless", fabric::Mat4(1.0), {}});
    EXPECT_EQ(renderer_->openScene(scene, soon()).status().code(),
              absl::StatusCode::kResourceExhausted);
    EXPECT_TRUE(renderer_->openScene({}, soon()).ok());
}

TEST_F(RenderServerTest, AChannelThatTakesAllMemoryIsRefusedAndTheNextOneDrawn) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hasNoMemory = true;
    const absl::Status refused = renderer_->render(task(8, 4, true), soon()).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(std::string(refused.message()),
                testing::HasSubstr("8x4 pixels and their depths within 2 pixels"));
    control_->hasNoMemory = false;
    EXPECT_TRUE(renderer_->render(task(8, 4, true), soon()).ok());
}

TEST_F(RenderServerTest, AnOpenSceneReportsItsExtent) {
    const auto info = renderer_->openScene({}, soon());
    ASSERT_TRUE(info.ok()) << info.status();
    EXPECT_EQ(info->bounds, (fabric::Box{{0, 0, 0}, {1, 1, 1}}));
    EXPECT_EQ(info->triangles, 12U);
}

TEST_F(RenderServerTest, ACallGivenUpBeforeItsTurnIsNotDrawn) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::jthread first([&] { EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok()); });
    ASSERT_TRUE(eventually([&] { return control_->begun == 1; }));
    const auto second = coordinator::connectRenderer(server_->address());
    const auto shortly = ChannelRenderer::Clock::now() + std::chrono::milliseconds(50);
    EXPECT_EQ(second->render(task(8, 8, false), shortly).status().code(),
              absl::StatusCode::kDeadlineExceeded);
    // Its cancellation is ahead of these on the same connection.
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(second->setFrameData(frameData(), soon()).ok());
    control_->release();
    first.join();
    ASSERT_TRUE(renderer_->render(task(8, 8, false), soon()).ok());
    EXPECT_EQ(control_->drawn, 2);
}

TEST_F(RenderServerTest, AReaderThatGoesAwayMidPictureHoldsNothingUp) {
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

TEST_F(RenderServerTest, ReadersThatNeverReadAreBounded) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(2000, 1300, true));
    std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
    std::vector<std::unique_ptr<grpc::ClientReader<v1::RenderChannelResponse>>> idle;
    for (int i = 0; i < ReplySlots::kMaxOpen; ++i) {
        contexts.push_back(std::make_unique<grpc::ClientContext>());
        idle.push_back(stub_->RenderChannel(contexts.back().get(), request));
        idle.back()->WaitForInitialMetadata();
    }
    EXPECT_EQ(renderer_->render(task(8, 8, false), soon()).status().code(),
              absl::StatusCode::kResourceExhausted);
    for (const auto& context : contexts) context->TryCancel();
    EXPECT_TRUE(eventually([&] { return renderer_->render(task(8, 8, false), soon()).ok(); }));
}

TEST_F(RenderServerTest, ReadersThatNeverReadAreGivenUpAfterAWhile) {
    RenderService service(*thread_, {}, std::chrono::milliseconds(300));
    const wire::Listening impatient = wire::listen({"unix:" + folder_.path("i")}, service).value();
    const auto stub = v1::RenderService::NewStub(grpc::CreateCustomChannel(
        impatient.addresses.front(), grpc::InsecureChannelCredentials(), wire::clientArguments()));
    const auto renderer = coordinator::connectRenderer(impatient.addresses.front());
    ASSERT_TRUE(renderer->setFrameData(frameData(), soon()).ok());
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(2000, 1300, true));
    std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
    std::vector<std::unique_ptr<grpc::ClientReader<v1::RenderChannelResponse>>> idle;
    for (int i = 0; i <= ReplySlots::kMaxOpen; ++i) {
        contexts.push_back(std::make_unique<grpc::ClientContext>());
        idle.push_back(stub->RenderChannel(contexts.back().get(), request));
        idle.back()->WaitForInitialMetadata();
    }
    EXPECT_TRUE(eventually([&] { return renderer->render(task(8, 8, false), soon()).ok(); }));
    v1::RenderChannelResponse message;
    while (idle.front()->Read(&message)) {
    }
    EXPECT_EQ(idle.front()->Finish().error_code(), grpc::StatusCode::CANCELLED);
    impatient.server->Shutdown();
}

TEST_F(RenderServerTest, ASceneGivenUpBeforeItsTurnIsNotOpened) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::jthread first([&] { EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok()); });
    ASSERT_TRUE(eventually([&] { return control_->begun == 1; }));
    const auto second = coordinator::connectRenderer(server_->address());
    const auto shortly = ChannelRenderer::Clock::now() + std::chrono::milliseconds(50);
    EXPECT_EQ(second->openScene({}, shortly).status().code(), absl::StatusCode::kDeadlineExceeded);
    // Its cancellation is ahead of these on the same connection.
    for (int i = 0; i < 200; ++i) ASSERT_TRUE(second->setFrameData(frameData(), soon()).ok());
    control_->release();
    first.join();
    ASSERT_TRUE(renderer_->render(task(8, 8, false), soon()).ok());
    EXPECT_EQ(control_->opened, 0);
}

TEST_F(RenderServerTest, CancelEndsTheCallInProgressAndEveryLaterOne) {
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

TEST_F(RenderServerTest, PicksAreAnsweredWhileAFrameIsBeingDrawn) {
    const fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {20, 30}, 2};
    EXPECT_TRUE(absl::IsFailedPrecondition(renderer_->pick(request, soon()).status()));
    ASSERT_TRUE(renderer_->openScene({}, soon()).ok());
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->hold();
    std::jthread drawing([&] { EXPECT_TRUE(renderer_->render(task(8, 8, false), soon()).ok()); });
    EXPECT_TRUE(eventually([&] { return control_->begun == 1; }));
    const auto picked = renderer_->pick(request, soon());
    EXPECT_EQ(control_->drawn, 0);
    control_->release();
    ASSERT_TRUE(picked.ok() && picked->has_value()) << picked.status();
    EXPECT_EQ((*picked)->worldMetres, fabric::Vec3(20, 30, 2));
    EXPECT_EQ((*picked)->elevationMetres, 3);
    EXPECT_TRUE(std::isinf((*picked)->farthestMetres));
}

TEST_F(RenderServerTest, PicksOfNothingAndOfDamagedDataSaySo) {
    ASSERT_TRUE(renderer_->openScene({}, soon()).ok());
    const auto pickAt = [&](const fabric::Vec2& place) {
        return renderer_->pick({{{1, 2, 3}, {4, 5, 6}}, 640, 480, place, 1}, soon());
    };
    EXPECT_EQ(pickAt({0, 5}).value(), fabric::Picked());
    EXPECT_TRUE(absl::IsDataLoss(pickAt({5, 0}).status()));
    EXPECT_TRUE(absl::IsInvalidArgument(pickAt({-5, 0}).status()));
}

TEST_F(RenderServerTest, AStoppedChannelIsGivenUpByTheDrawerAndTheNextIsWhole) {
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
TEST_F(RenderServerTest, AStoppedChannelThatWaitsIsNotBegun) {
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

TEST_F(RenderServerTest, StopEndsTheCallInProgress) {
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

TEST(RenderServer, AnAddressThatCannotBeListenedOnIsAnError) {
    auto thread = GlThread::start(fakeDrawers(std::make_shared<FakeDrawerControl>())).value();
    EXPECT_EQ(RenderServer::start("unix:/no/such/folder/s", *thread).status().code(),
              absl::StatusCode::kUnavailable);
}

}  // namespace
}  // namespace eyrie::service
