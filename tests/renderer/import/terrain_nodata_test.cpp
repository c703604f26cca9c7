// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie {
namespace {

using terrain::HeightGrid;
using terrain::TileId;
using test::DrawnTriangle;
using test::GridKind;

using Hole = std::vector<std::pair<std::int32_t, std::int32_t>>;

HeightGrid gridWithHole(const Hole& hole) {
    HeightGrid grid = test::hardGrid(GridKind::Noise, 300, 140, 4);
    for (const auto& [i, j] : hole) grid.row(j)[i] = terrain::kNodata;
    return grid;
}

Hole rectangle(std::int32_t i0, std::int32_t j0, std::int32_t i1, std::int32_t j1) {
    Hole hole;
    for (std::int32_t j = j0; j <= j1; ++j)
        for (std::int32_t i = i0; i <= i1; ++i) hole.emplace_back(i, j);
    return hole;
}

Hole allButColumns(std::int32_t i0, std::int32_t i1) {
    Hole hole = rectangle(0, 0, i0 - 1, 139);
    const Hole right = rectangle(i1 + 1, 0, 299, 139);
    hole.insert(hole.end(), right.begin(), right.end());
    return hole;
}

std::vector<DrawnTriangle> drawnLevel(const terrain::EytFile& file, int level) {
    std::vector<DrawnTriangle> all;
    for (std::int32_t y = 0; y < file.index().quadtree.tilesY(level); ++y)
        for (std::int32_t x = 0; x < file.index().quadtree.tilesX(level); ++x) {
            const auto tile = test::drawnTile(file, {level, x, y}, 0);
            all.insert(all.end(), tile.begin(), tile.end());
        }
    return all;
}

/// Twice the area, in posts, of the half cells with data at all corners.
std::int64_t dataArea(const HeightGrid& grid) {
    std::int64_t halves = 0;
    const auto has = [&](std::int32_t i, std::int32_t j) { return !std::isnan(grid.at(i, j)); };
    for (std::int32_t j = 0; j + 1 < grid.rows; ++j)
        for (std::int32_t i = 0; i + 1 < grid.columns; ++i) {
            const bool a = has(i, j), b = has(i + 1, j), c = has(i, j + 1), d = has(i + 1, j + 1);
            const bool isMain = (i + j) % 2 == 0;
            halves += isMain ? (a && b && d) + (a && c && d) : (a && b && c) + (b && c && d);
        }
    return halves;
}

class TerrainNodata : public testing::TestWithParam<std::pair<const char*, Hole>> {};

TEST_P(TerrainNodata, IsAHoleAndNothingMoreAtFullResolution) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = gridWithHole(GetParam().second);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().nodataPosts, GetParam().second.size());
    for (const int level : {0, 1, 2}) {
        std::int64_t area = 0;
        for (const DrawnTriangle& triangle : drawnLevel(*file, level))
            area += test::doubleArea(triangle);
        EXPECT_EQ(area, dataArea(grid)) << "level " << level;
    }
    EXPECT_LE(file->index().finestErrorMetres(), file->index().heightStepMetres());
}

/// However wide what triangles of ground may leave out: an outline is no height.
TEST_P(TerrainNodata, IsAHoleAndNothingMoreAtTheFinestLevelWhateverItMayLeaveOut) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = gridWithHole(GetParam().second);
    const auto file = test::imported(grid, folder, {.errorMetres = 1000});
    ASSERT_NE(file, nullptr);
    std::int64_t area = 0;
    for (const DrawnTriangle& triangle : drawnLevel(*file, 0)) area += test::doubleArea(triangle);
    EXPECT_EQ(area, dataArea(grid));
    for (std::int32_t y = 0; y < file->index().quadtree.tilesY(0); ++y)
        for (std::int32_t x = 0; x < file->index().quadtree.tilesX(0); ++x)
            EXPECT_EQ(file->index().tile({0, x, y}).outlineMetres, 0) << x << " " << y;
}

TEST_P(TerrainNodata, IsNeverDrawnAsAHeight) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = gridWithHole(GetParam().second);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    for (int level = 0; level < file->index().quadtree.levels(); ++level)
        for (const DrawnTriangle& triangle : drawnLevel(*file, level))
            for (const test::DrawnCorner& corner : triangle)
                EXPECT_FALSE(std::isnan(grid.at(corner.i, corner.j)));
    EXPECT_GE(file->index().bounds().min.z, -0.1);
    EXPECT_LE(file->index().bounds().max.z, 100.1);
}

TEST_P(TerrainNodata, CountsAsErrorOfTheLevelsThatBlurIt) {
    const test::TemporaryFolder folder;
    const auto file = test::imported(gridWithHole(GetParam().second), folder);
    ASSERT_NE(file, nullptr);
    ASSERT_GE(file->index().quadtree.levels(), 4);
    const auto [i, j] = GetParam().second.front();
    const TileId coarse{3, std::min(i, 298) / terrain::Quadtree::side(3), 0};
    const double outlineMetres = file->index().tile(coarse).outlineMetres;
    if (i == 299 && GetParam().second.size() > 1)
        // Triangles are squeezed there, to one post: that column has no ground, nor is any drawn.
        EXPECT_EQ(outlineMetres, 0);
    else
        // Posts beside the hole, of 10 m, lie between a corner that is lost and the side that
        // stays.
        EXPECT_GE(outlineMetres, 10 / std::numbers::sqrt2);
}

/// Exactly those at the levels that draw every post.
TEST_P(TerrainNodata, IsMarkedInThePartsWhereItMeetsData) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = gridWithHole(GetParam().second);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    const terrain::Quadtree& quadtree = file->index().quadtree;
    for (std::uint32_t k = 0; k < quadtree.tileCount(); ++k) {
        const TileId id = quadtree.tileOf(k);
        const std::int32_t side = terrain::Quadtree::side(id.level);
        const std::int32_t cells = side / terrain::kTilePartsPerSide;
        for (int part = 0; part < 16; ++part) {
            bool hasData = false, hasNodata = false;
            const std::int32_t i0 = id.x * side + part % 4 * cells;
            const std::int32_t j0 = id.y * side + part / 4 * cells;
            for (std::int32_t j = j0; j <= std::min(j0 + cells, grid.rows - 1); ++j)
                for (std::int32_t i = i0; i <= std::min(i0 + cells, grid.columns - 1); ++i)
                    (std::isnan(grid.at(i, j)) ? hasNodata : hasData) = true;
            const bool isMarked = file->index().tile(id).hasNodataIn(part % 4, part / 4, 1);
            if (id.level < terrain::kFullResolutionLevels)
                EXPECT_EQ(isMarked, hasData && hasNodata) << id.level << " " << i0 << " " << j0;
            else
                EXPECT_TRUE(isMarked || !hasData || !hasNodata) << id.level << " " << i0;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Holes, TerrainNodata,
                         testing::Values(std::pair{"single", Hole{{77, 45}}},
                                         std::pair{"tileCorner", Hole{{128, 128}}},
                                         std::pair{"tileCentre", Hole{{64, 64}}},
                                         std::pair{"allButATilesBorder", rectangle(33, 33, 63, 63)},
                                         std::pair{"gridCorner", Hole{{299, 139}}},
                                         std::pair{"rowOnABorder", rectangle(0, 128, 299, 128)},
                                         std::pair{"columnOnABorder", rectangle(128, 0, 128, 139)},
                                         std::pair{"tiles", rectangle(30, 20, 180, 100)},
                                         std::pair{"allButAStrip", allButColumns(77, 78)},
                                         std::pair{"lastColumn", rectangle(299, 0, 299, 139)}),
                         [](const auto& tested) { return std::string(tested.param.first); });

TEST(TerrainNodata, LeavesTilesOutThatHoldNothingElse) {
    const test::TemporaryFolder folder;
    const auto file = test::imported(gridWithHole(rectangle(0, 0, 170, 139)), folder);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().tile({0, 0, 0}), terrain::TileRecord{});
    EXPECT_EQ(file->index().pages[0].bytes, 0U);
    EXPECT_TRUE(file->readPage(0).ok());
}

TEST(TerrainNodata, IsRefusedWhenThereIsNothingElse) {
    const test::TemporaryFolder folder;
    const Hole all = rectangle(0, 0, 299, 139);
    const auto nothing =
        import::importTerrain(gridWithHole(all), {"empty.tif", "", 0}, folder.path("a.eyt"), {});
    EXPECT_EQ(nothing.status().code(), absl::StatusCode::kInvalidArgument);

    HeightGrid lonely = gridWithHole(all);
    lonely.row(60)[60] = 5;
    const auto lone =
        import::importTerrain(lonely, {"lonely.tif", "", 0}, folder.path("a.eyt"), {});
    EXPECT_EQ(lone.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_TRUE(folder.files().empty());
}

}  // namespace
}  // namespace eyrie
