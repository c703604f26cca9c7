// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tile_queue.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::equalizer {
namespace {

TEST(TileQueue, GoesToAndFro) {
    TileQueue queue = TileQueue::ofPicture({100, 50, 10, 7}, 4, 4);
    ASSERT_EQ(queue.size(), 6);
    const std::vector<fabric::PixelViewport> expected = {{100, 50, 4, 4}, {104, 50, 4, 4},
                                                         {108, 50, 2, 4}, {108, 54, 2, 3},
                                                         {104, 54, 4, 3}, {100, 54, 4, 3}};
    for (const fabric::PixelViewport& tile : expected)
        EXPECT_EQ(queue.next(0)->pixelViewport, tile);
    EXPECT_FALSE(queue.next(0));
}

TEST(TileQueue, CutsTheRangeIntoChunks) {
    TileQueue queue = TileQueue::ofRange({0, 0, 10, 10}, {.5, 1}, .4);
    EXPECT_EQ(queue.next(0)->range, (fabric::Range{.5, .7}));
    EXPECT_EQ(queue.next(1)->range, (fabric::Range{.7, .9}));
    EXPECT_EQ(queue.next(2)->range, (fabric::Range{.9, 1}));
    EXPECT_FALSE(queue.next(0));
}

TEST(TileQueue, IsBoundedHoweverSmallItsTiles) {
    EXPECT_EQ(TileQueue::ofPicture({0, 0, 16384, 16384}, 0, -3).size(), 16384LL * 16384);
    EXPECT_EQ(TileQueue::ofRange({0, 0, 1, 1}, {0, 1}, 1e-300).size(), TileQueue::kMostChunks);
    EXPECT_TRUE(TileQueue::ofPicture({0, 0, 0, 9}, 4, 4).isDone());
}

/// Clients ask, draw and vanish in any order.
RC_GTEST_PROP(TileQueue, HasEveryTileDrawnOnceWhoeverGoes, ()) {
    const fabric::PixelViewport whole{*rc::gen::inRange(0, 50), 3, *rc::gen::inRange(1, 60),
                                      *rc::gen::inRange(1, 60)};
    TileQueue queue =
        TileQueue::ofPicture(whole, *rc::gen::inRange(5, 30), *rc::gen::inRange(5, 30));
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    std::vector<std::vector<Tile>> hands(3);
    std::int64_t area = 0;
    std::int64_t drawn = 0;
    const auto draw = [&](std::size_t client) {
        const Tile tile = hands[client].back();
        hands[client].pop_back();
        RC_ASSERT(whole.contains(tile.pixelViewport));
        RC_ASSERT(queue.finish(tile.index));
        RC_ASSERT(!queue.finish(tile.index));
        area += tile.pixelViewport.area();
        ++drawn;
    };
    while (!queue.isDone()) {
        const std::size_t client = random() % 3;
        if (random() % 16 == 0) {
            queue.giveBack(static_cast<int>(client));
            hands[client].clear();
        }
        if (hands[client].size() < TileQueue::kAhead)
            if (const auto tile = queue.next(static_cast<int>(client)))
                hands[client].push_back(*tile);
        if (!hands[client].empty() && random() % 2 == 0)
            draw(client);
    }
    RC_ASSERT(drawn == queue.size());
    RC_ASSERT(area == whole.area());
}

}  // namespace
}  // namespace eyrie::equalizer
