// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_faces.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

using fabric::Vec3;

/// Adds a closed ball of 2 * `rings` * (`rings` - 1) triangles; its inside out where asked.
void addBall(PackedMesh& mesh, const Vec3& centre, double radius, bool isInsideOut = false,
             int rings = 8) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto across = static_cast<std::uint32_t>(rings);
    const auto add = [&](double polar, double turn) {
        const Vec3 at = centre + radius * Vec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                               std::sin(polar) * std::sin(turn));
        mesh.positions.push_back(packPosition(glm::uvec3(at + 0.5)));
        mesh.normals.push_back(0);
    };
    add(0, 0);
    for (int ring = 1; ring < rings; ++ring)
        for (int i = 0; i < rings; ++i)
            add(M_PI * ring / rings, 2 * M_PI * (i + 0.3 * ring) / rings);
    add(M_PI, 0);
    const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (isInsideOut)
            std::swap(b, c);
        mesh.triangles.push_back({first + a, first + b, first + c});
    };
    const std::uint32_t last = across * (across - 1) + 1;
    for (std::uint32_t i = 0; i < across; ++i) {
        const std::uint32_t next = (i + 1) % across;
        face(0, 1 + next, 1 + i);
        for (std::uint32_t row = 1; row + across < last; row += across) {
            face(row + i, row + next, row + across + i);
            face(row + next, row + across + next, row + across + i);
        }
        face(last, last - across + i, last - across + next);
    }
}

Vec3 corner(const PackedMesh& mesh, const Triangle& triangle, std::size_t i) {
    return Vec3(unpackPosition(mesh.positions[triangle[i]]));
}

/// How often the mesh winds a point: the solid angles of its triangles, added up.
/// A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", 1983.
double winding(const PackedMesh& mesh, const Vec3& at) {
    double sum = 0;
    for (const Triangle& triangle : mesh.triangles) {
        const Vec3 a = corner(mesh, triangle, 0) - at;
        const Vec3 b = corner(mesh, triangle, 1) - at;
        const Vec3 c = corner(mesh, triangle, 2) - at;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                 glm::dot(b, c) * la +
                                                                 glm::dot(c, a) * lb);
    }
    return sum / (4 * M_PI);
}

RC_GTEST_PROP(BackFaces, AreSeenWhereSolidAnglesInFrontAddUpToLessThanNothing, ()) {
    PackedMesh mesh;
    const int balls = *rc::gen::inRange(1, 5);
    for (int i = 0; i < balls; ++i) {
        const auto number = [](int low, int high) {
            return static_cast<double>(*rc::gen::inRange(low, high));
        };
        addBall(mesh, {number(2000, 5000), number(2000, 5000), number(2000, 5000)},
                number(100, 2000), *rc::gen::arbitrary<bool>(), 6);
    }
    const auto found = seenFromBehind(mesh);
    RC_ASSERT(found.has_value());
    std::vector<bool> isFound(mesh.triangles.size(), false);
    for (const std::uint32_t triangle : *found) isFound[triangle] = true;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& triangle = mesh.triangles[i];
        const Vec3 a = corner(mesh, triangle, 0);
        const Vec3 b = corner(mesh, triangle, 1);
        const Vec3 c = corner(mesh, triangle, 2);
        const double up = glm::cross(b - a, c - a).z;
        const double wound = winding(mesh, (a + b + c) / 3.0 + Vec3(0, 0, up > 0 ? 2 : -2));
        if (up != 0 && std::abs(wound - std::round(wound)) < 1e-3)
            RC_ASSERT(isFound[i] == (std::round(wound) < 0));
    }
}

TEST(BackFaces, OfASolidAreSeenNowhere) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    addBall(mesh, {5000, 5000, 5000}, 1000, true);  // hollow
    addBall(mesh, {9000, 5000, 5000}, 2000);        // passes through the first
    EXPECT_EQ(seenFromBehind(mesh), std::vector<std::uint32_t>());
}

TEST(BackFaces, OfAnOpenMeshMayBeSeenEverywhere) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    mesh.triangles.pop_back();
    EXPECT_EQ(seenFromBehind(mesh), std::nullopt);
    std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
    EXPECT_EQ(seenFromBehind(mesh), std::nullopt);
}

TEST(BackFaces, OfTwoVerticesAtOnePlaceAreThoseOfOne) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    for (Triangle& triangle : mesh.triangles)
        for (std::uint32_t& vertex : triangle) {
            mesh.positions.push_back(mesh.positions[vertex]);
            mesh.normals.push_back(0);
            vertex = static_cast<std::uint32_t>(mesh.positions.size() - 1);
        }
    EXPECT_EQ(seenFromBehind(mesh), std::vector<std::uint32_t>());
}

TEST(Pockets, AreWhereTheMeshIsInsideOut) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000, false, 16);
    addBall(mesh, {20000, 5000, 5000}, 100, true);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    const std::vector<Pockets> pockets = findPockets(mesh, *tree);
    const fabric::Box farAway{{5000, 5000, 8000}, {5100, 5100, 8100}};
    const fabric::Box pocket{{19950, 4950, 4950}, {20050, 5050, 5050}};
    EXPECT_TRUE(pockets[0].reach(pocket, 0));
    EXPECT_FALSE(pockets[0].reach(farAway, 0));
    EXPECT_FALSE(pockets[0].reach(farAway, 11000));
    EXPECT_TRUE(pockets[0].reach(farAway, 16000));
}

TEST(Pockets, OfAnOpenMeshAreEverywhere) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    mesh.triangles.pop_back();
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    for (const Pockets& node : findPockets(mesh, *tree))
        EXPECT_TRUE(node.reach({Vec3(1e6), Vec3(1e6)}, 0));
}

TEST(Pockets, BeyondAFewDozenAreEverywhere) {
    PackedMesh mesh;
    for (int i = 0; i < 100; ++i) addBall(mesh, {1000.0 * (i + 1), 5000, 5000}, 10, true, 4);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    EXPECT_TRUE(findPockets(mesh, *tree)[0].reach({Vec3(1e6), Vec3(1e6)}, 0));
}

}  // namespace
}  // namespace eyrie::mesh
