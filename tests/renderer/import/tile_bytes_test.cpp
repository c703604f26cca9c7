// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/tile_bytes.h"

#include <gtest/gtest.h>

#include "renderer/import/terrain_synth.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie::terrain {
namespace {

struct Sums {
    std::uint64_t actual = 0;
    std::uint64_t estimated = 0;
};

/// Checks every page of `file`.
Sums check(const EytFile& file) {
    const EytIndex& index = file.index();
    Sums sums;
    for (std::uint32_t number = 0; number < index.quadtree.pageCount(); ++number) {
        const auto page = file.readPage(number);
        EXPECT_TRUE(page.ok()) << page.status();
        EXPECT_LE((*page)->sizeBytes(), greatestPageBytes(index, number));
        const auto outlines = file.readPage(number, PageForm::Outlines);
        EXPECT_TRUE(outlines.ok()) << outlines.status();
        EXPECT_LE((*outlines)->sizeBytes(), greatestPageBytes(index, number));
        const TileId first = index.quadtree.firstTileOfPage(number);
        for (int place = 0; place < kPageTiles * kPageTiles; ++place) {
            const TileId tile{first.level, first.x + place % kPageTiles,
                              first.y + place / kPageTiles};
            if (!index.quadtree.contains(tile))
                continue;
            const std::uint64_t actual = tileBytes((*page)->tile(place));
            EXPECT_LE(actual, greatestTileBytes(index, tile));
            sums.actual += actual;
            sums.estimated += estimatedTileBytes(index, tile);
        }
    }
    return sums;
}

class TileBytes : public testing::TestWithParam<int> {};

TEST_P(TileBytes, AreNeverMoreThanTheGreatest) {
    const test::TemporaryFolder folder;
    const auto kind = static_cast<test::GridKind>(GetParam());
    const auto file = test::imported(test::hardGrid(kind, 290, 170, 3), folder);
    ASSERT_NE(file, nullptr);
    const Sums sums = check(*file);
    EXPECT_GE(sums.estimated, sums.actual) << test::name(kind);
}

INSTANTIATE_TEST_SUITE_P(HardGrids, TileBytes, testing::Range(0, test::kGridKinds));

TEST(TileBytes, OfMountainsAreForetoldWithinAQuarter) {
    const test::TemporaryFolder folder;
    const auto file = test::imported(import::synthesizeTerrain(1025, 7), folder);
    ASSERT_NE(file, nullptr);
    const Sums sums = check(*file);
    EXPECT_GE(sums.estimated, sums.actual);
    EXPECT_LE(4 * sums.estimated, 5 * sums.actual);
}

}  // namespace
}  // namespace eyrie::terrain
