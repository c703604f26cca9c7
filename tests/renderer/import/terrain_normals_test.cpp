// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "renderer/import/terrain_import.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie {
namespace {

using terrain::HeightGrid;
using terrain::Quadtree;
using terrain::TileId;
using test::GridKind;

std::vector<std::int8_t> normalsOf(const terrain::EytFile& file, const TileId& id) {
    const auto page = file.readPage(file.index().quadtree.pageIndex(id));
    EXPECT_TRUE(page.ok()) << page.status();
    if (!page.ok())
        return {};
    const auto span = (*page)->tile(Quadtree::placeInPage(id)).normals;
    return {span.begin(), span.end()};
}

template <typename Visit>
void forEachTile(const Quadtree& quadtree, Visit visit) {
    for (int level = 0; level < quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree.tilesX(level); ++x) visit(TileId{level, x, y});
}

TEST(TerrainNormals, AgreeWhereTilesMeet) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = test::hardGrid(GridKind::Smooth, 300, 290, 2);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    const Quadtree& quadtree = file->index().quadtree;
    ASSERT_GE(quadtree.levels(), 5);
    for (int level = quadtree.normalLevel(); level + 1 < quadtree.levels(); ++level) {
        const auto samples = static_cast<std::size_t>(Quadtree::cells(level) + 1);
        const auto left = normalsOf(*file, {level, 0, 0});
        const auto right = normalsOf(*file, {level, 1, 0});
        ASSERT_EQ(left.size(), 2 * samples * samples);
        ASSERT_EQ(right.size(), left.size());
        for (std::size_t row = 0; row < samples; ++row)
            for (std::size_t k = 0; k < 2; ++k)
                EXPECT_EQ(left[2 * (row * samples + samples - 1) + k],
                          right[2 * row * samples + k]);
    }
}

TEST(TerrainNormals, PointAwayFromTheSlope) {
    const test::TemporaryFolder folder;
    HeightGrid grid = test::hardGrid(GridKind::Flat, 200, 140, 2);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i)
            grid.row(j)[i] = static_cast<float>(10 * i);  // 45 degrees up to the east
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    const auto normals = normalsOf(*file, {2, 0, 0});
    ASSERT_FALSE(normals.empty());
    for (std::size_t k = 0; k < normals.size(); k += 2) {
        EXPECT_EQ(normals[k], -90);  // -127 sin 45
        EXPECT_EQ(normals[k + 1], 0);
    }
}

TEST(TerrainNormals, AreStoredOnceForEveryPost) {
    for (const auto& [columns, rows] :
         {std::pair{2, 2}, {33, 33}, {34, 2}, {65, 60}, {66, 66}, {129, 40}, {300, 170}}) {
        const test::TemporaryFolder folder;
        const auto file = test::imported(test::hardGrid(GridKind::Noise, columns, rows, 3), folder);
        ASSERT_NE(file, nullptr);
        const Quadtree& quadtree = file->index().quadtree;
        EXPECT_EQ(quadtree.normalLevel(), std::min(2, quadtree.levels() - 1));
        forEachTile(quadtree, [&](const TileId& id) {
            const bool hasOwn = id.level >= quadtree.normalLevel();
            const auto samples = static_cast<std::size_t>(Quadtree::cells(id.level) + 1);
            EXPECT_EQ(file->index().hasNormals(id), hasOwn);
            EXPECT_EQ(normalsOf(*file, id).size(), hasOwn ? 2 * samples * samples : 0U);
            const TileId shared = quadtree.normalTile(id);
            EXPECT_TRUE(quadtree.contains(shared));
            EXPECT_EQ(shared.level, std::max(id.level, quadtree.normalLevel()));
            EXPECT_EQ(shared.x, id.x * Quadtree::side(id.level) / Quadtree::side(shared.level));
            EXPECT_EQ(shared.y, id.y * Quadtree::side(id.level) / Quadtree::side(shared.level));
        });
    }
}

/// Data that lie between the corners and the centre of a tile of level 2.
absl::StatusOr<std::shared_ptr<const terrain::EytFile>> patchOfOneFineTile(
    const test::TemporaryFolder& folder) {
    HeightGrid grid = test::hardGrid(GridKind::Smooth, 300, 290, 2);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i)
            if (std::min(i, j) < 32 || std::max(i, j) > 64 || i + j == 128)
                grid.row(j)[i] = terrain::kNodata;
    import::GridHeightSource posts(grid);
    import::TerrainImportOptions options;
    options.errorMetres = 1e6;  // leaves the outline of the data as it is
    const auto report =
        import::importTerrain(posts, {"grid", "", 0}, folder.path("patch.eyt"), options, {});
    if (!report.ok())
        return report.status();
    return terrain::EytFile::open(folder.path("patch.eyt"));
}

TEST(TerrainNormals, AreThereWhereOnlyFinerTilesAreDrawn) {
    const test::TemporaryFolder folder;
    const auto file = patchOfOneFineTile(folder);
    ASSERT_TRUE(file.ok()) << file.status();
    const terrain::EytIndex& index = (*file)->index();
    ASSERT_GT(index.tile({0, 1, 1}).triangles, 0U);
    ASSERT_EQ(index.tile({2, 0, 0}).triangles, 0U);
    EXPECT_TRUE(index.hasNormals({2, 0, 0}));
    EXPECT_FALSE(normalsOf(**file, {2, 0, 0}).empty());
    EXPECT_FALSE(index.hasNormals({2, 1, 1}));
    EXPECT_TRUE(normalsOf(**file, {2, 1, 1}).empty());
}

}  // namespace
}  // namespace eyrie
