// SPDX-License-Identifier: Apache-2.0
// What lines of sight pass through: holes of the data, and nothing between what is closed.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/integration/pick_pair.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Vec3;
using test::GridKind;
using test::PickPair;
using test::terrainPair;

/// From inside a closed mesh every line of sight meets it, also through what triangles share.
TEST(HardCase22, NoPickSlipsThroughAnEdgeOrACornerOfAMesh) {
    const test::TemporaryFolder folder;
    const import::TriangleMesh mesh = import::synthesizeMesh(3000, 7);
    const std::string path = folder.path("ball.eym");
    ASSERT_TRUE(import::importMesh(mesh, path, {.leafTriangles = 200}).ok());
    const auto opened = mesh::EymFile::open(path);
    ASSERT_TRUE(opened.ok());
    const auto picker = test::openPicker({.name = "ball", .path = path});
    const Vec3 eye(0.01, 0.02, 0.03);
    int picks = 0;
    const auto meet = [&](const Vec3& target) {
        const auto picked = picker->pick({{eye, target}, 100, 100, {50, 50}});
        ASSERT_TRUE(picked.ok()) << picked.status();
        ASSERT_TRUE(picked->has_value()) << target.x << " " << target.y << " " << target.z;
        EXPECT_LE((*picked)->nearestMetres, glm::length(target - eye) + 1e-9);
        ++picks;
    };
    for (std::uint32_t node = 0; node < opened->nodes().size(); ++node) {
        if (!opened->nodes()[node].isLeaf())
            continue;
        const auto leaf = opened->geometry(node);
        ASSERT_TRUE(leaf.ok());
        const auto at = [&](std::size_t k) {
            return opened->lattice().metres(
                mesh::unpackPosition(leaf->positions[leaf->indices[k]]));
        };
        for (std::size_t k = 0; k < leaf->indices.size(); k += 3)
            for (std::size_t c = 0; c < 3; ++c) {
                meet(at(k + c));
                meet((at(k + c) + at(k + (c + 1) % 3)) * 0.5);
            }
    }
    EXPECT_GT(picks, 10'000);
}

TEST(HardCase22, NoPickSlipsThroughAnEdgeOrACornerOfATerrain) {
    const test::TemporaryFolder folder;
    for (const GridKind kind : {GridKind::Smooth, GridKind::Noise, GridKind::Flat}) {
        terrain::HeightGrid grid = test::hardGrid(kind, 40, 37, 5);
        if (kind == GridKind::Noise)  // a spacing that no binary fraction holds
            grid.perColumn = {10.1, 0};
        const PickPair pair = terrainPair(folder, grid);
        // Half a post on, too; straight down, also on the borders, and aslant so steeply that no
        // slope is in the way.
        for (int j = 0; j <= 2 * 36; ++j)
            for (int i = 0; i <= 2 * 39; ++i) {
                const bool isOnBorder = i % (2 * 39) == 0 || j % (2 * 36) == 0;
                const fabric::Vec2 at =
                    grid.origin + grid.perColumn * (i / 2.0) + grid.perRow * (j / 2.0);
                const Vec3 target(at.x, at.y, 0);
                const Vec3 aside = isOnBorder || (i + j) % 2 == 0 ? Vec3(0) : Vec3(10, -5, 0);
                const auto picked =
                    pair.pick({target + aside + Vec3(0, 0, 9000), target, {0, 1, 0}}, {640, 360});
                ASSERT_TRUE(picked.ok()) << picked.status();
                ASSERT_TRUE(picked->has_value()) << test::name(kind) << " " << i << " " << j;
                EXPECT_LT((*picked)->farthestMetres, pick::kNowhere) << test::name(kind);
            }
    }
}

/// Straight down at the middle of each cell, and a little beside it: a hole is where no post of the
/// cell is data, ground is where all are; between the two each triangle decides.
TEST(HardCase22, PicksFallThroughHolesOfATerrainAndNothingElse) {
    const test::TemporaryFolder folder;
    terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 40, 37, 5);
    std::mt19937 engine(27);
    for (float& height : grid.heights)
        if (engine() % 6 == 0)
            height = terrain::kNodata;
    for (int j = 20; j < 30; ++j)
        for (int i = 25; i < 36; ++i) grid.row(j)[i] = terrain::kNodata;
    const PickPair pair = terrainPair(folder, grid);
    int fallen = 0;
    for (int j = 0; j < 36; ++j)
        for (int i = 0; i < 39; ++i) {
            int data = 0;
            for (const int corner : {0, 1, 2, 3})
                data += std::isnan(grid.at(i + corner % 2, j + corner / 2)) ? 0 : 1;
            const fabric::Vec2 at =
                grid.origin + grid.perColumn * (i + 0.55) + grid.perRow * (j + 0.52);
            const Vec3 target(at.x, at.y, 0);
            const auto picked =
                pair.pick({target + Vec3(0, 0, 900), target, {0, 1, 0}}, {640, 360});
            ASSERT_TRUE(picked.ok()) << picked.status();
            fallen += picked->has_value() ? 0 : 1;
            if (data == 0 || data == 4) {
                EXPECT_EQ(picked->has_value(), data == 4) << i << " " << j;
            }
            if (picked->has_value())
                pair.holdNearest(**picked);
        }
    EXPECT_GT(fallen, 100);
}

}  // namespace
}  // namespace eyrie
