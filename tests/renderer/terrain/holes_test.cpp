// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/holes.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::terrain {
namespace {

using fabric::Box;
using fabric::Vec2;
using fabric::Vec3;
using test::Random;

constexpr double kPartMetres = 8 * 30.0;

/// An index without a file, of posts 30 m apart; a share of `marked` parts has a hole.
EytIndex indexWithHoles(double marked, Random& random) {
    EytIndex index;
    index.quadtree = Quadtree(300, 200);
    index.nodataPosts = 1;
    index.objectFromLattice[0] = {30, 0, 0, 0};
    index.objectFromLattice[1] = {0, 30, 0, 0};
    index.tiles.resize(index.quadtree.tileCount());
    for (int level = 0; level < index.quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < index.quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < index.quadtree.tilesX(level); ++x) {
                TileRecord& tile = index.tiles[index.quadtree.tileIndex({level, x, y})];
                for (int part = 0; part < 16 && level == 0; ++part)
                    if (random.unit() < marked)
                        tile.nodataParts = static_cast<std::uint16_t>(tile.nodataParts | 1 << part);
                for (int i = 0; i < 4 && level > 0; ++i)
                    if (const TileId child = Quadtree::child({level, x, y}, i);
                        index.quadtree.contains(child))
                        tile.coverErrorsOf(i, index.tile(child));
            }
    return index;
}

bool isMarkedAt(const EytIndex& index, const Vec2& point) {
    const auto x = static_cast<std::int32_t>(point.x / kPartMetres);
    const auto y = static_cast<std::int32_t>(point.y / kPartMetres);
    return index.tile({0, x / 4, y / 4}).hasNodataIn(x % 4, y % 4, 1);
}

/// What the samples of lines from eye to target find nearer than the target.
bool isFoundBySampling(const EytIndex& index, const Vec2& eye, const Box& target) {
    const double nearest = glm::distance(eye, glm::clamp(eye, Vec2(target.min), Vec2(target.max)));
    constexpr int kAcross = 16, kAlong = 200;
    for (int v = 0; v <= kAcross; ++v)
        for (int u = 0; u <= kAcross; ++u) {
            const Vec2 to =
                Vec2(target.min) + Vec2(target.size()) * Vec2(u, v) / static_cast<double>(kAcross);
            for (int k = 0; k < kAlong; ++k) {
                const Vec2 at = eye + (to - eye) * (static_cast<double>(k) / kAlong);
                if (glm::distance(eye, at) < nearest && isMarkedAt(index, at))
                    return true;
            }
        }
    return false;
}

TEST(HoleBefore, IsWhatSamplingTheLinesOfSightFinds) {
    Random random(11);
    const auto point = [&] { return Vec2(random.unit() * 8000, random.unit() * 5900); };
    int found = 0, less = 0, clear = 0;
    for (int k = 0; k < 300; ++k) {
        const EytIndex index = indexWithHoles(k % 3 == 0 ? 0.1 : 0.01, random);
        const Vec2 eye = point();
        Box target;
        target.grow(Vec3(point(), 0));
        target.grow(target.min + Vec3(random.unit() * 900, random.unit() * 90, 50));
        const bool told = hasHoleBefore(index, eye, target);
        const bool sampled = isFoundBySampling(index, eye, target);
        EXPECT_TRUE(told || !sampled) << k;
        found += sampled ? 1 : 0;
        less += told && !sampled ? 1 : 0;
        clear += told ? 0 : 1;
    }
    EXPECT_GT(found, 50);
    EXPECT_GT(clear, 50);
    EXPECT_LT(less, 60) << "more is told than there is";
}

TEST(HoleBefore, IsNoneBehindTheEyeNorInOrBehindTheTarget) {
    Random random(1);
    EytIndex index = indexWithHoles(0, random);
    const auto mark = [&](std::int32_t part, std::uint16_t bits) {
        for (int level = 0; level < index.quadtree.levels(); ++level) {
            TileRecord& tile = index.tiles[index.quadtree.tileIndex({level, part >> level, 0})];
            tile.nodataParts = level == 0 ? bits : std::uint16_t{1};
        }
    };
    Box target;
    target.grow(Vec3(4700, 100, 0));
    target.grow(Vec3(5500, 200, 0));
    const Vec2 eye(2000, 100);
    mark(0, 1);  // behind the eye
    mark(5, 1);  // in the target
    mark(7, 1);  // behind it
    EXPECT_FALSE(hasHoleBefore(index, eye, target));
    mark(3, 1);  // from 2880 to 3120 m
    EXPECT_TRUE(hasHoleBefore(index, eye, target));
    EXPECT_TRUE(hasHoleBefore(index, eye, target, {}, 881));
    EXPECT_FALSE(hasHoleBefore(index, eye, target, {}, 879)) << "behind what covers the target";
    EXPECT_FALSE(hasHoleBefore(index, Vec2(3200, 100), target));

    mark(3, 1 << 12);  // from 720 m north: beside what one looks across
    EXPECT_FALSE(hasHoleBefore(index, eye, target));
    const std::uint32_t blurred[] = {index.quadtree.tileIndex({1, 1, 0})};
    EXPECT_TRUE(hasHoleBefore(index, eye, target, blurred)) << "a part of 480 m, drawn coarsely";
}

}  // namespace
}  // namespace eyrie::terrain
