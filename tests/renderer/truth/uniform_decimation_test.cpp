// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/uniform_decimation.h"

#include <cmath>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace eyrie::truth {
namespace {

using fabric::Vec3;

TEST(UniformDecimation, KeepsEveryPostOfAStrideWhereItStands) {
    HeightGrid grid{.columns = 10,
                    .rows = 5,
                    .heights = {},
                    .origin = {100, 50},
                    .perColumn = {3, 1},
                    .perRow = {0, -2}};
    for (int i = 0; i < 50; ++i) grid.heights.push_back(static_cast<float>(i));
    const HeightGrid coarse = everyPost(grid, 3);
    EXPECT_EQ(coarse.columns, 4);
    EXPECT_EQ(coarse.rows, 2);
    EXPECT_EQ(coarse.heights, (std::vector<float>{0, 3, 6, 9, 30, 33, 36, 39}));
    EXPECT_EQ(coarse.perColumn, fabric::Vec2(9, 3));
    EXPECT_EQ(coarse.perRow, fabric::Vec2(0, -6));
    EXPECT_EQ(everyPost(grid, 1).heights, grid.heights);
    EXPECT_EQ(trianglesOf(coarse), 6U);
    grid.heights[0] = std::nanf("");
    EXPECT_EQ(trianglesOf(everyPost(grid, 3)), 4U) << "a cell without one of its posts has none";
}

TEST(UniformDecimation, CountsTheTrianglesThatAreNotAllBeyondOneSideOfTheView) {
    // 20 x 20 cells of a metre, seen from its middle to the north, 90 degrees wide.
    HeightGrid grid{.columns = 21, .rows = 21, .heights = std::vector<float>(21 * 21)};
    const fabric::Camera camera{.eye = {10, -10, 0.25}, .target = {10, 0, 0.25}, .fovYDegrees = 90};
    const Pinhole square(camera, 100, 100);
    const std::size_t seen = trianglesInView(grid, fabric::Mat4(1), square);
    // A quarter of the cells, and those that its two sides go through.
    EXPECT_GE(seen, 2U * 100);
    EXPECT_LE(seen, 2U * (100 + 4 * 10));
    TriangleMesh mesh;
    for (int j = 0; j < 21; ++j)
        for (int i = 0; i < 21; ++i) mesh.positions.emplace_back(i, -j, 0);
    for (std::uint32_t j = 0; j < 20; ++j)
        for (std::uint32_t i = 0; i < 20; ++i) {
            const std::uint32_t at = 21 * j + i;
            mesh.triangles.push_back({at, at + 1, at + 22});
            mesh.triangles.push_back({at, at + 22, at + 21});
        }
    EXPECT_EQ(trianglesInView(mesh, fabric::Mat4(1), square), seen);
    fabric::Mat4 moved(1);
    moved[3] = {0, -1000, 0, 1};
    EXPECT_EQ(trianglesInView(grid, moved, square), 0U) << "behind the eye";
    grid.heights[5 * 21 + 10] = std::nanf("");
    EXPECT_EQ(trianglesInView(grid, fabric::Mat4(1), square), seen - 8) << "four cells have none";
    const Pinhole whole({.eye = {10, -10, 100}, .target = {10, -10, 0}, .up = {0, 1, 0}}, 100, 100);
    EXPECT_EQ(trianglesInView(grid, fabric::Mat4(1), whole), trianglesOf(grid));
}

/// A grid of 60 x 60 squares around (5e5, 5e6, 0), bent into a bowl.
TriangleMesh bowl() {
    constexpr std::uint32_t kSide = 61;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j < kSide; ++j)
        for (std::uint32_t i = 0; i < kSide; ++i)
            mesh.positions.emplace_back(5e5 + i, 5e6 + j, 0.01 * (i * i + j * j));
    for (std::uint32_t j = 0; j + 1 < kSide; ++j)
        for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
            const std::uint32_t at = j * kSide + i;
            mesh.triangles.push_back({at, at + 1, at + kSide + 1});
            mesh.triangles.push_back({at, at + kSide + 1, at + kSide});
        }
    return mesh;
}

TEST(UniformDecimation, OfAMeshLeavesAboutAsManyTrianglesOfItsOwnVertices) {
    const TriangleMesh mesh = bowl();
    std::set<std::array<double, 3>> known;
    for (const Vec3& p : mesh.positions) known.insert({p.x, p.y, p.z});
    for (const std::size_t wanted : {3600U, 900U, 100U}) {
        const TriangleMesh coarse = clustered(mesh, wanted);
        EXPECT_LE(coarse.triangles.size(), wanted);
        EXPECT_GE(coarse.triangles.size(), wanted / 4);
        for (const Vec3& p : coarse.positions) EXPECT_TRUE(known.contains({p.x, p.y, p.z}));
        for (const auto& triangle : coarse.triangles)
            for (const std::uint32_t corner : triangle) ASSERT_LT(corner, coarse.positions.size());
    }
}

}  // namespace
}  // namespace eyrie::truth
