// SPDX-License-Identifier: Apache-2.0
#include "service/render_server.h"

#include <cmath>
#include <thread>

#include <gmock/gmock.h>

#include "render_server_fixture.h"
#include "tests/service/eventually.h"

namespace eyrie::service {
namespace {

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

TEST_F(RenderServerTest, DataThatAreUnavailableAreNotTakenForARendererThatIs) {
    fabric::Scene scene;
    scene.objects.push_back({"ghost", fabric::ObjectKind::Mesh, "silent", fabric::Mat4(1.0), {}});
    const auto info = renderer_->openScene(scene, soon());
    EXPECT_EQ(info.status().code(), absl::StatusCode::kAborted);
    EXPECT_THAT(std::string(info.status().message()), testing::HasSubstr("silent: no answer"));
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

TEST(RenderServer, AnAddressThatCannotBeListenedOnIsAnError) {
    auto thread = GlThread::start(fakeDrawers(std::make_shared<FakeDrawerControl>())).value();
    EXPECT_EQ(RenderServer::start("unix:/no/such/folder/s", *thread).status().code(),
              absl::StatusCode::kUnavailable);
}
}  // namespace
}  // namespace eyrie::service
