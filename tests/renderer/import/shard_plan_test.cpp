// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/shard_plan.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/terrain/tiled_raster.h"

namespace eyrie::import {
namespace {

using terrain::Quadtree;

Quadtree anyQuadtree() {
    const auto side = [] { return static_cast<std::uint32_t>(*rc::gen::inRange(2, 5000)); };
    const std::uint32_t columns = side();
    return Quadtree(columns, side());
}

RC_GTEST_PROP(ShardPlan, GivesEachTileAndFinePageToOneShard, ()) {
    const Quadtree quadtree = anyQuadtree();
    const auto shards = static_cast<std::uint32_t>(*rc::gen::inRange(1, 40));
    const ShardPlan plan(quadtree, shards);
    std::multiset<std::uint32_t> tiles;
    std::multiset<std::uint32_t> pages;
    for (std::uint32_t k = 0; k < shards; ++k) {
        for (const std::uint32_t tile : plan.tilesOf(k)) {
            tiles.insert(tile);
            const auto number = static_cast<std::int32_t>(tile);
            RC_ASSERT(plan.ownerOfTile(number % plan.tilesX(), number / plan.tilesX()) == k);
        }
        for (const std::uint32_t page : plan.pagesOf(k)) {
            pages.insert(page);
            RC_ASSERT(plan.ownerOfPage(page) == k);
        }
    }
    RC_ASSERT(tiles.size() ==
              static_cast<std::size_t>(plan.tilesX()) * static_cast<std::size_t>(plan.tilesY()));
    RC_ASSERT(std::set(tiles.begin(), tiles.end()).size() == tiles.size());
    for (std::uint32_t page = 0; page < quadtree.pageCount(); ++page) {
        const bool isFine = quadtree.firstTileOfPage(page).level < ShardPlan::kLevels;
        RC_ASSERT(plan.hasOwner(page) == isFine);
        RC_ASSERT(pages.count(page) == (isFine ? 1U : 0U));
    }
}

/// The raster tiles under a shard's pages are its own: nobody else has to have their heights.
RC_GTEST_PROP(ShardPlan, GivesAPageToTheOwnerOfItsPosts, ()) {
    const Quadtree quadtree = anyQuadtree();
    const ShardPlan plan(quadtree, static_cast<std::uint32_t>(*rc::gen::inRange(1, 40)));
    for (std::uint32_t page = 0; page < quadtree.pageCount() && plan.hasOwner(page); ++page) {
        const terrain::TileId first = quadtree.firstTileOfPage(page);
        const std::int32_t side = Quadtree::side(first.level);
        for (std::int32_t k = 0; k < terrain::kPageTiles; ++k) {
            const terrain::TileId tile{first.level, first.x + k, first.y + k};
            if (quadtree.contains(tile))
                RC_ASSERT(plan.ownerOfTile(tile.x * side / terrain::kRasterTileCells,
                                           tile.y * side / terrain::kRasterTileCells) ==
                          plan.ownerOfPage(page));
        }
    }
}

RC_GTEST_PROP(ShardPlan, KnowsAllTilesBesideAShardsOwn, ()) {
    const ShardPlan plan(anyQuadtree(), static_cast<std::uint32_t>(*rc::gen::inRange(1, 12)));
    const std::int32_t x = *rc::gen::inRange(0, plan.tilesX());
    const std::int32_t y = *rc::gen::inRange(0, plan.tilesY());
    std::set<std::uint32_t> near;
    for (std::int32_t v = std::max(0, y - 1); v <= std::min(y + 1, plan.tilesY() - 1); ++v)
        for (std::int32_t u = std::max(0, x - 1); u <= std::min(x + 1, plan.tilesX() - 1); ++u)
            near.insert(plan.ownerOfTile(u, v));
    for (std::uint32_t k = 0; k < 12; ++k) RC_ASSERT(plan.isNear(k, x, y) == near.contains(k));
}

RC_GTEST_PROP(ShardPlan, SharesOutTexturesEvenly, ()) {
    const auto shards = static_cast<std::uint32_t>(*rc::gen::inRange(1, 40));
    const auto textures = static_cast<std::uint32_t>(*rc::gen::inRange(0, 400));
    const ShardPlan plan(Quadtree(100, 100), shards, textures);
    std::uint32_t next = 0;
    for (std::uint32_t k = 0; k < shards; ++k) {
        const std::vector<std::uint32_t> own = plan.texturesOf(k);
        RC_ASSERT(own.size() == textures / shards || own.size() == textures / shards + 1);
        for (const std::uint32_t texture : own) RC_ASSERT(texture == next++);
    }
    RC_ASSERT(next == textures);
}

TEST(ShardPlan, SharesOutEvenly) {
    const ShardPlan plan(Quadtree(8193, 8193), 5);  // 16 x 16 squares of 16 tiles
    std::vector<std::size_t> tiles;
    for (std::uint32_t k = 0; k < 5; ++k) tiles.push_back(plan.tilesOf(k).size());
    const auto [least, most] = std::minmax_element(tiles.begin(), tiles.end());
    EXPECT_LE(*most - *least, 16U);
}

}  // namespace
}  // namespace eyrie::import
