// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "coordinator/composite/assemble_2d.h"
#include "coordinator/composite/assemble_db.h"
#include "coordinator/compound/decompose.h"
#include "layered_scene.h"

namespace eyrie::coordinator {
namespace {

constexpr int kWidth = 41;
constexpr int kHeight = 23;
constexpr fabric::PixelViewport kArea{0, 0, kWidth, kHeight};

std::vector<fabric::Image> drawn(const LayeredScene& scene, Decomposition decomposition,
                                 int renderers) {
    std::vector<fabric::Image> images;
    const fabric::ChannelTask whole{1, 1, kWidth, kHeight, kArea, {}, true};
    for (const fabric::ChannelTask& task :
         decompose(whole, decomposition, fabric::equalCuts(renderers)))
        images.push_back(scene.draw(task).image);
    return images;
}

RC_GTEST_PROP(Assemble2D, AnySplitGivesTheSingleImage, (std::uint32_t seed)) {
    const LayeredScene scene(seed);
    const int renderers = *rc::gen::inRange(1, 9);
    RC_ASSERT(assemble2D(kArea, LayeredScene::kBackground, true,
                         drawn(scene, Decomposition::TwoD, renderers)) ==
              scene.whole(kWidth, kHeight));
}

RC_GTEST_PROP(AssembleDb, AnySplitGivesTheSingleImageTiesIncluded, (std::uint32_t seed)) {
    const LayeredScene scene(seed);
    const int renderers = *rc::gen::inRange(1, 9);
    RC_ASSERT(
        assembleDb(kArea, LayeredScene::kBackground, drawn(scene, Decomposition::Db, renderers)) ==
        scene.whole(kWidth, kHeight));
}

TEST(AssembleDb, OfEqualDepthsTheFirstRangeWins) {
    fabric::Image first = fabric::makeImage({2, 2, 3, 3}, {1, 1, 1, 255}, true);
    fabric::Image second = fabric::makeImage(kArea, {2, 2, 2, 255}, true);
    first.depth.assign(first.depth.size(), 0.5F);
    second.depth.assign(second.depth.size(), 0.5F);
    const fabric::Image picture = assembleDb(kArea, {}, {first, second});
    EXPECT_EQ(picture.colour[2 * kWidth + 2].r, 1);
    EXPECT_EQ(picture.colour[0].r, 2);
}

TEST(AssembleDb, NothingDrawnIsBackground) {
    const fabric::Image empty{{5, 5, 0, 0}, {}, {}};
    EXPECT_EQ(assembleDb(kArea, {9, 8, 7, 255}, {empty, empty}),
              fabric::makeImage(kArea, {9, 8, 7, 255}, true));
}

TEST(Assemble2D, NothingDrawnIsBackground) {
    const fabric::Image empty{{5, 5, 0, 0}, {}, {}};
    EXPECT_EQ(assemble2D(kArea, {9, 8, 7, 255}, false, {empty, empty}),
              fabric::makeImage(kArea, {9, 8, 7, 255}, false));
}

TEST(Assemble2D, DepthThatNobodyWantsIsLeftOut) {
    const fabric::Image part = fabric::makeImage(kArea, {}, true);
    EXPECT_FALSE(assemble2D(kArea, {}, false, {part}).hasDepth());
    EXPECT_TRUE(assemble2D(kArea, {}, true, {part}).hasDepth());
}

}  // namespace
}  // namespace eyrie::coordinator
