// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/quadtree.h"

#include <algorithm>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace eyrie::terrain {
namespace {

TEST(Quadtree, HasOneTileOnTopThatCoversTheGrid) {
    const std::pair<std::uint32_t, std::uint32_t> sizes[] = {
        {2, 2}, {3, 3}, {33, 33}, {34, 33}, {128, 129}, {130, 2}, {4097, 33}, {4096, 4096}};
    for (const auto& [columns, rows] : sizes) {
        const Quadtree quadtree(columns, rows);
        const int top = quadtree.top().level;
        EXPECT_EQ(quadtree.tilesX(top) * quadtree.tilesY(top), 1);
        EXPECT_GE(Quadtree::side(top), static_cast<std::int32_t>(std::max(columns, rows)) - 1);
        if (top > 0) {
            EXPECT_LT(Quadtree::side(top - 1),
                      static_cast<std::int32_t>(std::max(columns, rows)) - 1);
        }
    }
}

TEST(Quadtree, HasNoTileWithoutACellAndNoCellWithoutATile) {
    for (std::uint32_t posts = 2; posts < 300; ++posts) {
        const Quadtree quadtree(posts, 2);
        for (int level = 0; level < quadtree.levels(); ++level) {
            const std::int32_t side = Quadtree::side(level);
            const std::int32_t tiles = quadtree.tilesX(level);
            EXPECT_LT((tiles - 1) * side, static_cast<std::int32_t>(posts) - 1);
            EXPECT_GE(tiles * side, static_cast<std::int32_t>(posts) - 1);
        }
    }
}

TEST(Quadtree, NumbersTilesAndPagesWithoutGapOrRepeat) {
    const Quadtree quadtree(700, 410);
    std::set<std::uint32_t> tiles;
    std::set<std::pair<std::uint32_t, int>> places;
    for (int level = 0; level < quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree.tilesX(level); ++x) {
                const TileId tile{level, x, y};
                EXPECT_TRUE(quadtree.contains(tile));
                EXPECT_LT(quadtree.pageIndex(tile), quadtree.pageCount());
                tiles.insert(quadtree.tileIndex(tile));
                places.insert({quadtree.pageIndex(tile), Quadtree::placeInPage(tile)});
            }
    EXPECT_EQ(tiles.size(), quadtree.tileCount());
    EXPECT_EQ(*tiles.rbegin(), quadtree.tileCount() - 1);
    EXPECT_EQ(places.size(), quadtree.tileCount());
}

TEST(Quadtree, FindsTheFirstTileOfEveryPage) {
    const Quadtree quadtree(700, 410);
    for (std::uint32_t page = 0; page < quadtree.pageCount(); ++page) {
        const TileId first = quadtree.firstTileOfPage(page);
        EXPECT_TRUE(quadtree.contains(first));
        EXPECT_EQ(quadtree.pageIndex(first), page);
        EXPECT_EQ(Quadtree::placeInPage(first), 0);
    }
}

TEST(Quadtree, ParentsHoldTheirChildren) {
    const TileId tile{3, 5, 2};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(Quadtree::parent(Quadtree::child(tile, i)), tile);
    EXPECT_EQ(Quadtree::neighbour(Quadtree::neighbour(tile, kEdgeMinX), kEdgeMaxX), tile);
    EXPECT_EQ(Quadtree::neighbour(Quadtree::neighbour(tile, kEdgeMinY), kEdgeMaxY), tile);
}

TEST(Quadtree, KeepsTileCoordinatesInTenBits) {
    for (int level = 0; level < 18; ++level) {
        EXPECT_LE(Quadtree::cells(level), kMaxTileCells);
        EXPECT_EQ(Quadtree::cells(level) << Quadtree::spacingShift(level), Quadtree::side(level));
    }
}

}  // namespace
}  // namespace eyrie::terrain
