// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/mesh_ray_caster.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/truth/triangle.h"

namespace eyrie::truth {
namespace {

using fabric::Vec3;

/// A sphere of unit radius around `centre`, `rings` x 2 `rings` quadrilaterals.
TriangleMesh sphere(int rings, const Vec3& centre) {
    TriangleMesh mesh;
    const int sides = 2 * rings;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < sides; ++s) {
            const double polar = std::numbers::pi * r / rings;
            const double around = 2 * std::numbers::pi * s / sides;
            // sin(pi) is not quite 0 and would leave a hole at the south pole.
            const double radius = r == rings ? 0 : std::sin(polar);
            mesh.positions.push_back(centre + Vec3(radius * std::cos(around),
                                                   radius * std::sin(around), std::cos(polar)));
        }
    const auto at = [&](int r, int s) { return static_cast<std::uint32_t>(r * sides + s % sides); };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sides; ++s) {
            mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    return mesh;
}

Vec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(Vec3(normal(random), normal(random), normal(random)));
}

TEST(MeshRayCaster, HitsASphereWhereItIs) {
    const Vec3 centre(5e5, 5e6, 100);
    const int rings = 100;
    const MeshRayCaster caster(sphere(rings, centre));
    const double sag = 1 - std::pow(std::cos(std::numbers::pi / 2 / rings), 2);
    std::mt19937 random(2);
    for (int n = 0; n < 2000; ++n) {
        const Vec3 direction = randomDirection(random);
        const double hit = caster.firstHit({centre - 5.0 * direction, direction});
        EXPECT_GE(hit, 4 - 1e-9);
        EXPECT_LE(hit, 4 + sag + 1e-9);
    }
}

/// A sheet of 20 x 10 squares of a metre, of which one triangle is missing.
TEST(MeshRayCaster, EndsAtHolesAndAtItsRim) {
    TriangleMesh mesh;
    for (int y = 0; y <= 10; ++y)
        for (int x = 0; x <= 20; ++x) mesh.positions.emplace_back(x, y, 7);
    for (std::uint32_t y = 0; y < 10; ++y)
        for (std::uint32_t x = 0; x < 20; ++x) {
            const std::uint32_t a = y * 21 + x;
            mesh.triangles.push_back({a, a + 1, a + 22});
            if (x != 8 || y != 5)
                mesh.triangles.push_back({a, a + 22, a + 21});
        }
    const MeshRayCaster caster(mesh);
    const auto boundsOfEnds = [&](const Vec3& point, double reach) {
        fabric::Box bounds;
        EXPECT_FALSE(caster.endsWithin(point, reach, [&](const Vec3& end) {
            bounds.grow(end);
            return false;
        }));
        return bounds;
    };
    const fabric::Box hole = boundsOfEnds({8.4, 5.6, 7}, 2);
    EXPECT_EQ(hole.min, Vec3(8, 5, 7));
    EXPECT_EQ(hole.max, Vec3(9, 6, 7));
    EXPECT_TRUE(boundsOfEnds({4.5, 5, 7}, 3.4).isEmpty());
    EXPECT_EQ(boundsOfEnds({4.5, 5, 7}, 3.5), fabric::Box({8, 5, 7}, {8, 5, 7}))
        << "a corner of it";
    const fabric::Box rim = boundsOfEnds({20, 3, 7.3}, 0.5);
    EXPECT_EQ(rim.min.x, 20);
    EXPECT_NEAR(rim.min.y, 2.6, 1e-9) << "a circle of 0.4 metres is cut out of the rim";
    EXPECT_NEAR(rim.max.y, 3.4, 1e-9);
    EXPECT_TRUE(boundsOfEnds({15, 5, 17}, 5).isEmpty()) << "above it";
    EXPECT_TRUE(caster.endsWithin({15, 5, 7}, 1e9, [](const Vec3&) { return true; }));
    EXPECT_FALSE(MeshRayCaster(sphere(10, Vec3(0))).endsWithin(Vec3(0), 9, [](const Vec3&) {
        return true;
    })) << "which has none";
}

/// Brute force says the same of the nearest triangle and of the nearest that is surely seen.
TEST(MeshRayCaster, SaysWhereSomethingMayBeSeenAndWhereItSurelyIs) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(-1, 1);
    std::uniform_int_distribution<int> sight(0, 2);
    const auto corner = [&] { return Vec3(place(random), place(random), place(random)); };
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(corner());
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        mesh.sights.push_back(static_cast<Sight>(sight(random)));
    }
    const MeshRayCaster caster(mesh);
    int apart = 0;
    for (int n = 0; n < 2000; ++n) {
        const Vec3 direction = randomDirection(random);
        const Ray ray{corner() - 3.0 * direction, direction};
        const WatertightRay watertight(ray);
        ReferenceSurface::HitRange expected;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle triangle{mesh.positions[3 * i], mesh.positions[3 * i + 1],
                                    mesh.positions[3 * i + 2]};
            const Vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
            const double hit = watertight.hit(triangle);
            expected.first = std::min(expected.first, hit);
            if (mesh.sights[i] == Sight::Sure ||
                (mesh.sights[i] == Sight::SureFromFront && glm::dot(normal, direction) < 0))
                expected.last = std::min(expected.last, hit);
        }
        const ReferenceSurface::HitRange range = caster.hitRange(ray);
        EXPECT_EQ(range.first, expected.first) << "seed 9, ray " << n;
        EXPECT_EQ(range.last, expected.last) << "seed 9, ray " << n;
        apart += range.first < range.last ? 1 : 0;
    }
    EXPECT_GT(apart, 200);
}

TEST(MeshRayCaster, NeverSlipsBetweenTriangles) {
    const TriangleMesh mesh = sphere(24, Vec3(0));
    const MeshRayCaster caster(mesh);
    for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 a = mesh.positions[triangle[i]];
            const Vec3 middle = (a + mesh.positions[triangle[(i + 1) % 3]]) / 2.0;
            for (const Vec3& target : {a, middle})
                ASSERT_LE(caster.firstHit({3.0 * target, -target}), 3);
        }
}

TEST(MeshRayCaster, SeesBothSides) {
    const MeshRayCaster caster(sphere(50, Vec3(0)));
    EXPECT_NEAR(caster.firstHit({Vec3(0.1, 0.2, 0), Vec3(0, 0, 1)}), std::sqrt(0.95), 1e-3);
}

TEST(MeshRayCaster, MissesBesideAndBehind) {
    const MeshRayCaster caster(sphere(20, Vec3(0)));
    EXPECT_EQ(caster.firstHit({Vec3(0, 1.001, -5), Vec3(0, 0, 1)}), kNoHit);
    EXPECT_EQ(caster.firstHit({Vec3(0, 0, 5), Vec3(0, 0, 1)}), kNoHit);
}

TEST(MeshRayCaster, FindsTheClosestPointThatASearchOfAllTrianglesFinds) {
    const TriangleMesh mesh = sphere(12, Vec3(0));
    const MeshRayCaster caster(mesh);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> radius(0, 3);
    for (int n = 0; n < 300; ++n) {
        const Vec3 point = radius(random) * randomDirection(random);
        double nearest = kNoHit;
        for (const auto& t : mesh.triangles)
            nearest = std::min(nearest, glm::distance(point, closestPoint({mesh.positions[t[0]],
                                                                           mesh.positions[t[1]],
                                                                           mesh.positions[t[2]]},
                                                                          point)));
        EXPECT_NEAR(glm::distance(point, *caster.counterpart(point)), nearest, 1e-12);
    }
}

TEST(ClosestPoint, IsOnTheFaceAnEdgeOrACorner) {
    const Triangle triangle{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    const auto expectClosest = [&](const Vec3& point, const Vec3& expected) {
        EXPECT_NEAR(glm::distance(closestPoint(triangle, point), expected), 0, 1e-12);
    };
    expectClosest({1, 1, 7}, {1, 1, 0});
    expectClosest({2, -3, 1}, {2, 0, 0});
    expectClosest({3, 3, 0}, {2, 2, 0});
    expectClosest({-1, 2, 0}, {0, 2, 0});
    expectClosest({-1, -1, 5}, {0, 0, 0});
    expectClosest({9, -1, 0}, {4, 0, 0});
    expectClosest({-1, 9, 0}, {0, 4, 0});
}

TEST(MeshRayCaster, FindsTheClosestPointBesideTrianglesWithoutArea) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}},
                            {{3, 3, 3}, {0, 1, 2}, {0, 0, 1}}};
    const MeshRayCaster caster(mesh);
    for (int again = 0; again < 3; ++again) {
        EXPECT_EQ(*caster.counterpart({0.25, 0.25, 2}), Vec3(0.25, 0.25, 0));
        EXPECT_EQ(*caster.counterpart({-1, 0, 0}), Vec3(0, 0, 0));
    }
}

/// Beside a corner where three triangles hang together, a seam opens past the first and the last of
/// them, and what a ray hits may be the one between, of which both edges go on.
TEST(MeshRayCaster, LooksThroughSeamsBesideCorners) {
    TriangleMesh mesh;
    mesh.positions = {{0, 10, 0},  {-10, 10, 0}, {-5, 10, 10}, {5, 10, 10},
                      {10, 10, 0}, {-9, 20, -9}, {9, 20, -9},  {0, 20, 9}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {5, 6, 7}};
    const MeshRayCaster fan(std::move(mesh));
    EXPECT_NEAR(fan.throughSeams({{0, 0, 0}, {0, 10, 5e-4}}, 1e-3).last, 2, 1e-12);
    EXPECT_NEAR(fan.throughSeams({{0, 0, 0}, {0, 10, 2e-3}}, 1e-3).last, 1, 1e-12);
    EXPECT_NEAR(fan.hitRange({{0, 0, 0}, {0, 10, 5e-4}}).last, 1, 1e-12);
}

TEST(MeshRayCaster, LooksThroughSeamsThatTrianglesWithoutAreaClose) {
    // A wall above an edge and two below it, that meet inside of it; the triangle between these
    // three corners is a line but for rounding. A wall behind.
    TriangleMesh mesh;
    mesh.positions = {{-9, 10, 0}, {9, 10, 0},   {0, 10, 9},  {1.1, 10, -1e-7}, {-5, 10, -9},
                      {5, 10, -9}, {-9, 20, -9}, {9, 20, -9}, {0, 20, 9}};
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {3, 5, 1}, {0, 3, 1}, {6, 7, 8}};
    const Ray above{{0, 0, 0}, {0.1, 10, 5e-4}};
    EXPECT_NEAR(MeshRayCaster(mesh).throughSeams(above, 1e-3).last, 2, 1e-12);
    mesh.positions[3].z = -0.5;
    EXPECT_NEAR(MeshRayCaster(mesh).throughSeams(above, 1e-3).last, 1, 1e-12);
}

/// The same wall where maps have it: what is two metres high there is no line.
TEST(MeshRayCaster, FarFromTheOriginTrianglesHaveAreaAsNearIt) {
    const Vec3 there(5e5, 5e6, 100);
    TriangleMesh mesh;
    mesh.positions = {{-9, 10, 0}, {9, 10, 0},   {0, 10, 9},  {1.1, 10, -2}, {-5, 10, -9},
                      {5, 10, -9}, {-9, 20, -9}, {9, 20, -9}, {0, 20, 9}};
    for (Vec3& position : mesh.positions) position += there;
    mesh.triangles = {{0, 1, 2}, {0, 4, 3}, {3, 5, 1}, {0, 3, 1}, {6, 7, 8}};
    const MeshRayCaster caster(mesh);
    EXPECT_NEAR(caster.throughSeams({there, {0.1, 10, 5e-4}}, 1e-3).last, 1, 1e-9);
}

TEST(MeshRayCaster, LooksThroughWhereWhatGoesOnIsSeenFromBehind) {
    // A triangle, one on its lower side that is drawn from the front alone, and a wall behind.
    const auto hung = [](bool isFront) {
        TriangleMesh mesh;
        mesh.positions = {{-9, 10, 0},  {9, 10, 0},  {0, 10, 9}, {0, 10, -9},
                          {-9, 20, -9}, {9, 20, -9}, {0, 20, 9}};
        mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {4, 5, 6}};
        if (!isFront)
            std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
        mesh.sights = {Sight::Sure, Sight::SureFromFront, Sight::Sure};
        return MeshRayCaster(std::move(mesh));
    };
    const Ray above{{0, 0, 0}, {0, 10, 5e-4}};
    EXPECT_NEAR(hung(true).throughSeams(above, 1e-3).last, 1, 1e-12);
    EXPECT_NEAR(hung(false).throughSeams(above, 1e-3).last, 2, 1e-12);
}

}  // namespace
}  // namespace eyrie::truth
