// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/star.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/mesh/lod/shifts.h"

namespace eyrie::mesh {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

double number(double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1000) / 1000.0;
}

/// A random wheel about the origin, tilted any way; the higher, the more folded.
std::vector<glm::dvec3> randomRing(double height) {
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
                       z * number(-height, height));
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

double longest(const Star::Shift& shift) { return std::max(-shift.least, shift.most); }

/// Every old triangle whose points are partners of a new one's is named, or this finds points of
/// the new too far from those named.
void checkDistances(const std::vector<glm::dvec3>& ring, const Star& star) {
    for (std::size_t target = 0; target < ring.size(); ++target) {
        const auto landing = star.landing(target);
        if (!landing)
            continue;
        Star::Outcome outcome;
        star.moveTo(target, *landing, outcome);
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
            RC_ASSERT(farthest({left.back()}, partners) <= longest(by.shift) + 1e-6);
            largest = std::max(largest, longest(by.shift));
        }
        RC_ASSERT(farthest(replaced, left) <= largest + 1e-6);
    }
}

RC_GTEST_PROP(Star, ItsDistancesBoundWhatSamplingFindsEitherWay, ()) {
    const std::vector<glm::dvec3> ring = randomRing(40);
    const Star star(glm::dvec3(0.0), ring);
    RC_PRE(star.isGraph());
    checkDistances(ring, star);
}

RC_GTEST_PROP(Star, ThatIsFoldedHasDistancesThatBoundWhatSamplingFinds, ()) {
    const std::vector<glm::dvec3> ring = randomRing(200);
    const Star star(glm::dvec3(0.0), ring);
    RC_PRE(star.isFlat() && !star.isGraph());
    checkDistances(ring, star);
}

/// Of a graph a partner is found along the normal, so the points where the shift is extreme are.
RC_GTEST_PROP(Star, SaysWhichWayItsPointsGo, ()) {
    const std::vector<glm::dvec3> ring = randomRing(40);
    const Star star(glm::dvec3(0.0), ring);
    RC_PRE(star.isGraph());
    for (std::size_t target = 0; target < ring.size(); ++target) {
        const auto landing = star.landing(target);
        if (!landing)
            continue;
        const std::size_t triangle = (target + landing->triangle) % ring.size();
        const Triangle t = after(ring, target, triangle);
        const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
        const double height = glm::dot(normal, t[0]) / glm::dot(normal, star.normal());
        RC_ASSERT(std::abs(landing->shift.least + landing->shift.most - height) < 1e-6);
        Star::Outcome outcome;
        star.moveTo(target, *landing, outcome);
        RC_ASSERT(outcome[triangle].shift.least <= landing->shift.least);
        RC_ASSERT(outcome[triangle].shift.most >= landing->shift.most);
    }
}

TEST(Star, OfAPlaneLosesNothing) {
    const std::vector<glm::dvec3> ring = {{10, 0, 0}, {0, 10, 0}, {-10, 0, 0}, {0, -10, 0}};
    const Star star(glm::dvec3(0.0), ring);
    ASSERT_TRUE(star.isGraph());
    for (std::size_t target = 0; target < 4; ++target) {
        const auto landing = star.landing(target);
        ASSERT_TRUE(landing);
        Star::Outcome outcome;
        star.moveTo(target, *landing, outcome);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(longest(outcome[i].shift), 0, 1e-12);
    }
}

TEST(Star, OfAPyramidLosesItsHeight) {
    const std::vector<glm::dvec3> ring = {{10, 0, -5}, {0, 10, -5}, {-10, 0, -5}, {0, -10, -5}};
    const Star star(glm::dvec3(0.0), ring);
    ASSERT_TRUE(star.isGraph());
    const auto landing = star.landing(0);
    ASSERT_TRUE(landing);
    EXPECT_NEAR(landing->shift.least, -5, 1e-12);
    Star::Outcome outcome;
    star.moveTo(0, *landing, outcome);
    EXPECT_NEAR(std::min(outcome[1].shift.least, outcome[2].shift.least), -5, 1e-12);
    EXPECT_EQ(std::max(outcome[1].shift.most, outcome[2].shift.most), 0);
    EXPECT_EQ(outcome[0].triangles, 0U);
    EXPECT_EQ(outcome[3].triangles, 0U);
}

TEST(Star, ThatOverhangsIsNoGraph) {
    // The ring turns back on itself: seen along the mean normal one face looks away.
    const std::vector<glm::dvec3> ring = {{10, 0, 0},  {0, 10, 0},   {-10, 0, 0},
                                          {-8, -9, 0}, {-9, 9, -30}, {0, -10, 0}};
    const Star star(glm::dvec3(0.0), ring);
    EXPECT_FALSE(star.isGraph());
    EXPECT_TRUE(star.isFlat());
}

TEST(Star, ThatGoesAroundTwiceIsNoGraph) {
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < 10; ++i)
        ring.emplace_back(10 * std::cos(0.4 * M_PI * i), 10 * std::sin(0.4 * M_PI * i), i);
    EXPECT_FALSE(Star(glm::dvec3(0.0), ring).isGraph());
}

RC_GTEST_PROP(Shifts, HoldEveryWayThatTheyAreMadeOf, ()) {
    Shifts all;
    std::vector<glm::dvec3> ways(4, glm::dvec3(0.0));
    for (int step = 0; step < 12; ++step) {
        const glm::dvec3 along = glm::normalize(glm::dvec3(number(-1, 1), number(-1, 1), 1.001));
        const double least = number(-100, 0);
        const double most = number(0, 100);
        if (step % 4 == 3) {
            all = all.andThen(static_cast<float>(most));
            for (glm::dvec3& way : ways)
                way += most * glm::normalize(glm::dvec3(number(-1, 1), number(-1, 1), 1.001));
        } else {
            all =
                all.andThen(glm::vec3(along), static_cast<float>(least), static_cast<float>(most));
            for (glm::dvec3& way : ways) way += number(least, most) * along;
        }
        Shifts more;
        more.hold(all);
        for (const glm::dvec3& way : ways) RC_ASSERT(glm::length(way) <= more.longest());
    }
}

TEST(Shifts, ThatGoUpAndDownAreNoLongerThanTheLongerWay) {
    const glm::vec3 up(0, 0, 1);
    const Shifts shifts = Shifts().andThen(up, 0, 3).andThen(up, -4, 0).andThen(up, 0, 0.5);
    EXPECT_NEAR(shifts.longest(), 4, 1e-3);
}

TEST(Shifts, AlongADiagonalAreNoLongerThanTheyAre) {
    const glm::vec3 along = glm::normalize(glm::vec3(1, 1, 1));
    const glm::vec3 across = glm::normalize(glm::vec3(1, -1, 0));
    EXPECT_NEAR(Shifts().andThen(along, -1, 2).longest(), 2, 1e-3);
    EXPECT_LE(Shifts().andThen(along, -1, 1).andThen(across, -1, 1).longest(), 2.001);
}

}  // namespace
}  // namespace eyrie::mesh
