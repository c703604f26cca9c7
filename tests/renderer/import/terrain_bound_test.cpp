// SPDX-License-Identifier: Apache-2.0
// The promise of every tile, checked on what was written: no point of any form of it is farther
// from the source, however that is read between its posts, than the error in the index.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/renderer/terrain/reference_surface.h"

namespace eyrie {
namespace {

using terrain::HeightGrid;
using terrain::TileId;
using test::DrawnTriangle;
using test::GridKind;

constexpr int kSamplesPerPost = 8;
constexpr double kToleranceMetres = 10.0 / 2048;

template <typename Visit>
void forEachTile(const terrain::Quadtree& quadtree, Visit visit) {
    for (int level = 0; level < quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x < quadtree.tilesX(level); ++x) visit(TileId{level, x, y});
}

/// Posts that lie on the drawn surface, were its corners not quantised, to within 1/2048 of a post.
/// A cell of four such posts is drawn as one of its readings, which one nobody can tell.
class ExactPosts {
public:
    ExactPosts(const HeightGrid& grid, const std::vector<DrawnTriangle>& triangles)
        : columns_(grid.columns), isExact_(grid.heights.size(), 1) {
        for (const DrawnTriangle& t : triangles) {
            terrain::Triangle unquantised;
            for (std::size_t k = 0; k < 3; ++k)
                unquantised[k] = {t[k].i, t[k].j, grid.at(t[k].i, t[k].j)};
            test::forEachSample(unquantised, 1, [&](double x, double y, double drawn) {
                const auto i = static_cast<std::int32_t>(x), j = static_cast<std::int32_t>(y);
                if (std::abs(drawn - static_cast<double>(grid.at(i, j))) > kToleranceMetres)
                    isExact_[static_cast<std::size_t>(j * columns_ + i)] = 0;
            });
        }
    }
    bool isExact(std::int32_t i, std::int32_t j) const {
        return isExact_[static_cast<std::size_t>(j * columns_ + i)] != 0;
    }
    bool isCellExact(const HeightGrid& grid, double x, double y) const {
        const auto i = std::min(static_cast<std::int32_t>(x), grid.columns - 2);
        const auto j = std::min(static_cast<std::int32_t>(y), grid.rows - 2);
        return isExact(i, j) && isExact(i + 1, j) && isExact(i, j + 1) && isExact(i + 1, j + 1);
    }

private:
    std::int32_t columns_;
    std::vector<char> isExact_;
};

/// By TileRecord's parts, row by row.
using PartDeviations = std::array<double, terrain::kTilePartsPerSide * terrain::kTilePartsPerSide>;

PartDeviations measuredDeviations(const terrain::EytFile& file, const HeightGrid& grid,
                                  const TileId& id, const std::vector<DrawnTriangle>& triangles) {
    const ExactPosts posts(grid, triangles);
    PartDeviations worst{};
    const std::int32_t side = terrain::Quadtree::side(id.level);
    const auto part = [&](double post, std::int32_t tile) {
        const double at = (post - tile * side) * terrain::kTilePartsPerSide / side;
        return std::min(static_cast<std::size_t>(at), std::size_t{terrain::kTilePartsPerSide - 1});
    };
    for (const DrawnTriangle& triangle : triangles)
        test::forEachSample(
            test::inMetres(file, triangle), kSamplesPerPost, [&](double x, double y, double drawn) {
                double nearest = std::numeric_limits<double>::infinity();
                double farthest = 0;
                for (const double source : test::readings(grid, x, y)) {
                    nearest = std::min(nearest, std::abs(drawn - source));
                    farthest = std::max(farthest, std::abs(drawn - source));
                }
                if (std::isinf(nearest))
                    return;  // beside a hole: of a cell without a source
                double& most = worst[part(y, id.y) * terrain::kTilePartsPerSide + part(x, id.x)];
                most = std::max(most, posts.isCellExact(grid, x, y) ? nearest : farthest);
            });
    return worst;
}

struct Case {
    GridKind kind;
    std::int32_t columns;
    std::int32_t rows;
};

class TerrainBound : public testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        grid_ = test::hardGrid(GetParam().kind, GetParam().columns, GetParam().rows, 7);
        file_ = test::imported(grid_, folder_);
        ASSERT_NE(file_, nullptr);
    }

    test::TemporaryFolder folder_;
    HeightGrid grid_;
    std::shared_ptr<const terrain::EytFile> file_;
};

TEST_P(TerrainBound, HoldsForEveryFormOfEveryTile) {
    forEachTile(file_->index().quadtree, [&](const TileId& id) {
        const double promised = file_->index().tile(id).errorMetres;
        for (const int finerEdges : {0, 15, 5}) {
            if (id.level == 0 && finerEdges != 0)
                continue;
            std::uint8_t edges = 0;
            for (int edge = 0; edge < terrain::kEdges; ++edge)
                if (file_->index().quadtree.contains(terrain::Quadtree::neighbour(id, edge)))
                    edges = static_cast<std::uint8_t>(edges | (finerEdges & 1 << edge));
            const PartDeviations measured =
                measuredDeviations(*file_, grid_, id, test::drawnTile(*file_, id, edges));
            for (int part = 0; part < static_cast<int>(measured.size()); ++part) {
                const double ofPart = file_->index().tile(id).errorMetresOf(part % 4, part / 4, 1);
                EXPECT_LE(ofPart, promised);
                EXPECT_LE(measured[static_cast<std::size_t>(part)], ofPart * (1 + 1e-6) + 1e-6)
                    << "tile " << id.level << " " << id.x << " " << id.y << " part " << part
                    << " edges " << int{edges};
            }
        }
    });
}

TEST_P(TerrainBound, IsNotBelowThatOfTheTilesUnderIt) {
    const terrain::EytIndex& index = file_->index();
    forEachTile(index.quadtree, [&](const TileId& id) {
        if (id == index.quadtree.top())
            return;
        const terrain::TileRecord& parent = index.tile(terrain::Quadtree::parent(id));
        EXPECT_GE(parent.errorMetres, index.tile(id).errorMetres);
        EXPECT_GE(parent.errorMetresOf(id.x % 2 * 2, id.y % 2 * 2, 2) * (1 + 1e-9),
                  index.tile(id).errorMetresOf(0, 0, terrain::kTilePartsPerSide));
        EXPECT_LE(parent.minHeightMetres, index.tile(id).minHeightMetres);
        EXPECT_GE(parent.maxHeightMetres, index.tile(id).maxHeightMetres);
    });
}

TEST_P(TerrainBound, BoundsHoldTheDrawnAndTheSourceSurface) {
    const terrain::EytIndex& index = file_->index();
    forEachTile(index.quadtree, [&](const TileId& id) {
        const fabric::Box bounds = index.bounds(id);
        const auto expectInside = [&](std::int32_t i, std::int32_t j, double z) {
            const fabric::Vec2 xy = grid_.origin + grid_.perColumn * static_cast<double>(i) +
                                    grid_.perRow * static_cast<double>(j);
            EXPECT_TRUE(bounds.contains({xy.x, xy.y, z})) << i << " " << j << " " << z;
        };
        for (const DrawnTriangle& triangle : test::drawnTile(*file_, id, 0))
            for (const terrain::Corner& corner : test::inMetres(*file_, triangle))
                expectInside(corner.i, corner.j, corner.z);
        const std::int32_t side = terrain::Quadtree::side(id.level);
        for (std::int32_t j = id.y * side; j <= std::min(id.y * side + side, grid_.rows - 1);
             j += 3)
            for (std::int32_t i = id.x * side; i <= std::min(id.x * side + side, grid_.columns - 1);
                 i += 3)
                expectInside(i, j, grid_.at(i, j));
    });
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (int kind = 0; kind < test::kGridKinds; ++kind)
        all.push_back({static_cast<GridKind>(kind), 150, 71});
    for (const auto& [columns, rows] : {std::pair{2, 2},
                                        {3, 3},
                                        {2, 5},
                                        {33, 33},
                                        {34, 32},
                                        {128, 128},
                                        {129, 129},
                                        {130, 130},
                                        {200, 33},
                                        {257, 40}})
        all.push_back({GridKind::Noise, columns, rows});
    all.push_back({GridKind::Smooth, 300, 280});
    return all;
}

INSTANTIATE_TEST_SUITE_P(HardGrids, TerrainBound, testing::ValuesIn(cases()),
                         [](const auto& tested) {
                             return test::name(tested.param.kind) + "_" +
                                    std::to_string(tested.param.columns) + "x" +
                                    std::to_string(tested.param.rows);
                         });

/// Elsewhere the outline of a hole may be off, which is no vertical error.
TEST(TerrainBoundBesideHoles, HoldsInPartsWhoseOutlinesAreExact) {
    for (const GridKind kind : {GridKind::Noise, GridKind::Smooth, GridKind::Cliff}) {
        HeightGrid grid = test::hardGrid(kind, 290, 150, 5);
        for (std::int32_t j = 0; j < grid.rows; ++j)
            for (std::int32_t i = 0; i < grid.columns; ++i)
                if (j > 130 || (i - 2 * j > 180) ||
                    (std::abs(i - 77) < 9 && std::abs(j - 70) < 20) || (i == 33 && j == 33))
                    grid.row(j)[i] = terrain::kNodata;
        const test::TemporaryFolder folder;
        const auto file = test::imported(grid, folder);
        ASSERT_NE(file, nullptr);
        int checked = 0;
        forEachTile(file->index().quadtree, [&](const TileId& id) {
            const terrain::TileRecord& record = file->index().tile(id);
            const std::uint8_t none = 0;
            const PartDeviations measured =
                measuredDeviations(*file, grid, id, test::drawnTile(*file, id, none));
            for (int part = 0; part < static_cast<int>(measured.size()); ++part) {
                if (record.blursOutlineIn(part % 4, part / 4, 1))
                    continue;
                ++checked;
                EXPECT_LE(measured[static_cast<std::size_t>(part)],
                          record.errorMetresOf(part % 4, part / 4, 1) * (1 + 1e-6) + 1e-6)
                    << name(kind) << " tile " << id.level << " " << id.x << " " << id.y << " part "
                    << part;
            }
        });
        EXPECT_GT(checked, 1000);
        EXPECT_LT(file->index().finestErrorMetres(), 1);
        EXPECT_GT(file->index().tile(file->index().quadtree.top()).outlineMetres, 0);
    }
}

/// A grid of one tile per level has no borders to adapt: what is left is the level's own threshold.
TEST(TerrainThreshold, IsKeptByLevelsThatMayUseEveryPost) {
    for (const GridKind kind :
         {GridKind::Noise, GridKind::Smooth, GridKind::Cliff, GridKind::Checkerboard}) {
        for (const int posts : {33, 65, 129}) {
            const test::TemporaryFolder folder;
            const HeightGrid grid = test::hardGrid(kind, posts, posts, 3);
            const auto file = test::imported(grid, folder);
            ASSERT_NE(file, nullptr);
            const terrain::TileId top = file->index().quadtree.top();
            ASSERT_LE(top.level, 2);
            const double step = file->index().heightStepMetres();
            const double allowed =
                top.level == 0
                    ? step * 0.75
                    : import::kErrorPerSpacing * 10 * std::exp2(top.level - 2) + step / 2;
            EXPECT_LE(file->index().tile(top).errorMetres, allowed + 1e-6) << name(kind) << posts;
        }
    }
}

TEST(TerrainThreshold, IsExactInWholeMetres) {
    const test::TemporaryFolder folder;
    const auto file = test::imported(test::hardGrid(GridKind::Terraces, 200, 90, 1), folder);
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(file->index().heightStepMetres(), 1);
    EXPECT_EQ(file->index().finestErrorMetres(), 0);
}

/// Corners and centre are always there, so four triangles are the fewest.
TEST(TerrainThreshold, LeavesFourTrianglesOfAPlane) {
    for (const GridKind kind : {GridKind::Flat, GridKind::Plane}) {
        const test::TemporaryFolder folder;
        const auto file = test::imported(test::hardGrid(kind, 257, 257, 1), folder);
        ASSERT_NE(file, nullptr);
        for (const terrain::TileRecord& tile : file->index().tiles)
            EXPECT_EQ(tile.triangles, 4U) << name(kind);
    }
}

}  // namespace
}  // namespace eyrie
