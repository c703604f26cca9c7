// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_ground.h"

#include <gmock/gmock.h>

namespace eyrie::draw {
namespace {

TEST(TerrainGround, IsAsHighAndLowAsWhatOnlyFinerLevelsDraw) {
    terrain::EytIndex index;
    index.quadtree = terrain::Quadtree(257, 257);
    index.tiles.resize(index.quadtree.tileCount());
    const auto record = [&](const terrain::TileId& tile) -> terrain::TileRecord& {
        return index.tiles[index.quadtree.tileIndex(tile)];
    };
    const terrain::TileId top = index.quadtree.top();
    ASSERT_GE(top.level, 2);
    record(top) = {.minHeightMetres = -40, .maxHeightMetres = 300, .triangles = 2};
    // A rock between the samples of its level; beside it there is nothing, and below it the sea.
    record({top.level - 1, 0, 0}) = {.minHeightMetres = 0, .maxHeightMetres = 300};
    record({0, 0, 0}) = {.minHeightMetres = 0, .maxHeightMetres = 300, .triangles = 4};
    const fabric::GroundGrid grid = groundOf(index, fabric::Mat4(1.0), 4);
    ASSERT_EQ(grid.columns * grid.rows, 4);
    EXPECT_THAT(grid.highest, testing::ElementsAre(300, -40, -40, -40));
    EXPECT_THAT(grid.lowest, testing::ElementsAre(0, 300, 300, 300));
}

}  // namespace
}  // namespace eyrie::draw
