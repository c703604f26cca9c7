// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/sheet_ends.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

std::uint32_t addVertex(PackedMesh& mesh, const glm::uvec3& at) {
    mesh.positions.push_back(packPosition(at));
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// Squares of `spacing` steps, `count` a side, from `corner`.
void addSheet(PackedMesh& mesh, const glm::uvec3& corner, std::uint32_t spacing,
              std::uint32_t count) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t y = 0; y <= count; ++y)
        for (std::uint32_t x = 0; x <= count; ++x)
            addVertex(mesh, corner + spacing * glm::uvec3(x, y, 0));
    for (std::uint32_t y = 0; y < count; ++y)
        for (std::uint32_t x = 0; x < count; ++x) {
            const std::uint32_t a = first + y * (count + 1) + x;
            mesh.triangles.push_back({a, a + 1, a + count + 2});
            mesh.triangles.push_back({a, a + count + 2, a + count + 1});
        }
}

TEST(SheetEnds, AreTheEdgesOfOneTriangleAlone) {
    PackedMesh mesh;
    addSheet(mesh, {100, 100, 100}, 50, 4);
    const SheetEnds around(mesh);
    EXPECT_EQ(around.all().size(), 16U);
    for (const SheetEnds::End& end : around.all()) {
        const glm::vec3 middle = (end.from + end.to) / 2.0F;
        EXPECT_TRUE(middle.x == 100 || middle.x == 300 || middle.y == 100 || middle.y == 300);
    }
    // Another sheet at the same corners goes on from there, whichever way its triangles turn.
    addSheet(mesh, {300, 100, 100}, 50, 4);
    EXPECT_EQ(SheetEnds(mesh).all().size(), 24U);
    for (std::size_t i = mesh.triangles.size() / 2; i < mesh.triangles.size(); ++i)
        std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
    EXPECT_EQ(SheetEnds(mesh).all().size(), 24U);
    // Beyond these vertices there is more of the mesh.
    const std::vector<std::uint32_t> left{0, 5, 10, 15, 20};
    EXPECT_EQ(SheetEnds(mesh, left).all().size(), 20U);
}

TEST(SheetEnds, AreFoundWhereverOneOfThemAllIs) {
    std::mt19937 random(20261123);
    std::uniform_int_distribution<std::uint32_t> coordinate(0, 300);
    const auto point = [&] { return glm::uvec3(coordinate(random), coordinate(random), 7); };
    PackedMesh mesh;
    for (int i = 0; i < 60; ++i) {
        const std::uint32_t a = addVertex(mesh, point());
        const std::uint32_t b = addVertex(mesh, point());
        mesh.triangles.push_back({a, b, addVertex(mesh, point())});
    }
    const SheetEnds ends(mesh);
    int found = 0;
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 low(point());
        const glm::vec3 high = low + glm::vec3(i % 5, i % 3, 0);
        const auto reach = static_cast<float>(i % 9);
        const auto& wanted = ends.all()[static_cast<std::size_t>(i) % ends.all().size()];
        const auto isWanted = [&](const SheetEnds::End& end) { return &end == &wanted; };
        const glm::vec3 from = glm::min(wanted.from, wanted.to);
        const glm::vec3 to = glm::max(wanted.from, wanted.to);
        const bool mayBeNear = glm::all(glm::lessThanEqual(from, high + reach)) &&
                               glm::all(glm::greaterThanEqual(to, low - reach));
        found += mayBeNear ? 1 : 0;
        EXPECT_TRUE(!mayBeNear || ends.anyNear(low, high, reach, isWanted)) << i;
    }
    EXPECT_GT(found, 50);
    EXPECT_LT(found, 450);
    EXPECT_FALSE(SheetEnds({}).anyNear({}, {}, 1e9, [](const SheetEnds::End&) { return true; }));
}

/// Of a sheet of 8 by 8 squares of 50 steps at height 1000, those corners that another triangle
/// holds, but those where the sheet ends itself.
std::vector<glm::uvec2> heldBy(const std::vector<glm::uvec3>& corners) {
    PackedMesh mesh;
    addSheet(mesh, {1000, 1000, 1000}, 50, 8);
    const std::size_t count = mesh.positions.size();
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const std::uint32_t a = addVertex(mesh, corners[i]);
        const std::uint32_t b = addVertex(mesh, corners[i + 1]);
        mesh.triangles.push_back({a, b, addVertex(mesh, corners[i + 2])});
    }
    const std::vector<std::uint8_t> held = whereOthersEnd(mesh, SheetEnds(mesh));
    std::vector<glm::uvec2> result;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::uvec2 at(unpackPosition(mesh.positions[i]));
        const bool isEnd = at.x == 1000 || at.x == 1400 || at.y == 1000 || at.y == 1400;
        EXPECT_TRUE(held[i] != 0 || !isEnd);
        if (held[i] != 0 && !isEnd)
            result.push_back(at);
    }
    return result;
}

TEST(WhereOthersEnd, IsWhereATrianglesCornerTouches) {
    EXPECT_TRUE(heldBy({}).empty());
    // 3 steps above the middle of a triangle: its corners.
    const std::vector<glm::uvec2> corners{{1100, 1100}, {1150, 1100}, {1150, 1150}};
    EXPECT_EQ(heldBy({{1133, 1117, 1003}, {1120, 1110, 1300}, {1140, 1110, 1300}}), corners);
    EXPECT_TRUE(heldBy({{1133, 1117, 1004}, {1120, 1110, 1300}, {1140, 1110, 1300}}).empty());
}

TEST(WhereOthersEnd, IsWhereASideTouchesASide) {
    // Along a row of sides, from beyond the sheet to beyond it.
    const std::vector<glm::uvec2> held =
        heldBy({{900, 1102, 1001}, {1500, 1102, 1001}, {1200, 1100, 1500}});
    for (std::uint32_t x = 1050; x < 1400; x += 50)
        EXPECT_TRUE(std::ranges::count(held, glm::uvec2(x, 1100)) == 1) << x;
    // Above, across: nothing touches.
    EXPECT_TRUE(heldBy({{900, 1102, 1010}, {1500, 1102, 1010}, {1200, 1100, 1500}}).empty());
}

TEST(WhereOthersEnd, IsNotWhereSomethingGoesThrough) {
    EXPECT_TRUE(heldBy({{1133, 1117, 900}, {1130, 1115, 1300}, {1136, 1115, 1300}}).empty());
}

/// What shares a corner hangs together with it.
TEST(WhereOthersEnd, IsNotWhereItsOwnSheetEnds) {
    EXPECT_TRUE(heldBy({{1400, 1000, 1000}, {1400, 1050, 1000}, {1450, 1000, 1000}}).empty());
}

}  // namespace
}  // namespace eyrie::mesh
