// SPDX-License-Identifier: Apache-2.0
// A hidden object is as if the scene did not have it: in pictures, promises, counts and picks.
#include <memory>

#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/pick/picker.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

class HiddenObjects : public testing::Test {
protected:
    void SetUp() override {
        const auto scene = test::sampleScene(test::SampleKind::Both);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        ASSERT_EQ(scene_.objects.size(), 2U);
        const auto bounds = test::makeRenderer()->openScene(scene_)->bounds;
        const fabric::Vec3 size = bounds.max - bounds.min;
        camera_.target = bounds.centre();
        camera_.eye = bounds.centre() + fabric::Vec3(0.2, -0.8, 0.6) * std::max(size.x, size.y);
    }

    struct Seen {
        fabric::Image image;
        fabric::FrameStatistics statistics;
        fabric::Picked middle;
    };

    Seen see(const fabric::Scene& scene, const fabric::HiddenObjects& hidden,
             std::optional<fabric::FrameBudget> budget = {}) const {
        const std::unique_ptr<Renderer> renderer = test::makeRenderer();
        EXPECT_TRUE(renderer->openScene(scene).ok());
        fabric::FrameData frame;
        frame.camera = camera_;
        frame.look.hidden = hidden;
        frame.budget = budget;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        auto result = renderer->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        fabric::Image whole = fabric::makeImage(task.pixelViewport, scene.background, false);
        fabric::paste(result->image, whole);
        const auto picked = renderer->picker()->pick({.camera = camera_,
                                                      .viewWidth = 1,
                                                      .viewHeight = 1,
                                                      .place = {0.5, 0.5},
                                                      .hidden = hidden});
        EXPECT_TRUE(picked.ok()) << picked.status();
        return {std::move(whole), result->statistics, *picked};
    }

    fabric::Scene without(std::size_t object) const {
        fabric::Scene scene = scene_;
        scene.objects.erase(scene.objects.begin() + static_cast<std::ptrdiff_t>(object));
        return scene;
    }

    fabric::Scene scene_;
    fabric::Camera camera_;
};

TEST_F(HiddenObjects, AreAsIfTheSceneDidNotHaveThem) {
    const Seen all = see(scene_, {});
    for (const std::int32_t object : {0, 1}) {
        const Seen hidden = see(scene_, {{object}});
        const Seen absent = see(without(static_cast<std::size_t>(object)), {});
        EXPECT_FALSE(hidden.image == all.image) << object << " should be seen";
        EXPECT_TRUE(hidden.image == absent.image) << object;
        EXPECT_EQ(hidden.statistics.triangles, absent.statistics.triangles) << object;
        EXPECT_EQ(hidden.statistics.nodes, absent.statistics.nodes) << object;
        EXPECT_EQ(hidden.statistics.tauAchievedPixels, absent.statistics.tauAchievedPixels)
            << object;
        ASSERT_EQ(hidden.middle.has_value(), absent.middle.has_value()) << object;
        if (hidden.middle) {
            EXPECT_EQ(hidden.middle->worldMetres, absent.middle->worldMetres) << object;
            EXPECT_EQ(hidden.middle->object, 1 - object) << "positions stay the scene's";
        }
    }
}

TEST_F(HiddenObjects, TakeNothingOfAFramesTime) {
    const fabric::FrameBudget budget{
        .milliseconds = 10, .fixedMilliseconds = 1, .millisecondsATriangle = 1e-3};
    const Seen hidden = see(scene_, {{0}}, budget);
    const Seen absent = see(without(0), {}, budget);
    ASSERT_TRUE(hidden.statistics.budget && absent.statistics.budget);
    EXPECT_TRUE(*hidden.statistics.budget == *absent.statistics.budget);
}

TEST_F(HiddenObjects, LeaveTheBackgroundWhereAllAre) {
    const Seen nothing = see(scene_, {{0, 1, 7}});
    EXPECT_TRUE(nothing.image ==
                fabric::makeImage({0, 0, kWidth, kHeight}, scene_.background, false));
    EXPECT_EQ(nothing.statistics.triangles, 0U);
    EXPECT_EQ(nothing.statistics.tauAchievedPixels, 0);
    EXPECT_FALSE(nothing.middle);
}

}  // namespace
}  // namespace eyrie
