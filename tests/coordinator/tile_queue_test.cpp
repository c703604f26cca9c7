// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tile_queue.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::equalizer {
namespace {

TEST(TileQueue, GoesToAndFro) {
    const TileQueue queue = TileQueue::ofPicture({100, 50, 10, 7}, 4, 4);
    ASSERT_EQ(queue.size(), 6);
    const std::vector<fabric::PixelViewport> expected = {{100, 50, 4, 4}, {104, 50, 4, 4},
                                                         {108, 50, 2, 4}, {108, 54, 2, 3},
                                                         {104, 54, 4, 3}, {100, 54, 4, 3}};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(queue.tile(static_cast<std::int64_t>(i)).pixelViewport, expected[i]);
}

TEST(TileQueue, CutsTheRangeIntoChunks) {
    const TileQueue queue = TileQueue::ofRange({0, 0, 10, 10}, {.5, 1}, .4);
    ASSERT_EQ(queue.size(), 3);
    EXPECT_EQ(queue.tile(0).range, (fabric::Range{.5, .7}));
    EXPECT_EQ(queue.tile(1).range, (fabric::Range{.7, .9}));
    EXPECT_EQ(queue.tile(2).range, (fabric::Range{.9, 1}));
}

TEST(TileQueue, IsBoundedHoweverSmallItsTiles) {
    EXPECT_EQ(TileQueue::ofPicture({0, 0, 16384, 16384}, 0, -3).size(), 16384LL * 16384);
    EXPECT_EQ(TileQueue::ofRange({0, 0, 1, 1}, {0, 1}, 1e-300).size(), TileQueue::kMostChunks);
    EXPECT_EQ(TileQueue::ofPicture({0, 0, 0, 9}, 4, 4).size(), 0);
}

RC_GTEST_PROP(TileQueue, HasEveryPixelInOneTile, ()) {
    const fabric::PixelViewport whole{*rc::gen::inRange(0, 50), 3, *rc::gen::inRange(1, 60),
                                      *rc::gen::inRange(1, 60)};
    const TileQueue queue =
        TileQueue::ofPicture(whole, *rc::gen::inRange(1, 30), *rc::gen::inRange(1, 30));
    std::vector<int> times(static_cast<std::size_t>(whole.area()), 0);
    for (std::int64_t i = 0; i < queue.size(); ++i) {
        const fabric::PixelViewport part = queue.tile(i).pixelViewport;
        RC_ASSERT(whole.contains(part) && !part.isEmpty());
        for (int y = part.y; y < part.y + part.height; ++y)
            for (int x = part.x; x < part.x + part.width; ++x)
                ++times[static_cast<std::size_t>((y - whole.y) * whole.width + x - whole.x)];
    }
    RC_ASSERT(std::ranges::count(times, 1) == whole.area());
}

}  // namespace
}  // namespace eyrie::equalizer
