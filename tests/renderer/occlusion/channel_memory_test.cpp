// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/channel_memory.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace eyrie::occlusion {
namespace {

using fabric::Box;
using fabric::PixelViewport;
using fabric::Vec3;

constexpr PixelViewport kAll{0, 0, 160, 120};

lod::View lookingAlong(double azimuth, const Vec3& eye = Vec3(0)) {
    fabric::Camera camera;
    camera.eye = eye;
    camera.target = eye + Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    camera.fovYDegrees = 60;
    return {camera, kAll.width, kAll.height};
}

bool isSame(ChannelMemories& memories, const lod::View& view, const fabric::Range& range,
            const PixelViewport& part) {
    const bool isNew = !memories.of(view, range, part).isFresh;
    memories.of(view, range, part).isFresh = true;
    return !isNew;
}

TEST(ChannelMemories, AreKeptWhileTheViewMovesOnAndShares) {
    ChannelMemories memories;
    EXPECT_FALSE(isSame(memories, lookingAlong(0), {}, kAll));
    EXPECT_TRUE(isSame(memories, lookingAlong(0.3, Vec3(10)), {}, kAll)) << "a step, a turn";
    EXPECT_TRUE(isSame(memories, lookingAlong(0), {0, 0.7}, kAll)) << "load is balanced";
    EXPECT_TRUE(isSame(memories, lookingAlong(0), {0, 0.7}, {0, 0, 100, 120}));
}

TEST(ChannelMemories, AreApartForOtherChannelsAndAfterAHardCut) {
    ChannelMemories memories;
    EXPECT_FALSE(isSame(memories, lookingAlong(0), {0, 0.5}, kAll));
    EXPECT_FALSE(isSame(memories, lookingAlong(0), {0.5, 1}, kAll));
    EXPECT_FALSE(isSame(memories, lookingAlong(0), {0, 0.5}, {0, 0, 70, 120}));
    EXPECT_FALSE(isSame(memories, lookingAlong(3), {0, 0.5}, kAll));
    EXPECT_TRUE(isSame(memories, lookingAlong(0), {0.5, 1}, kAll)) << "none took another's place";
    memories.clear();
    EXPECT_FALSE(isSame(memories, lookingAlong(0), {0.5, 1}, kAll));
}

TEST(ChannelMemories, AreApartForTilesOfOneWall) {
    lod::View left = lookingAlong(0);
    lod::View right = left;
    left.frustum = {-1, 0, -0.5, 0.5};
    right.frustum = {0, 1, -0.5, 0.5};
    lod::View moved = left;
    moved.frustum = {-0.8, 0.2, -0.5, 0.5};
    ChannelMemories memories;
    EXPECT_FALSE(isSame(memories, left, {}, kAll));
    EXPECT_FALSE(isSame(memories, right, {}, kAll));
    EXPECT_TRUE(isSame(memories, left, {}, kAll));
    EXPECT_TRUE(isSame(memories, moved, {}, kAll)) << "a head that moves";
}

/// A wall 10 m before the eye, which ends on the right 100 of 160 pixels from the left.
ChannelMemory wall() {
    std::vector<float> depth(static_cast<std::size_t>(kAll.area()), 0);
    for (std::size_t i = 0; i < depth.size(); ++i)
        depth[i] = i % 160 < 100 ? static_cast<float>(fabric::kNearMetres / 10) : 0;
    ChannelMemory memory{lookingAlong(0), {}, true, {}};
    memory.pyramid.build(kAll, depth);
    return memory;
}

bool expectsHidden(const ChannelMemory& memory, const std::vector<Box>& boxes,
                   const PixelViewport& part = kAll) {
    return memory.expectsHidden(lod::ObjectView(memory.view, fabric::Mat4(1.0)), boxes, part);
}

TEST(ChannelMemory, ExpectsWhatWasHiddenWithPixelsToSpareToStayHidden) {
    // At 100 m a pixel is 0.96 m wide; y grows to the left, pixel 80 is 0.
    const auto boxTo = [](double right) { return Box{{100, right, -5}, {105, 40, 5}}; };
    const ChannelMemory memory = wall();
    EXPECT_TRUE(expectsHidden(memory, {boxTo(0)}));
    EXPECT_FALSE(expectsHidden(memory, {boxTo(-15)})) << "hidden, but for how long";
    EXPECT_FALSE(expectsHidden(memory, {boxTo(-30)}));
    EXPECT_FALSE(expectsHidden(memory, {Box{{5, 0, -1}, {9, 1, 1}}})) << "before the wall";
    EXPECT_FALSE(expectsHidden(memory, {boxTo(0), boxTo(-30)})) << "a part is seen";
}

TEST(ChannelMemory, ExpectsNothingOfWhatItDoesNotKnow) {
    const Box hidden{{100, 0, -5}, {105, 40, 5}};
    const Box outside{{100, 200, -5}, {105, 220, 5}};
    ChannelMemory memory = wall();
    EXPECT_FALSE(expectsHidden(memory, {outside}));
    EXPECT_TRUE(expectsHidden(memory, {hidden, outside})) << "a part of it was hidden";
    EXPECT_FALSE(expectsHidden(memory, {hidden}, {100, 0, 60, 120})) << "not in this part";
    memory.pyramid.build({60, 0, 40, 120}, std::vector<float>(40 * 120, 1.0F));
    EXPECT_FALSE(expectsHidden(memory, {hidden})) << "not all of it was looked at";
    memory = wall();
    memory.isFresh = false;
    EXPECT_FALSE(expectsHidden(memory, {hidden}));
}

}  // namespace
}  // namespace eyrie::occlusion
