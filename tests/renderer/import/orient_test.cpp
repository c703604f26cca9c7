// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/orient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/pack_mesh.h"
#include "tests/renderer/import/ply_text.h"

namespace eyrie::import {
namespace {

constexpr PackOptions kOriented{.orients = true};

struct Packed {
    mesh::PackedMesh mesh;
    PackCounts counts;
};

Packed pack(const TriangleMesh& source, const PackOptions& options = kOriented) {
    Packed result;
    auto packed = packMesh(source, result.counts, options);
    EXPECT_TRUE(packed.ok()) << packed.status();
    if (packed.ok())
        result.mesh = *std::move(packed);
    return result;
}

void turn(std::array<std::uint32_t, 3>& triangle) { std::swap(triangle[1], triangle[2]); }

/// Adds a copy of `part` that is moved and scaled.
void add(TriangleMesh& mesh, const TriangleMesh& part, const fabric::Vec3& to, double scale = 1) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const fabric::Vec3& position : part.positions)
        mesh.positions.push_back(position * scale + to);
    for (const auto& [a, b, c] : part.triangles)
        mesh.triangles.push_back({first + a, first + b, first + c});
}

/// Turned so that the least corner is first, in ascending order: two lists are equal when all faces
/// wind the same way.
std::vector<mesh::Triangle> canonical(std::vector<mesh::Triangle> triangles) {
    for (mesh::Triangle& triangle : triangles)
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

RC_GTEST_PROP(Orient, UndoesRandomTurnsOfClosedSurfaces, ()) {
    static const TriangleMesh kBall = synthesizeMesh(400, 1);
    TriangleMesh source = kBall;
    add(source, test::tetrahedron(), {100, 0, 0});
    add(source, test::tetrahedron(), {0, 0, 0}, 1e-2);  // inside the ball
    const auto bits =
        *rc::gen::container<std::vector<bool>>(source.triangles.size(), rc::gen::arbitrary<bool>());
    TriangleMesh damaged = source;
    for (std::size_t i = 0; i < bits.size(); ++i)
        if (bits[i])
            turn(damaged.triangles[i]);
    const Packed packed = pack(damaged);
    // Vertices are numbered by first use, which turning changes: compare by position.
    const auto byPosition = [](const Packed& which) {
        std::vector<std::array<std::uint64_t, 3>> faces;
        for (const auto& [a, b, c] : which.mesh.triangles) {
            std::array<std::uint64_t, 3> face = {which.mesh.positions[a], which.mesh.positions[b],
                                                 which.mesh.positions[c]};
            std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
            faces.push_back(face);
        }
        std::sort(faces.begin(), faces.end());
        return faces;
    };
    RC_ASSERT(byPosition(packed) == byPosition(pack(source, {})));
    RC_ASSERT(packed.counts.orient.components == 3);
    RC_ASSERT(packed.counts.orient.closedComponents == 3);
    RC_ASSERT(packed.counts.orient.turnedTriangles ==
              static_cast<std::uint64_t>(std::count(bits.begin(), bits.end(), true)));
}

TEST(Orient, LeavesTheLargerAreaOfASheetAsItIs) {
    TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {3, 0, 0}, {3, 1, 0}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}, {1, 4, 5}, {1, 5, 2}};
    const Packed packed = pack(sheet);
    EXPECT_EQ(packed.counts.orient.turnedTriangles, 2U);
    EXPECT_EQ(canonical(packed.mesh.triangles).size(), 4U);
    sheet.triangles[0] = {0, 1, 2};
    sheet.triangles[1] = {0, 2, 3};
    EXPECT_EQ(pack(sheet).counts.orient.turnedTriangles, 0U);
}

TEST(Orient, TurnsAScanWithASmallHoleOutward) {
    TriangleMesh source = synthesizeMesh(2000, 1);
    source.triangles.pop_back();
    for (auto& triangle : source.triangles) turn(triangle);
    const Packed packed = pack(source);
    EXPECT_EQ(packed.counts.orient.turnedTriangles, source.triangles.size());
    EXPECT_EQ(packed.counts.orient.closedComponents, 0U);
}

TEST(Orient, TakesAnEdgeOfThreeFacesForTheEndOfASurface) {
    TriangleMesh fan;
    fan.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    fan.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    EXPECT_EQ(pack(fan).counts.orient.components, 3U);
    EXPECT_EQ(pack(fan).counts.orient.turnedTriangles, 0U);
}

TEST(Orient, CountsTheEdgesOfAMobiusStripThatCannotAgree) {
    TriangleMesh strip;
    constexpr std::uint32_t kParts = 12;
    for (std::uint32_t i = 0; i < kParts; ++i) {
        const double angle = 2 * 3.14159265358979 * i / kParts;
        for (const double side : {-0.3, 0.3}) {
            const double radius = 1 + side * std::cos(angle / 2);
            strip.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                         side * std::sin(angle / 2));
        }
    }
    for (std::uint32_t i = 0; i < kParts; ++i) {
        const bool isLast = i + 1 == kParts;
        const std::uint32_t a = 2 * i, b = a + 1;
        const std::uint32_t c = isLast ? 1 : a + 2, d = isLast ? 0 : a + 3;
        strip.triangles.insert(strip.triangles.end(), {{a, c, b}, {b, c, d}});
    }
    const PackCounts counts = pack(strip).counts;
    EXPECT_EQ(counts.orient.components, 1U);
    EXPECT_EQ(counts.orient.contraryEdges, 1U);
}

}  // namespace
}  // namespace eyrie::import
