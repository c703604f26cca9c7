// SPDX-License-Identifier: Apache-2.0
// Looks of single objects: each shows as in a picture that has its look all over, and the others as
// without it.
#include <algorithm>
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

using fabric::Shading;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr std::array kShadings{Shading::Smooth, Shading::Gouraud, Shading::Flat,
                               Shading::Wireframe};
const fabric::Vec3 kOrange{0.9, 0.5, 0.1};

class ObjectLook : public testing::Test {
protected:
    void SetUp() override {
        const auto scene = test::sampleScene(test::SampleKind::Both);
        ASSERT_TRUE(scene.ok()) << scene.status();
        ASSERT_EQ(scene->objects.size(), 2U);
        renderer_ = test::makeRenderer();
        open(*scene);
    }

    void open(const fabric::Scene& scene) {
        scene_ = scene;
        const auto info = renderer_->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        const fabric::Vec3 size = info->bounds.max - info->bounds.min;
        frame_.camera.target = info->bounds.centre();
        frame_.camera.eye =
            info->bounds.centre() + fabric::Vec3(0.1, -0.4, 0.3) * std::max(size.x, size.y);
    }

    fabric::ChannelResult draw(const fabric::Range& range = {}) {
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.range = range;
        task.wantsDepth = true;
        auto result = renderer_->render(frame_, task);
        EXPECT_TRUE(result.ok()) << result.status();
        fabric::Image whole = fabric::makeImage(task.pixelViewport, scene_.background, true);
        fabric::paste(result->image, whole);
        result->image = std::move(whole);
        return *std::move(result);
    }

    /// One object, shown as all of a picture is.
    fabric::Image alone(std::int32_t object, Shading shading) {
        const fabric::FrameData before = frame_;
        frame_.shading = shading;
        frame_.look.objects = {};
        frame_.look.hidden = {{1 - object}};
        fabric::Image image = draw().image;
        frame_ = before;
        return image;
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
    fabric::FrameData frame_;
};

TEST_F(ObjectLook, ShadesEachAsAPictureOfThatShading) {
    for (const Shading first : kShadings)
        for (const Shading second : kShadings)
            for (const Shading whole : {Shading::Flat, Shading::Wireframe}) {
                frame_.shading = whole;
                frame_.look.objects = {{{0, {}, first}, {1, {}, second}}};
                fabric::Image merged = alone(0, first);
                fabric::mergeDepth(alone(1, second), merged);
                EXPECT_TRUE(draw().image == merged)
                    << static_cast<int>(first) << " " << static_cast<int>(second) << " in "
                    << static_cast<int>(whole);
            }
}

TEST_F(ObjectLook, LeavesTheOthersAndThePromiseAlone) {
    const fabric::ChannelResult plain = draw();
    frame_.look.objects = {{{1, kOrange, Shading::Flat}, {7, kOrange, Shading::Wireframe}}};
    const fabric::ChannelResult own = draw();
    const fabric::Image terrain = alone(0, Shading::Smooth);
    EXPECT_TRUE(own.image.depth == plain.image.depth);
    EXPECT_EQ(own.statistics.tauAchievedPixels, plain.statistics.tauAchievedPixels);
    EXPECT_EQ(own.statistics.nodes, plain.statistics.nodes);
    int changed = 0;
    for (std::size_t i = 0; i < own.image.colour.size(); ++i) {
        if (own.image.depth[i] == terrain.depth[i])
            EXPECT_EQ(own.image.colour[i], plain.image.colour[i]);
        else
            changed += own.image.colour[i] != plain.image.colour[i] ? 1 : 0;
    }
    EXPECT_GT(changed, 500);
}

/// In light from everywhere a surface shows its colour.
TEST_F(ObjectLook, ColoursAreTheOnesAskedFor) {
    fabric::Scene scene = scene_;
    scene.ambient = 1;
    scene.lights = {{{0, 0, -1}, {0, 0, 0}}};
    open(scene);
    const fabric::Vec3 green{0.2, 0.7, 0.3};
    frame_.look.objects = {{{0, kOrange}, {1, green}}};
    const fabric::Image image = draw().image;
    const fabric::Image terrain = alone(0, Shading::Smooth);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        if (image.depth[i] == 0)
            continue;
        const fabric::Vec3& wanted = image.depth[i] == terrain.depth[i] ? kOrange : green;
        EXPECT_NEAR(image.colour[i].r, 255 * wanted.x, 1);
        EXPECT_NEAR(image.colour[i].g, 255 * wanted.y, 1);
        EXPECT_NEAR(image.colour[i].b, 255 * wanted.z, 1);
    }
}

TEST_F(ObjectLook, IsTheSameWhoeverDraws) {
    for (const Shading shading : kShadings) {
        frame_.look.objects = {{{0, kOrange}, {1, {}, shading}}};
        fabric::Image composed =
            fabric::makeImage({0, 0, kWidth, kHeight}, scene_.background, true);
        for (const fabric::Range& range : fabric::split(fabric::Range{}, fabric::equalCuts(3)))
            fabric::mergeDepth(draw(range).image, composed);
        EXPECT_TRUE(composed == draw().image) << static_cast<int>(shading);
    }
}

TEST_F(ObjectLook, LeavesNothingBehind) {
    const fabric::Image plain = draw().image;
    frame_.look.objects = {{{0, kOrange, Shading::Wireframe}, {1, {}, Shading::Wireframe}}};
    EXPECT_FALSE(draw().image == plain);
    frame_.look.objects = {};
    EXPECT_TRUE(draw().image == plain);
}

}  // namespace
}  // namespace eyrie
