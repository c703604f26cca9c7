// SPDX-License-Identifier: Apache-2.0
// A picture that nobody wants any more is given up, and leaves nothing behind that later ones show.
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

class StoppedDraw : public testing::TestWithParam<test::SampleKind> {
protected:
    void SetUp() override {
        auto scene = test::sampleScene(GetParam());
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        frame_.version = 1;
        frame_.tauPixels = 0.5;
        frame_.occlusion = fabric::Occlusion::On;
        task_.frameDataVersion = 1;
        task_.viewWidth = 320;
        task_.viewHeight = 180;
        task_.pixelViewport = {0, 0, 320, 180};
        task_.wantsDepth = true;
    }

    /// On a renderer that has drawn nothing yet.
    std::unique_ptr<Renderer> open() {
        auto renderer = test::makeRenderer();
        const auto info = renderer->openScene(scene_);
        EXPECT_TRUE(info.ok()) << info.status();
        const fabric::Vec3 size = info->bounds.size();
        frame_.camera.target = info->bounds.centre();
        frame_.camera.eye = frame_.camera.target + fabric::Vec3(0.1, -0.8, 0.5) * size.x;
        return renderer;
    }

    fabric::Scene scene_;
    fabric::FrameData frame_;
    fabric::ChannelTask task_;
};

TEST_P(StoppedDraw, BeforeItBeginsCostsNothing) {
    const auto renderer = open();
    std::stop_source stop;
    stop.request_stop();
    const std::uint64_t before = renderer->memory().deviceBytes;
    EXPECT_TRUE(
        absl::IsCancelled(renderer->render(frame_, task_, {.stop = stop.get_token()}).status()));
    EXPECT_EQ(renderer->memory().deviceBytes, before);
}

TEST_P(StoppedDraw, AnywhereLeavesTheNextPictureAsItIs) {
    const auto reference = open()->render(frame_, task_);
    ASSERT_TRUE(reference.ok()) << reference.status();
    const auto renderer = open();
    int whole = 0;
    // Later and later, until some are drawn to their ends; the first ones wait for pages.
    for (int i = 0; whole < 3 && i < 60; ++i) {
        std::stop_source stop;
        std::jthread stopper([&, i] {
            std::this_thread::sleep_for(std::chrono::microseconds(i * i * 50));
            stop.request_stop();
        });
        const auto result = renderer->render(frame_, task_, {.stop = stop.get_token()});
        whole += result.ok() ? 1 : 0;
        if (result.ok())
            EXPECT_TRUE(result->image == reference->image) << i;
        else
            EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
    }
    const auto last = renderer->render(frame_, task_);
    ASSERT_TRUE(last.ok()) << last.status();
    EXPECT_TRUE(last->image == reference->image);
    EXPECT_TRUE(last->statistics.complete);
}

INSTANTIATE_TEST_SUITE_P(Of, StoppedDraw,
                         testing::Values(test::SampleKind::Mesh, test::SampleKind::Terrain),
                         [](const auto& of) { return test::name(of.param); });

}  // namespace
}  // namespace eyrie
