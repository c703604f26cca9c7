// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/triangle_blocks.h"

#include <gtest/gtest.h>

#include "tests/renderer/terrain/sample_pages.h"

namespace eyrie::terrain {
namespace {

bool isWithin(const TileVertex& vertex, const TriangleBlock& block) {
    const auto between = [](std::int32_t low, std::int32_t value, std::int32_t high) {
        return low <= value && value <= high;
    };
    return between(block.low.x, vertex.x, block.high.x) &&
           between(block.low.y, vertex.y, block.high.y) &&
           between(block.low.q, vertex.q, block.high.q);
}

/// Calls `test` with every tile that has triangles, of rough terrain and of some with holes.
template <typename Test>
void forEachTile(const Test& test) {
    for (const double nodataShare : {0.0, 0.2})
        for (const test::SamplePage& sample : test::samplePages({.kind = test::GridKind::Noise,
                                              .columns = 300,
                                              .rows = 290,
                                              .stepMetres = 1.0 / 1024,
                                              .nodataShare = nodataShare})) {
            const auto page = Page::decode(sample.bytes, "page");
            ASSERT_TRUE(page.ok()) << page.status();
            for (int place = 0; place < kPageTiles * kPageTiles; ++place)
                if (!page->tile(place).isEmpty())
                    test(page->tile(place));
        }
}

TEST(TriangleBlocks, HoldEveryTriangleOnceInOrderAndAllOfItsCorners) {
    int tiles = 0;
    forEachTile([&](const TileGeometry& tile) {
        ++tiles;
        const std::vector<TriangleBlock> blocks = triangleBlocks(tile);
        std::uint32_t next = 0;
        for (const TriangleBlock& block : blocks) {
            ASSERT_EQ(block.first, next);
            ASSERT_GT(block.count, 0U);
            next += block.count;
            for (const std::uint16_t corner : tile.indices.subspan(block.first, block.count))
                ASSERT_TRUE(isWithin(unpackVertex(tile.words, tile.wordsPerVertex, corner,
                                                  tile.baseHeight, tile.heightMultiplier),
                                     block));
        }
        EXPECT_EQ(next, tile.indexCount());
        for (const IndexRange& part : tile.parts)
            for (const TriangleBlock& block : blocks)
                EXPECT_TRUE(block.first >= part.first + part.count ||
                            block.first + block.count <= part.first ||
                            (block.first >= part.first &&
                             block.first + block.count <= part.first + part.count))
                    << "it is of two parts";
    });
    EXPECT_GT(tiles, 10);
}

/// Were the triangles in no order, each block would be about as large as the tile.
TEST(TriangleBlocks, OfATileOfManyTrianglesAreSmall) {
    int tiles = 0;
    forEachTile([&](const TileGeometry& tile) {
        const IndexRange& interior = tile.parts[kInteriorPart];
        double area = 0;
        int count = 0;
        for (const TriangleBlock& block : triangleBlocks(tile))
            if (block.first < interior.first + interior.count) {
                area +=
                    static_cast<double>(block.high.x - block.low.x) * (block.high.y - block.low.y);
                ++count;
            }
        if (count < 16)
            return;
        ++tiles;
        EXPECT_LT(area, 3 * 4.0 * tile.cells * tile.cells) << count << " blocks";
    });
    EXPECT_GT(tiles, 0);
}

TEST(TriangleBlocks, OfNothingAreNone) { EXPECT_TRUE(triangleBlocks({}).empty()); }

}  // namespace
}  // namespace eyrie::terrain
