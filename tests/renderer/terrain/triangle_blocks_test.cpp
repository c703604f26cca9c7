// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/triangle_blocks.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "renderer/lod/view.h"
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

/// Lies anyhow in the world, far from its origin. The tiles may be those of other data.
EytIndex slantedIndex() {
    EytIndex index;
    index.quadtree = Quadtree(300, 290);
    index.objectFromLattice[0] = {10, 3, 0, 0};
    index.objectFromLattice[1] = {-2, 12, 0, 0};
    index.objectFromLattice[2][2] = 0.01;
    index.objectFromLattice[3] = {6.4e6, 5e5, 20, 1};
    return index;
}

/// Over the tile or beside it, near or far; narrow or wide.
lod::View randomView(const EytIndex& index, const TileId& tile, test::Random& random) {
    const auto place = [&](double q) {
        const double side = Quadtree::side(tile.level);
        return fabric::Vec3(index.objectFromLattice *
                            fabric::Vec4(side * 2 * random.unit(), side * 2 * random.unit(), q, 1));
    };
    fabric::Camera camera;
    camera.eye = place(200000 * random.unit());
    camera.target = place(0);
    camera.fovYDegrees = 5 + 100 * random.unit();
    return {camera, 640, 360};
}

fabric::PixelViewport randomPart(test::Random& random) {
    fabric::PixelViewport part{random.integer(0, 639), random.integer(0, 359), 0, 0};
    part.width = random.integer(1, 640 - part.x);
    part.height = random.integer(1, 360 - part.y);
    return part;
}

/// Whether a point (object space) is on a pixel of the channel: projected on its own.
bool isOn(const fabric::PixelViewport& channel, const lod::ObjectView& view,
          const fabric::Vec3& point) {
    const fabric::Vec3 p(view.viewFromObject() * fabric::Vec4(point, 1));
    if (-p.z < fabric::kNearMetres)
        return false;
    const lod::View& v = view.view();
    const double x = (p.x / -p.z - v.frustum.left) * v.focalPixels.x;
    const double y = (p.y / -p.z - v.frustum.bottom) * v.focalPixels.y;
    return x >= channel.x && x <= channel.x + channel.width && y >= channel.y &&
           y <= channel.y + channel.height;
}

/// So a channel that draws those alone misses no triangle.
TEST(TriangleBlocks, CoverPixelsOfEveryChannelThatAnyOfTheirTrianglesIsSeenIn) {
    const EytIndex index = slantedIndex();
    test::Random random(85);
    std::uint64_t leftOut = 0;
    std::uint64_t seen = 0;
    forEachTile([&](const TileGeometry& tile) {
        const int level = tile.cells == 32 ? 0 : tile.cells == 64 ? 1 : 2;
        const TileId id{level, 0, 0};
        const lod::ObjectView view(randomView(index, id, random), fabric::Mat4(1.0));
        const fabric::PixelViewport channel = randomPart(random);
        const auto corner = [&](std::uint32_t k) {
            const TileVertex v = unpackVertex(tile.words, tile.wordsPerVertex, tile.indices[k],
                                              tile.baseHeight, tile.heightMultiplier);
            return fabric::Vec3(index.objectFromLattice * fabric::Vec4(v.x / 2, v.y / 2, v.q, 1));
        };
        for (const TriangleBlock& block : triangleBlocks(tile)) {
            const bool isDrawn =
                !intersection(view.coveredPixels(bounds(index, id, block)), channel).isEmpty();
            leftOut += isDrawn ? 0 : block.count / 3;
            for (std::uint32_t k = block.first; k < block.first + block.count; k += 3) {
                const fabric::Vec3 a = corner(k);
                const fabric::Vec3 b = corner(k + 1);
                const fabric::Vec3 c = corner(k + 2);
                for (const fabric::Vec3& point :
                     {a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5, (a + b + c) / 3.0})
                    if (isOn(channel, view, point)) {
                        ++seen;
                        ASSERT_TRUE(isDrawn);
                    }
            }
        }
    });
    EXPECT_GT(leftOut, 10000U);
    EXPECT_GT(seen, 10000U);
}

TEST(TriangleBlocks, OfNothingAreNone) { EXPECT_TRUE(triangleBlocks({}).empty()); }

}  // namespace
}  // namespace eyrie::terrain
