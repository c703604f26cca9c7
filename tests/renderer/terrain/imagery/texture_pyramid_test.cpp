// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/texture_pyramid.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/terrain/quadtree.h"

namespace eyrie::terrain {
namespace {

TexturePyramid somePyramid() {
    const auto columns = *rc::gen::inRange<std::int32_t>(2, 5000);
    const auto rows = *rc::gen::inRange<std::int32_t>(2, 5000);
    const int shift = *rc::gen::inRange(kMinTexelShift, 5);
    RC_PRE(TexturePyramid::isPossible(columns, rows, shift));
    return {columns, rows, shift};
}

RC_GTEST_PROP(TexturePyramid, CountsItsTilesWithoutGapOrRepeat, ()) {
    const TexturePyramid pyramid = somePyramid();
    std::uint32_t next = 0;
    for (int level = 0; level < pyramid.levels(); ++level)
        for (std::int32_t y = 0; y < pyramid.tilesY(level); ++y)
            for (std::int32_t x = 0; x < pyramid.tilesX(level); ++x) {
                const TextureId tile{level, x, y};
                RC_ASSERT(pyramid.tileIndex(tile) == next);
                RC_ASSERT(pyramid.tileOf(next) == tile);
                RC_ASSERT(pyramid.contains(tile));
                ++next;
            }
    RC_ASSERT(pyramid.tileCount() == next);
    RC_ASSERT(pyramid.tilesX(pyramid.levels() - 1) == 1);
    RC_ASSERT(pyramid.tilesY(pyramid.levels() - 1) == 1);
}

RC_GTEST_PROP(TexturePyramid, HasEveryTilesParent, ()) {
    const TexturePyramid pyramid = somePyramid();
    const TextureId tile = pyramid.tileOf(*rc::gen::inRange(0U, pyramid.tileCount()));
    if (tile != pyramid.top())
        RC_ASSERT(pyramid.contains(TexturePyramid::parent(tile)));
}

RC_GTEST_PROP(TexturePyramid, CoversTheGridAndHardlyMore, ()) {
    const auto columns = *rc::gen::inRange<std::int32_t>(2, 5000);
    const int shift = *rc::gen::inRange(kMinTexelShift, 5);
    RC_PRE(TexturePyramid::isPossible(columns, 2, shift));
    const TexturePyramid pyramid(columns, 2, shift);
    for (int level = 0; level < pyramid.levels(); ++level) {
        const double covered =
            static_cast<double>(pyramid.width(level)) * pyramid.texelPosts(level);
        RC_ASSERT(covered >= columns - 1);
        RC_ASSERT(covered < columns - 1 + 2 * pyramid.texelPosts(level));
    }
}

TEST(TexturePyramid, NestsWithTilesOfPosts) {
    for (int shift = -6; shift <= 6; ++shift) {
        const TexturePyramid pyramid(4097, 4097, shift);
        for (int level = 0; level < pyramid.levels(); ++level)
            for (int posts = 0; posts < 8; ++posts) {
                const double ratio = pyramid.sidePosts(level) / Quadtree::side(posts);
                EXPECT_EQ(std::exp2(std::round(std::log2(ratio))), ratio) << shift;
            }
    }
}

TEST(TexturePyramid, StoresFourThirdsOfItsFinestLevel) {
    const TexturePyramid pyramid(16385, 16385, 0);
    double texels = 0;
    for (std::uint32_t k = 0; k < pyramid.tileCount(); ++k) {
        const TexelRect rect = pyramid.texels(pyramid.tileOf(k));
        texels += double{1} * rect.columns * rect.rows;
    }
    const double finest = double{16384} * 16384;
    EXPECT_LT(texels / finest, 4.0 / 3 * 1.04) << "and a block's width of border";
    EXPECT_GT(texels / finest, 4.0 / 3);
}

TEST(TexturePyramid, HasNoMoreBlocksAtTheEdgeThanItNeeds) {
    const TexturePyramid pyramid(514, 515, 0);  // 513 x 514 texels
    EXPECT_EQ(pyramid.blocksX({0, 0, 0}), 130);
    EXPECT_EQ(pyramid.blocksX({0, 1, 0}), 3) << "one texel and two borders";
    EXPECT_EQ(pyramid.blocksY({0, 0, 1}), 3);
    EXPECT_EQ(pyramid.blocksX({1, 0, 0}), 67) << "257 texels";
}

TEST(TexturePyramid, RefusesWhatWouldNotFit) {
    EXPECT_FALSE(TexturePyramid::isPossible(2, 2, kMaxTexelShift + 1));
    EXPECT_FALSE(TexturePyramid::isPossible(2, 2, kMinTexelShift - 1));
    EXPECT_FALSE(TexturePyramid::isPossible(1, 2, 0));
    EXPECT_FALSE(TexturePyramid::isPossible(-5, 2, 0));
    EXPECT_FALSE(TexturePyramid::isPossible(kMaxPosts, kMaxPosts, 6));
    EXPECT_FALSE(TexturePyramid::isPossible(kMaxPosts, 2, kMaxTexelShift));
    EXPECT_TRUE(TexturePyramid::isPossible(kMaxPosts, kMaxPosts, kMinTexelShift));
    EXPECT_EQ(TexturePyramid(kMaxPosts, kMaxPosts, kMinTexelShift).width(0), 1);
}

}  // namespace
}  // namespace eyrie::terrain
