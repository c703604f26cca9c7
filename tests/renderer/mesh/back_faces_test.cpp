// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/edges.h"
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

std::optional<std::vector<std::uint32_t>> behind(const PackedMesh& mesh) {
    const auto lids = findLids(mesh);
    return lids ? seenFromBehind(mesh, *lids) : std::nullopt;
}

PackedMesh withLids(PackedMesh mesh, const Lids& lids) {
    mesh.triangles.insert(mesh.triangles.end(), lids.triangles.begin(), lids.triangles.end());
    return mesh;
}

bool isClosed(const PackedMesh& mesh) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, int> edges;
    for (const Triangle& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t from = mesh.positions[triangle[i]];
            const std::uint64_t to = mesh.positions[triangle[(i + 1) % 3]];
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

/// Balls in and through each other, some inside out, with triangles missing or turned.
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
    for (int damaged = *rc::gen::inRange(0, 8); damaged > 0; --damaged) {
        const auto at = *rc::gen::inRange<std::size_t>(0, mesh.triangles.size());
        if (*rc::gen::arbitrary<bool>())
            mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(at));
        else
            std::swap(mesh.triangles[at][0], mesh.triangles[at][1]);
    }
    const auto lids = findLids(mesh);
    RC_ASSERT(lids.has_value());
    const PackedMesh closed = withLids(mesh, *lids);
    RC_ASSERT(isClosed(closed));
    const auto found = seenFromBehind(mesh, *lids);
    RC_ASSERT(found.has_value());
    std::vector<bool> isFound(mesh.triangles.size(), false);
    for (const std::uint32_t triangle : *found) isFound[triangle] = true;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& triangle = mesh.triangles[i];
        const Vec3 a = corner(mesh, triangle, 0);
        const Vec3 b = corner(mesh, triangle, 1);
        const Vec3 c = corner(mesh, triangle, 2);
        const double up = glm::cross(b - a, c - a).z;
        const double wound = winding(closed, (a + b + c) / 3.0 + Vec3(0, 0, up > 0 ? 2 : -2));
        if (up != 0 && std::abs(wound - std::round(wound)) < 1e-3)
            RC_ASSERT(isFound[i] == (std::round(wound) < 0));
    }
}

TEST(BackFaces, OfASolidAreSeenNowhere) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    addBall(mesh, {5000, 5000, 5000}, 1000, true);  // hollow
    addBall(mesh, {9000, 5000, 5000}, 2000);        // passes through the first
    EXPECT_EQ(behind(mesh), std::vector<std::uint32_t>());
}

/// Through the lid they are seen; else they are not.
TEST(BackFaces, OfAHollowWithAHoleAreSeenNowhereElse) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 3);
    EXPECT_EQ(behind(mesh), std::vector<std::uint32_t>());
    EXPECT_EQ(findLids(mesh)->boxes.size(), 1U);
}

/// As hashOfEdge mixes the lower of two positions: edges of the same hash are easily made.
std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 33) * 0xFF51AFD7ED558CCDULL;
    value = (value ^ value >> 33) * 0xC4CEB9FE1A85EC53ULL;
    return value ^ value >> 33;
}

/// A closed tetrahedron and two triangles apart, of which one passes an edge as if it was the way
/// back of the other's. Then its other two edges are left alone, in some of these meshes.
TEST(Lids, AreNoneWhereEdgesAreMadeToPassForOthers) {
    std::mt19937_64 random(1);
    const auto position = [&] { return random() >> 1; };
    int refused = 0;
    for (int meshes = 0; meshes < 1000;) {
        const std::uint64_t a = position() >> 1, b = a + (position() >> 2), c = position() >> 2;
        const std::uint64_t d = mixed(a) + b - mixed(c);
        if (d >> 63 != 0 || d <= c)
            continue;
        ++meshes;
        ASSERT_EQ(hashOfEdge(a, b), hashOfEdge(d, c));
        PackedMesh mesh;
        mesh.positions = {position(), position(), position(), position(), a,
                          b,          position(), d,          c,          position()};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {4, 5, 6}, {7, 8, 9}};
        refused += findLids(mesh) ? 0 : 1;
    }
    EXPECT_GT(refused, 0);
}

TEST(Lids, OfMissingTrianglesAreAroundThem) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    EXPECT_TRUE(findLids(mesh)->triangles.empty());
    for (const std::size_t gone : {std::size_t{40}, std::size_t{0}}) {
        const fabric::Box box = boxOf(mesh, mesh.triangles[gone]);
        mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(gone));
        const auto lids = findLids(mesh);
        ASSERT_TRUE(lids);
        EXPECT_EQ(std::ranges::count(lids->boxes, box), 1);
        EXPECT_EQ(lids->triangles.size(), lids->boxes.size());
    }
    EXPECT_EQ(findLids(mesh)->boxes.size(), 2U);
}

TEST(Lids, OfASlitWithoutAreaCloseItWithoutABox) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    // The first triangle in two halves, which its neighbour along the cut edge does not share.
    const auto [a, b, c] = mesh.triangles[0];
    const auto step = [&](std::size_t axis) {
        return (unpackPosition(mesh.positions[b])[static_cast<int>(axis)] +
                unpackPosition(mesh.positions[c])[static_cast<int>(axis)]) %
               2;
    };
    glm::uvec3 even = unpackPosition(mesh.positions[b]);
    even += glm::uvec3(step(0), step(1), step(2));
    const std::uint64_t before = mesh.positions[b];
    for (std::uint64_t& position : mesh.positions)
        if (position == before)
            position = packPosition(even);
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(packPosition((even + unpackPosition(mesh.positions[c])) / 2U));
    mesh.triangles[0] = {a, b, middle};
    mesh.triangles.push_back({a, middle, c});
    const auto lids = findLids(mesh);
    ASSERT_TRUE(lids);
    EXPECT_EQ(lids->triangles.size(), 1U);
    EXPECT_TRUE(lids->boxes.empty());
    EXPECT_TRUE(isClosed(withLids(mesh, *lids)));
    EXPECT_EQ(behind(mesh), std::vector<std::uint32_t>());
}

TEST(Lids, OfTooManyHolesAreNone) {
    PackedMesh mesh;
    for (int i = 0; i < 65; ++i) {
        addBall(mesh, {1000.0 * (i + 1), 5000, 5000}, 400);
        mesh.triangles.pop_back();
    }
    EXPECT_FALSE(findLids(mesh));
}

TEST(Lids, OfASoupAreNone) {
    PackedMesh mesh;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        mesh.positions.push_back(packPosition({i * 7919 % 100003, i * 104729 % 100019, i}));
        if (i % 3 == 2)
            mesh.triangles.push_back({i - 2, i - 1, i});
    }
    EXPECT_FALSE(findLids(mesh));
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
    EXPECT_EQ(behind(mesh), std::vector<std::uint32_t>());
}

TEST(Pockets, AreWhereTheMeshIsInsideOut) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000, false, 16);
    addBall(mesh, {20000, 5000, 5000}, 100, true);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    const std::vector<Pockets> pockets = findPockets(mesh, findLids(mesh), *tree);
    const fabric::Box farAway{{5000, 5000, 8000}, {5100, 5100, 8100}};
    const fabric::Box pocket{{19950, 4950, 4950}, {20050, 5050, 5050}};
    EXPECT_TRUE(pockets[0].reach(pocket, 0));
    EXPECT_FALSE(pockets[0].reach(farAway, 0));
    EXPECT_FALSE(pockets[0].reach(farAway, 11000));
    EXPECT_TRUE(pockets[0].reach(farAway, 16000));
}

TEST(Pockets, OfAMeshThatNoLidsCloseAreEverywhere) {
    PackedMesh mesh;
    addBall(mesh, {5000, 5000, 5000}, 3000);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    for (const Pockets& node : findPockets(mesh, std::nullopt, *tree))
        EXPECT_TRUE(node.reach({Vec3(1e6), Vec3(1e6)}, 0));
}

TEST(Pockets, BeyondAFewDozenArePutTogether) {
    PackedMesh mesh;
    for (int i = 0; i < 100; ++i) addBall(mesh, {1000.0 * (i + 1), 5000, 5000}, 10, true, 4);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {64});
    ASSERT_TRUE(tree.ok());
    const Pockets all = findPockets(mesh, findLids(mesh), *tree)[0];
    for (int i = 0; i < 100; ++i) {
        const Vec3 at(1000.0 * (i + 1), 5000, 5000);
        EXPECT_TRUE(all.reach({at - 10.0, at + 10.0}, 0));
        EXPECT_FALSE(all.reach({at + Vec3(0, 50, 0), at + Vec3(10, 60, 0)}, 0));
    }
}

}  // namespace
}  // namespace eyrie::mesh
