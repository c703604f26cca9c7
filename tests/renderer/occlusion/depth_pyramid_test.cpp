// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/depth_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/frustum.h"
#include "tests/renderer/lod/textbook.h"

namespace eyrie::occlusion {
namespace {

using fabric::PixelViewport;
using fabric::Vec3;
using test::Dice;

int whole(Dice& dice, int low, int high) { return static_cast<int>(dice.in(low, high + 0.999)); }

/// A picture of a few near and far rectangles, the later over the earlier, on an empty sky.
std::vector<float> picture(Dice& dice, const PixelViewport& area) {
    std::vector<float> depth(static_cast<std::size_t>(area.area()), 0.0F);
    for (int i = whole(dice, 0, 6); i > 0; --i) {
        const int x0 = whole(dice, 0, area.width - 1);
        const int y0 = whole(dice, 0, area.height - 1);
        const int x1 = i % 2 == 0 ? area.width : whole(dice, x0 + 1, area.width);
        const int y1 = i % 2 == 0 ? area.height : whole(dice, y0 + 1, area.height);
        const auto value = static_cast<float>(dice.in(0, 1));
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x)
                depth[static_cast<std::size_t>(y * area.width + x)] = value;
    }
    return depth;
}

/// The farthest of the pixels of `rect` in `area`, which are drawn bottom row first.
float farthest(const std::vector<float>& depth, const PixelViewport& area,
               const PixelViewport& rect) {
    float least = std::numeric_limits<float>::infinity();
    for (int y = std::max(rect.y, area.y); y < std::min(rect.y + rect.height, area.y + area.height);
         ++y)
        for (int x = std::max(rect.x, area.x);
             x < std::min(rect.x + rect.width, area.x + area.width); ++x)
            least = std::min(
                least, depth[static_cast<std::size_t>((y - area.y) * area.width + x - area.x)]);
    return least;
}

PixelViewport roundedToBlocks(const PixelViewport& rect, const PixelViewport& area) {
    const PixelViewport seen = intersection(rect, area);
    const auto down = [](int pixel) { return pixel / 8 * 8; };
    const int x0 = area.x + down(seen.x - area.x);
    const int y0 = area.y + down(seen.y - area.y);
    return {x0, y0, area.x + down(seen.x + seen.width - 1 - area.x) + 8 - x0,
            area.y + down(seen.y + seen.height - 1 - area.y) + 8 - y0};
}

RC_GTEST_PROP(DepthPyramid, HidesJustWhatEveryPixelOfTheTouchedBlocksIsNearerThan,
              (unsigned seed)) {
    Dice dice(seed);
    const PixelViewport area{whole(dice, 0, 40), whole(dice, 0, 40), whole(dice, 1, 90),
                             whole(dice, 1, 70)};
    const std::vector<float> depth = picture(dice, area);
    DepthPyramid pyramid;
    pyramid.build({0, 0, 9, 9}, std::vector<float>(81, 1.0F));  // is replaced
    pyramid.build(area, depth);
    RC_ASSERT(pyramid.area() == area);
    for (int i = 0; i < 30; ++i) {
        const PixelViewport rect{whole(dice, 0, 130), whole(dice, 0, 110), whole(dice, 0, 60),
                                 whole(dice, 0, 60)};
        const bool isInside = !intersection(rect, area).isEmpty();
        const float bound = isInside ? farthest(depth, area, roundedToBlocks(rect, area)) : 1.0F;
        for (const float value : {bound, std::nextafter(bound, 0.0F), std::nextafter(bound, 2.0F),
                                  static_cast<float>(dice.in(0, 1))}) {
            RC_ASSERT(pyramid.hides(rect, value) == (!isInside || bound > value));
            if (isInside && pyramid.hides(rect, value))
                RC_ASSERT(farthest(depth, area, rect) > value);
        }
    }
}

TEST(DepthPyramid, OfSkyHidesNothing) {
    DepthPyramid pyramid;
    pyramid.build({0, 0, 33, 17}, std::vector<float>(33 * 17, 0.0F));
    EXPECT_FALSE(pyramid.hides({4, 4, 1, 1}, 0.0F));
    EXPECT_FALSE(pyramid.hides({0, 0, 33, 17}, 1e-30F));
}

TEST(DepthPyramid, SeesThroughAHoleOfOnePixel) {
    std::vector<float> depth(100 * 100, 0.5F);
    depth[73 * 100 + 31] = 0.0F;
    DepthPyramid pyramid;
    pyramid.build({0, 0, 100, 100}, depth);
    EXPECT_FALSE(pyramid.hides({0, 0, 100, 100}, 0.1F));
    EXPECT_FALSE(pyramid.hides({31, 73, 1, 1}, 0.1F));
    EXPECT_TRUE(pyramid.hides({40, 0, 60, 100}, 0.1F));
    EXPECT_TRUE(pyramid.hides({0, 0, 100, 72}, 0.1F));
    EXPECT_FALSE(pyramid.hides({40, 0, 60, 100}, 0.5F)) << "what is as near may be drawn first";
}

TEST(DepthPyramid, OfNothingHidesWhatHasNoPixels) {
    DepthPyramid pyramid;
    EXPECT_TRUE(pyramid.hides({0, 0, 10, 10}, 1.0F));
    pyramid.build({}, {});
    EXPECT_TRUE(pyramid.hides({}, 1.0F));
}

/// A wall of one depth with random holes, and a box somewhere before, in or behind it.
RC_GTEST_PROP(IsHidden, OnlyWhatHasNoPointNearerThanThePixelItFallsOn, (unsigned seed)) {
    Dice dice(seed);
    const int width = 317;
    const int height = 203;
    fabric::Camera camera;
    camera.eye = dice.vector(50);
    camera.target = camera.eye + dice.direction();
    camera.fovYDegrees = dice.in(10, 120);
    if (!fabric::validate(camera).ok())
        return;
    const lod::View view(camera, width, height);
    const fabric::Mat4 worldFromObject = glm::rotate(
        glm::scale(glm::translate(fabric::Mat4(1.0),
                                  camera.eye + (camera.target - camera.eye) * dice.in(-2, 30) +
                                      dice.vector(5)),
                   Vec3(std::exp(dice.in(-3, 1)), std::exp(dice.in(-3, 1)), dice.in(-1, 1))),
        dice.in(0, 6), dice.direction());
    const lod::ObjectView objectView(view, worldFromObject);
    const fabric::Box box{Vec3(-1), Vec3(1)};

    const auto wall = static_cast<float>(fabric::kNearMetres / dice.in(0.1, 20));
    std::vector<float> depth(static_cast<std::size_t>(width * height), wall);
    for (int i = whole(dice, 0, 3); i > 0; --i)
        depth[static_cast<std::size_t>(whole(dice, 0, width * height - 1))] = 0;
    DepthPyramid pyramid;
    pyramid.build({0, 0, width, height}, depth);

    const bool hidden = isHidden(pyramid, objectView, box);
    RC_CLASSIFY(hidden);
    for (int i = 0; i < 200 && hidden; ++i) {
        const Vec3 world(worldFromObject *
                         fabric::Vec4(dice.in(-1, 1), dice.in(-1, 1), dice.in(-1, 1), 1));
        const auto at = test::project(camera, width, height, world);
        if (!test::inPicture(at, width, height) || at->x >= width || at->y >= height)
            continue;
        const double z = glm::dot(world - camera.eye, glm::normalize(camera.target - camera.eye));
        RC_ASSERT(depth[static_cast<std::size_t>(static_cast<int>(at->y) * width +
                                                 static_cast<int>(at->x))] >
                  fabric::kNearMetres / z);
    }
}

TEST(IsHidden, IsNothingThatReachesTheEye) {
    fabric::Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {1, 0, 0};
    const lod::ObjectView view(lod::View(camera, 64, 64), fabric::Mat4(1.0));
    DepthPyramid pyramid;
    pyramid.build({0, 0, 64, 64}, std::vector<float>(64 * 64, 1.0F));
    EXPECT_FALSE(isHidden(pyramid, view, {Vec3(-1), Vec3(1)}));
    EXPECT_FALSE(isHidden(pyramid, view, {{0, -1, -1}, {1, 1, 1}}));
    EXPECT_TRUE(isHidden(pyramid, view, {{1, -1, -1}, {2, 1, 1}}));
}

}  // namespace
}  // namespace eyrie::occlusion
