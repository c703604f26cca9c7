// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::mesh {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

constexpr double kAny = std::numeric_limits<double>::infinity();

double number(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1000) / 1000.0;
}

/// A random wheel about the origin, tilted any way.
std::vector<glm::dvec3> randomRing() {
    const std::size_t count = *rc::gen::inRange<std::size_t>(3, 9);
    const glm::dvec3 z = glm::normalize(glm::dvec3(number(-1, 1), number(-1, 1), 1.001));
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0.1), z));
    const glm::dvec3 y = glm::cross(z, x);
    std::vector<glm::dvec3> ring;
    for (std::size_t i = 0; i < count; ++i) {
        const double angle =
            2 * M_PI * (static_cast<double>(i) + number(-0.4, 0.4)) / static_cast<double>(count);
        const double radius = number(20, 100);
        ring.push_back(x * (radius * std::cos(angle)) + y * (radius * std::sin(angle)) +
                       z * number(-40, 40));
    }
    return ring;
}

Triangle before(const std::vector<glm::dvec3>& ring, std::size_t i) {
    return {glm::dvec3(0.0), ring[i], ring[(i + 1) % ring.size()]};
}

Triangle after(const std::vector<glm::dvec3>& ring, std::size_t target, std::size_t i) {
    return {ring[target], ring[i], ring[(i + 1) % ring.size()]};
}

double distance(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const double along = glm::dot(point - a, b - a) / glm::dot(b - a, b - a);
    return glm::length(a + std::clamp(along, 0.0, 1.0) * (b - a) - point);
}

/// To the plane, where the foot is inside, or to the nearest side.
double distance(const glm::dvec3& point, const Triangle& t) {
    const glm::dvec3 normal = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    bool isInside = true;
    double nearest = 1e300;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& a = t[i];
        const glm::dvec3& b = t[(i + 1) % 3];
        isInside = isInside && glm::dot(normal, glm::cross(b - a, point - a)) >= 0;
        nearest = std::min(nearest, distance(point, a, b));
    }
    return isInside ? std::abs(glm::dot(normal, point - t[0])) : nearest;
}

double farthest(const std::vector<Triangle>& from, const std::vector<Triangle>& to) {
    double worst = 0;
    constexpr int kSteps = 8;
    for (const Triangle& triangle : from)
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j) {
                const glm::dvec3 point = triangle[0] +
                                         double(i) / kSteps * (triangle[1] - triangle[0]) +
                                         double(j) / kSteps * (triangle[2] - triangle[0]);
                double nearest = 1e300;
                for (const Triangle& other : to)
                    nearest = std::min(nearest, distance(point, other));
                worst = std::max(worst, nearest);
            }
    return worst;
}

/// Every old triangle whose points are partners of a new one's is named, or this finds points of
/// the new too far from those named.
RC_GTEST_PROP(Star, ItsDistancesBoundWhatSamplingFindsEitherWay, ()) {
    const std::vector<glm::dvec3> ring = randomRing();
    const Star star(glm::dvec3(0.0), ring);
    if (!star.isGraph())
        return;
    for (std::size_t target = 0; target < ring.size(); ++target) {
        Star::Outcome outcome;
        if (!star.movedTo(target, kAny, outcome))
            continue;
        double largest = 0;
        std::vector<Triangle> left;
        std::vector<Triangle> replaced;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            replaced.push_back(before(ring, i));
            const Star::Replaced& by = outcome[i];
            RC_ASSERT((by.triangles == 0) ==
                      (i == target || i == (target + ring.size() - 1) % ring.size()));
            if (by.triangles == 0)
                continue;
            std::vector<Triangle> partners;
            for (std::size_t k = 0; k < ring.size(); ++k)
                if ((by.triangles >> k & 1) != 0)
                    partners.push_back(before(ring, k));
            left.push_back(after(ring, target, i));
            RC_ASSERT(farthest({left.back()}, partners) <= by.distance + 1e-6);
            largest = std::max(largest, by.distance);
        }
        RC_ASSERT(farthest(replaced, left) <= largest + 1e-6);
    }
}

TEST(Star, OfAPlaneLosesNothing) {
    const std::vector<glm::dvec3> ring = {{10, 0, 0}, {0, 10, 0}, {-10, 0, 0}, {0, -10, 0}};
    const Star star(glm::dvec3(0.0), ring);
    ASSERT_TRUE(star.isGraph());
    for (std::size_t target = 0; target < 4; ++target) {
        Star::Outcome outcome;
        ASSERT_TRUE(star.movedTo(target, kAny, outcome));
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(outcome[i].distance, 0, 1e-12);
    }
}

TEST(Star, OfAPyramidLosesItsHeight) {
    const std::vector<glm::dvec3> ring = {{10, 0, -5}, {0, 10, -5}, {-10, 0, -5}, {0, -10, -5}};
    const Star star(glm::dvec3(0.0), ring);
    ASSERT_TRUE(star.isGraph());
    Star::Outcome outcome;
    ASSERT_TRUE(star.movedTo(0, kAny, outcome));
    EXPECT_NEAR(std::max(outcome[1].distance, outcome[2].distance), 5, 1e-12);
    EXPECT_EQ(outcome[0].triangles, 0U);
    EXPECT_EQ(outcome[3].triangles, 0U);
    EXPECT_FALSE(star.movedTo(0, 4.9, outcome));
}

TEST(Star, ThatOverhangsIsNoGraph) {
    // The ring turns back on itself: seen along the mean normal one face looks away.
    const std::vector<glm::dvec3> ring = {{10, 0, 0},  {0, 10, 0},   {-10, 0, 0},
                                          {-8, -9, 0}, {-9, 9, -30}, {0, -10, 0}};
    EXPECT_FALSE(Star(glm::dvec3(0.0), ring).isGraph());
}

TEST(Star, ThatGoesAroundTwiceIsNoGraph) {
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < 10; ++i)
        ring.emplace_back(10 * std::cos(0.4 * M_PI * i), 10 * std::sin(0.4 * M_PI * i), i);
    EXPECT_FALSE(Star(glm::dvec3(0.0), ring).isGraph());
}

}  // namespace
}  // namespace eyrie::mesh
