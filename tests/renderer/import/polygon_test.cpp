// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::import {
namespace {

using fabric::Vec3;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles triangulated(const std::vector<Vec3>& ring) {
    std::vector<std::uint32_t> corners(ring.size());
    std::iota(corners.begin(), corners.end(), 0U);
    Triangles triangles;
    EXPECT_TRUE(triangulatePolygon(ring, corners, triangles));
    return triangles;
}

double doubleArea(const std::vector<Vec3>& ring, const std::array<std::uint32_t, 3>& t) {
    return glm::length(glm::cross(ring[t[1]] - ring[t[0]], ring[t[2]] - ring[t[0]]));
}

/// Twice the area the triangles cover, each counted by itself: equal to the polygon's only when
/// they neither overlap nor leave it.
double coveredDoubleArea(const std::vector<Vec3>& ring, const Triangles& triangles) {
    double sum = 0;
    for (const auto& triangle : triangles) sum += doubleArea(ring, triangle);
    return sum;
}

double doubleAreaOf(const std::vector<Vec3>& ring) {
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i)
        sum += glm::cross(ring[i], ring[(i + 1) % ring.size()]);
    return glm::length(sum);
}

/// A star-shaped ring of points with the given radii, on a tilted plane far from the origin.
std::vector<Vec3> star(const std::vector<double>& radii, bool clockwise) {
    std::vector<Vec3> ring;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const double angle = (clockwise ? -2 : 2) * std::numbers::pi * static_cast<double>(i) /
                             static_cast<double>(radii.size());
        const double x = radii[i] * std::cos(angle);
        const double y = radii[i] * std::sin(angle);
        ring.emplace_back(x, y, 1 + 0.5 * x - 0.25 * y);
    }
    return ring;
}

RC_GTEST_PROP(Polygon, IsCoveredOnceByItsTrianglesInItsOwnTurn, ()) {
    const auto sizes =
        *rc::gen::container<std::vector<int>>(*rc::gen::inRange(4, 40), rc::gen::inRange(1, 100));
    const std::vector<Vec3> ring =
        star(std::vector<double>(sizes.begin(), sizes.end()), *rc::gen::arbitrary<bool>());
    const Triangles triangles = triangulated(ring);
    RC_ASSERT(triangles.size() == ring.size() - 2);
    RC_ASSERT(std::abs(coveredDoubleArea(ring, triangles) - doubleAreaOf(ring)) <
              1e-9 * doubleAreaOf(ring));
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < ring.size(); ++i)
        normal += glm::cross(ring[i] - ring[0], ring[(i + 1) % ring.size()] - ring[0]);
    for (const auto& [a, b, c] : triangles)
        RC_ASSERT(glm::dot(glm::cross(ring[b] - ring[a], ring[c] - ring[a]), normal) > 0);
}

TEST(Polygon, ConvexIsAFanFromItsFirstCorner) {
    EXPECT_EQ(triangulated(star({1, 1, 1, 1, 1}, false)),
              (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygon, ConcaveQuadIsCutAlongTheDiagonalInside) {
    const std::vector<Vec3> dart = {{0, 0, 0}, {4, 2, 0}, {0, 4, 0}, {1, 2, 0}};
    const Triangles triangles = triangulated(dart);
    EXPECT_NEAR(coveredDoubleArea(dart, triangles), doubleAreaOf(dart), 1e-12);
}

TEST(Polygon, OfTenThousandCornersIsTriangulated) {
    const std::vector<double> round(10000, 5.0);
    std::vector<double> jagged = round;
    for (std::size_t i = 0; i < jagged.size(); i += 2) jagged[i] = 4.9;
    for (const auto& radii : {round, jagged}) {
        const std::vector<Vec3> ring = star(radii, false);
        const Triangles triangles = triangulated(ring);
        EXPECT_EQ(triangles.size(), 9998U);
        EXPECT_NEAR(coveredDoubleArea(ring, triangles), doubleAreaOf(ring), 1e-6);
    }
}

TEST(Polygon, ConcaveBeyondTheLimitIsLeftAlone) {
    std::vector<double> jagged(kMaxConcaveCorners + 2, 5.0);
    for (std::size_t i = 0; i < jagged.size(); i += 2) jagged[i] = 4;
    const std::vector<Vec3> ring = star(jagged, false);
    std::vector<std::uint32_t> corners(ring.size());
    std::iota(corners.begin(), corners.end(), 0U);
    Triangles triangles;
    EXPECT_FALSE(triangulatePolygon(ring, corners, triangles));
    EXPECT_TRUE(triangles.empty());
}

TEST(Polygon, ThatCrossesItselfOrHasNoAreaStillGivesItsTriangles) {
    EXPECT_EQ(triangulated({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2U);
    EXPECT_EQ(triangulated(std::vector<Vec3>(6, Vec3(3, 3, 3))).size(), 4U);
    EXPECT_EQ(triangulated({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0, 0, 0}}).size(), 3U);
    EXPECT_EQ(triangulated({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {2, 1, 0}, {0, 1, 0}}).size(), 3U);
}

}  // namespace
}  // namespace eyrie::import
