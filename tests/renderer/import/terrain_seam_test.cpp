// SPDX-License-Identifier: Apache-2.0
// Cracks and T-junctions, looked for as what they are: edges of drawn triangles that do not have
// exactly one triangle on either side, each corner being the same three integers on both.
#include <algorithm>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "renderer/terrain/terrain_cut.h"
#include "tests/renderer/import/terrain_fixture.h"
#include "tests/renderer/terrain/hard_grids.h"

namespace eyrie {
namespace {

using terrain::HeightGrid;
using test::DrawnCorner;
using test::DrawnTriangle;
using test::GridKind;

using Edge = std::pair<DrawnCorner, DrawnCorner>;

/// Every edge once, with the number of triangles that have it.
std::vector<std::pair<Edge, int>> edgeUse(const std::vector<DrawnTriangle>& triangles) {
    std::vector<Edge> edges;
    for (const DrawnTriangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    std::vector<std::pair<Edge, int>> use;
    for (const Edge& edge : edges) {
        if (use.empty() || use.back().first != edge)
            use.emplace_back(edge, 0);
        ++use.back().second;
    }
    return use;
}

bool isOnOutline(const Edge& edge, const HeightGrid& grid) {
    const auto both = [&](std::int32_t DrawnCorner::*axis, std::int32_t value) {
        return edge.first.*axis == value && edge.second.*axis == value;
    };
    return both(&DrawnCorner::i, 0) || both(&DrawnCorner::i, grid.columns - 1) ||
           both(&DrawnCorner::j, 0) || both(&DrawnCorner::j, grid.rows - 1);
}

std::vector<DrawnTriangle> drawnCut(const terrain::EytFile& file, const terrain::TerrainCut& cut) {
    std::vector<DrawnTriangle> triangles;
    for (const terrain::TileChoice& choice : cut.tiles) {
        const auto tile = test::drawnTile(file, choice.id, choice.finerEdges);
        triangles.insert(triangles.end(), tile.begin(), tile.end());
    }
    return triangles;
}

terrain::TerrainCut randomCut(const terrain::EytFile& file, test::Random& random) {
    const fabric::Box box = file.index().bounds();
    const auto inside = [&] {
        return box.min + box.size() * fabric::Vec3(random.unit(), random.unit(), random.unit());
    };
    fabric::Camera camera;
    camera.eye = inside() + fabric::Vec3(0, 0, 100 * random.unit());
    camera.target = inside() - fabric::Vec3(0, 0, 200);
    camera.fovYDegrees = 30 + 60 * random.unit();
    const lod::ObjectView view(lod::View(camera, 1280, 720), fabric::Mat4(1.0));
    return terrain::selectCut(file.index(), view, std::exp2(random.integer(0, 8)));
}

struct Case {
    GridKind kind;
    std::int32_t columns;
    std::int32_t rows;
};

class TerrainSeams : public testing::TestWithParam<Case> {};

TEST_P(TerrainSeams, HaveOneTriangleOnEitherSideInEveryCut) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = test::hardGrid(GetParam().kind, GetParam().columns, GetParam().rows, 5);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    test::Random random(11);
    int mixedCuts = 0;
    for (int round = 0; round < 12; ++round) {
        const terrain::TerrainCut cut = randomCut(*file, random);
        mixedCuts += std::any_of(cut.tiles.begin(), cut.tiles.end(),
                                 [](const auto& choice) { return choice.finerEdges != 0; });
        const std::vector<DrawnTriangle> triangles = drawnCut(*file, cut);
        std::int64_t area = 0;
        for (const DrawnTriangle& triangle : triangles) {
            ASSERT_GT(test::doubleArea(triangle), 0) << "clockwise or flat, round " << round;
            area += test::doubleArea(triangle);
        }
        EXPECT_EQ(area, std::int64_t{2} * (grid.columns - 1) * (grid.rows - 1))
            << "round " << round;
        for (const auto& [edge, uses] : edgeUse(triangles))
            ASSERT_EQ(uses, isOnOutline(edge, grid) ? 1 : 2)
                << "round " << round << ", from (" << edge.first.i << ", " << edge.first.j << ", "
                << edge.first.q << ") to (" << edge.second.i << ", " << edge.second.j << ", "
                << edge.second.q << ")";
    }
    if (GetParam().columns >= 500) {
        EXPECT_GT(mixedCuts, 3) << "the cuts of this test hardly mix levels any more";
    }
}

INSTANTIATE_TEST_SUITE_P(
    HardGrids, TerrainSeams,
    testing::Values(Case{GridKind::Smooth, 513, 513}, Case{GridKind::Smooth, 600, 530},
                    Case{GridKind::Noise, 514, 300}, Case{GridKind::Spikes, 700, 401},
                    Case{GridKind::Terraces, 643, 515}, Case{GridKind::Cliff, 520, 259},
                    Case{GridKind::Noise, 2, 3}, Case{GridKind::Noise, 200, 33}),
    [](const auto& tested) {
        return test::name(tested.param.kind) + "_" + std::to_string(tested.param.columns) + "x" +
               std::to_string(tested.param.rows);
    });

/// Every pair of levels across every border, whether a view would choose it or not.
TEST(TerrainSeams, MeetOneLevelApartAtEveryBorder) {
    const test::TemporaryFolder folder;
    const HeightGrid grid = test::hardGrid(GridKind::Smooth, 530, 401, 9);
    const auto file = test::imported(grid, folder);
    ASSERT_NE(file, nullptr);
    const terrain::Quadtree& quadtree = file->index().quadtree;
    const auto chain = [&](const std::vector<DrawnTriangle>& triangles, std::int32_t column,
                           std::int32_t from, std::int32_t to) {
        std::map<Edge, int> edges;
        for (const auto& [edge, uses] : edgeUse(triangles))
            if (edge.first.i == column && edge.second.i == column && edge.first.j >= from &&
                edge.second.j <= to && edge.first.j != edge.second.j)
                edges[edge] = uses;
        return edges;
    };
    for (int level = 1; level < quadtree.levels(); ++level)
        for (std::int32_t y = 0; y < quadtree.tilesY(level); ++y)
            for (std::int32_t x = 0; x + 1 < quadtree.tilesX(level); ++x) {
                const std::int32_t side = terrain::Quadtree::side(level);
                const std::int32_t border = (x + 1) * side;
                const auto coarse =
                    chain(test::drawnTile(*file, {level, x, y}, 1 << terrain::kEdgeMaxX), border,
                          y * side, y * side + side);
                std::map<Edge, int> fine;
                for (std::int32_t half = 0; half < 2; ++half)
                    if (const terrain::TileId id{level - 1, 2 * x + 2, 2 * y + half};
                        quadtree.contains(id))
                        fine.merge(chain(test::drawnTile(*file, id, 0), border, y * side,
                                         y * side + side));
                EXPECT_EQ(coarse, fine) << level << " " << x << " " << y;
                const auto own = chain(test::drawnTile(*file, {level, x, y}, 0), border, y * side,
                                       y * side + side);
                EXPECT_EQ(own, chain(test::drawnTile(*file, {level, x + 1, y}, 0), border, y * side,
                                     y * side + side));
            }
}

}  // namespace
}  // namespace eyrie
