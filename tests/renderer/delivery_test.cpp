// SPDX-License-Identifier: Apache-2.0
// How a picture comes about and where it goes changes none of its pixels.
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

class Delivery : public testing::TestWithParam<test::SampleKind> {
protected:
    void SetUp() override {
        const auto scene = test::sampleScene(GetParam());
        ASSERT_TRUE(scene.ok()) << scene.status();
        renderer_ = test::makeRenderer();
        const auto info = renderer_->openScene(*scene);
        ASSERT_TRUE(info.ok()) << info.status();
        frame_.version = 1;
        frame_.tauPixels = 0.1;
        frame_.camera.target = info->bounds.centre();
        frame_.camera.eye =
            frame_.camera.target + fabric::Vec3(0.1, -0.8, 0.5) * info->bounds.size().x;
        task_.frameDataVersion = 1;
        task_.viewWidth = 320;
        task_.viewHeight = 180;
        task_.pixelViewport = {3, 2, 311, 170};
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::FrameData frame_;
    fabric::ChannelTask task_;
};

TEST_P(Delivery, PixelsGoWhereThereIsRoomForThem) {
    for (const bool wantsDepth : {true, false}) {
        task_.wantsDepth = wantsDepth;
        const auto expected = renderer_->render(frame_, task_);
        ASSERT_TRUE(expected.ok()) << expected.status();
        const fabric::Image& image = expected->image;
        ASSERT_FALSE(image.area.isEmpty());
        fabric::Image there = fabric::makeImage(image.area, {1, 2, 3, 4}, wantsDepth);
        int asked = 0;
        const auto result = renderer_->render(
            frame_, task_,
            {.room = [&](const fabric::PixelViewport& area,
                         bool withDepth) -> std::optional<fabric::PixelRoom> {
                ++asked;
                EXPECT_EQ(area, image.area);
                EXPECT_EQ(withDepth, wantsDepth);
                return fabric::PixelRoom{there.colour.data(),
                                         withDepth ? there.depth.data() : nullptr};
            }});
        ASSERT_TRUE(result.ok()) << result.status();
        EXPECT_EQ(asked, 1);
        EXPECT_TRUE(there == image);
        EXPECT_EQ(result->image.area, image.area);
        EXPECT_TRUE(result->image.colour.empty() && result->image.depth.empty());
        EXPECT_EQ(result->statistics.tauAchievedPixels, expected->statistics.tauAchievedPixels);
        const auto without = renderer_->render(frame_, task_, {.room = [](const auto&, bool) {
                                                   return std::optional<fabric::PixelRoom>();
                                               }});
        ASSERT_TRUE(without.ok()) << without.status();
        EXPECT_TRUE(without->image == image);
    }
}

TEST_P(Delivery, ItIsNearlyDrawnOnceAndBeforeItsPixelsAreThere) {
    for (const auto occlusion : {fabric::Occlusion::Off, fabric::Occlusion::On})
        for (const bool measuresStages : {false, true}) {
            frame_.occlusion = occlusion;
            task_.measuresStages = measuresStages;
            const auto expected = renderer_->render(frame_, task_);
            ASSERT_TRUE(expected.ok()) << expected.status();
            int told = 0;
            int asked = 0;
            const auto result =
                renderer_->render(frame_, task_,
                                  {.nearlyDrawn = [&] { ++told; },
                                   .room =
                                       [&](const auto&, bool) {
                                           asked += told;
                                           return std::optional<fabric::PixelRoom>();
                                       }});
            ASSERT_TRUE(result.ok()) << result.status();
            EXPECT_EQ(told, 1);
            EXPECT_EQ(asked, 1);
            EXPECT_TRUE(result->image == expected->image);
        }
}

TEST_P(Delivery, WhatHasNothingToDrawIsNearlyDrawnToo) {
    frame_.camera.target = frame_.camera.eye + (frame_.camera.eye - frame_.camera.target);
    int told = 0;
    const auto result = renderer_->render(frame_, task_, {.nearlyDrawn = [&] { ++told; }});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(told, 1);
}

INSTANTIATE_TEST_SUITE_P(Of, Delivery,
                         testing::Values(test::SampleKind::Mesh, test::SampleKind::Terrain),
                         [](const auto& of) { return test::name(of.param); });

}  // namespace
}  // namespace eyrie
