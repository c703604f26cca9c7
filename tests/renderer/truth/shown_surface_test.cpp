// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/shown_surface.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/truth/reference_surface.h"

namespace eyrie::truth {
namespace {

using fabric::Vec3;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// At the origin, looking north; 64 pixels to a unit of tangent.
Pinhole northward() {
    fabric::Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 1, 0};
    camera.up = {0, 0, 1};
    camera.fovYDegrees = 2 * std::atan(kHeight / 2.0 / 64) * 180 / M_PI;
    return Pinhole(camera, kWidth, kHeight);
}

TEST(ShownSurface, ShowsWhatIsBesideAPixelAndEdgeOn) {
    // Seen along its plane, which is half a reach to the right of the picture's middle.
    const double aside = ShownSurface::kReachPixels / 2 / 64;
    const std::vector<Triangle> wall{
        {Vec3(10 * aside, 10, -2), Vec3(30 * aside, 30, -2), Vec3(20 * aside, 20, 9)}};
    const Pinhole camera = northward();
    const ShownSurface shown(wall, camera);
    const auto found = shown.at(kWidth / 2.0, kHeight / 2.0, 20);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->point.x, aside * found->point.y, 1e-9);
    EXPECT_NEAR(found->point.z, 0, 1e-9);
    EXPECT_FALSE(shown.at(kWidth / 2.0 + 0.1, kHeight / 2.0, 20));
}

TEST(ShownSurface, KnowsWhichDepthsATriangleMayHave) {
    // Facing the eye, and a slope of a metre a metre, 20 m away.
    for (const double slope : {0.0, 1.0}) {
        const std::vector<Triangle> plate{
            {Vec3(-9, 20 - 9 * slope, -9), Vec3(9, 20 + 9 * slope, -9), Vec3(0, 20, 9)}};
        const Pinhole camera = northward();
        const ShownSurface shown(plate, camera);
        const double x = kWidth / 2.0, y = kHeight / 2.0;
        const auto mayHave = [&](double depth) { return shown.at(x, y, depth)->mayHaveDepth; };
        const double withinReach = slope * 20 * ShownSurface::kReachPixels / 64;
        const double rounding = 20 * 2e-5;
        EXPECT_TRUE(mayHave(20));
        EXPECT_TRUE(mayHave(20 + 0.9 * withinReach) && mayHave(20 - 0.9 * withinReach));
        EXPECT_FALSE(mayHave(20 + 1.1 * withinReach + rounding)) << slope;
        EXPECT_FALSE(mayHave(20 - 1.1 * withinReach - rounding)) << slope;
        EXPECT_FALSE(mayHave(kNoHit));
    }
}

/// Facing the eye, 20 m away: 1 pixel thick and so many long.
TEST(ShownSurface, AllowsForWhatSinglePrecisionMakesOfASliver) {
    const Pinhole camera = northward();
    const auto mayHave = [&](double lengthPixels, double depth) {
        const double size = 20 / 64.0;
        const std::vector<Triangle> sliver{{Vec3(-size * lengthPixels / 2, 20, -size / 2),
                                            Vec3(size * lengthPixels / 2, 20, -size / 2),
                                            Vec3(0, 20, size / 2)}};
        const ShownSurface shown(sliver, camera);
        return shown.at(kWidth / 2.0, kHeight / 2.0, depth)->mayHaveDepth;
    };
    for (const double length : {10.0, 100.0, 1000.0}) {
        const double share = 88 * 0x1p-24 * length;
        EXPECT_TRUE(mayHave(length, 20 * (1 + 0.9 * share))) << length;
        EXPECT_TRUE(mayHave(length, 20 * (1 - 0.9 * share))) << length;
        EXPECT_FALSE(mayHave(length, 20 * (1 + 1.1 * share))) << length;
        EXPECT_FALSE(mayHave(length, 20 * (1 - 1.1 * share))) << length;
    }
}

TEST(ShownSurface, GivesATriangleSeenEdgeOnAnyDepth) {
    const std::vector<Triangle> wall{{Vec3(0, 10, -2), Vec3(0, 30, -2), Vec3(0, 20, 9)}};
    const Pinhole camera = northward();
    const ShownSurface shown(wall, camera);
    for (const double depth : {1.0, 20.0, 1000.0}) {
        const auto found = shown.at(kWidth / 2.0, kHeight / 2.0, depth);
        ASSERT_TRUE(found);
        EXPECT_TRUE(found->mayHaveDepth) << depth;
    }
}

TEST(ShownSurface, NamesWhatMayHaveTheDepthBeforeWhatIsNearerToIt) {
    // A plate 20 m away and, right before the picture's middle, a wall seen along its plane, whose
    // depth there is 10 m.
    const double aside = ShownSurface::kReachPixels / 2 / 64;
    const std::vector<Triangle> both{
        {Vec3(-9, 20, -9), Vec3(9, 20, -9), Vec3(0, 20, 9)},
        {Vec3(10 * aside, 10, -2), Vec3(12 * aside, 12, -2), Vec3(11 * aside, 11, 9)}};
    const Pinhole camera = northward();
    const ShownSurface shown(both, camera);
    const auto nameOf = [&](double depth) {
        return shown.at(kWidth / 2.0, kHeight / 2.0, depth)->triangle;
    };
    EXPECT_EQ(nameOf(20), 0U);
    EXPECT_EQ(nameOf(19), 1U);
}

TEST(ShownSurface, KnowsWhatHasASideAtThePoint) {
    const std::vector<Triangle> plate{{Vec3(-9, 20, -9), Vec3(9, 20, -9), Vec3(0, 20, 9)}};
    const Pinhole camera = northward();
    const ShownSurface shown(plate, camera);
    const double bottom = kHeight / 2.0 - 64 * 9 / 20.0;
    const auto isAtEnd = [&](double above) {
        return shown.at(kWidth / 2.0, bottom + above, 20)->isAtEnd;
    };
    EXPECT_TRUE(isAtEnd(-0.9 * ShownSurface::kReachPixels));
    EXPECT_TRUE(isAtEnd(0.9 * ShownSurface::kReachPixels));
    EXPECT_FALSE(isAtEnd(1.1 * ShownSurface::kReachPixels));
    EXPECT_FALSE(isAtEnd(5));
}

/// Four triangles around the picture's middle, of which those to the left and right may be missing,
/// or stand on other corners, or be folded back.
TEST(ShownSurface, EndsWhereNoTriangleGoesOn) {
    const Pinhole camera = northward();
    const Vec3 middle(0, 20, 0), left(-9, 20, -1), right(9, 20, -1), above(0, 20, 9),
        below(0, 20, -9);
    const std::vector<Triangle> around{{middle, right, above},
                                       {middle, above, left},
                                       {middle, left, below},
                                       {middle, below, right}};
    const auto isAtEnd = [&](const std::vector<Triangle>& triangles, double x, double y) {
        const ShownSurface shown(triangles, camera);
        return shown.at(kWidth / 2.0 + x, kHeight / 2.0 + y, 20)->isAtEnd;
    };
    EXPECT_FALSE(isAtEnd(around, 0, 0)) << "all of them share the corner";
    EXPECT_FALSE(isAtEnd(around, 0, 5)) << "two share the side";
    auto open = around;
    open.pop_back();
    EXPECT_TRUE(isAtEnd(open, 0, 0)) << "one is missing there";
    EXPECT_TRUE(isAtEnd(open, 0, -5));
    EXPECT_FALSE(isAtEnd(open, 0, 5)) << "not here";
    auto apart = around;
    apart[1][1].z += 1e-9;
    EXPECT_TRUE(isAtEnd(apart, 0, 5)) << "their sides are not the same";
    auto folded = around;
    folded[1][2] = Vec3(8, 21, 1);
    EXPECT_TRUE(isAtEnd(folded, 0, 5)) << "both lie to the right";
}

TEST(ShownSurface, ShowsWhatReachesBehindTheEye) {
    const std::vector<Triangle> roof{{Vec3(-100, 200, 5), Vec3(100, 200, 5), Vec3(0, -500, 5)},
                                     {Vec3(-100, -2, 5), Vec3(100, -2, 5), Vec3(0, -500, 5)}};
    const Pinhole camera = northward();
    const ShownSurface shown(roof, camera);
    const auto found = shown.at(kWidth / 2.0, kHeight / 2.0 + 16, 20);
    ASSERT_TRUE(found);
    EXPECT_NEAR(glm::distance(found->point, Vec3(0, 20, 5)), 0, 1e-9);
    EXPECT_FALSE(shown.at(kWidth / 2.0, kHeight / 2.0 - 16, 20)) << "nothing below the horizon";
}

TEST(ShownSurface, ShowsWhatARayHitsAtItsDepth) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> aside(-30, 30), along(-20, 40);
    const auto corner = [&] { return Vec3(aside(random), along(random), aside(random)); };
    std::vector<Triangle> triangles;
    for (int i = 0; i < 300; ++i) triangles.push_back({corner(), corner(), corner()});
    const Pinhole camera = northward();
    const ShownSurface shown(triangles, camera);
    std::uniform_real_distribution<double> column(0, kWidth), row(0, kHeight);
    int hits = 0;
    for (int n = 0; n < 500; ++n) {
        const double x = column(random), y = row(random);
        const Ray ray = camera.rayThrough(x, y);
        const WatertightRay watertight(ray);
        for (const Triangle& triangle : triangles) {
            const double depth = watertight.hit(triangle);
            if (depth < 0.01 || depth == kNoHit)
                continue;
            ++hits;
            const auto found = shown.at(x, y, depth);
            ASSERT_TRUE(found) << "seed 11, point " << n;
            EXPECT_LT(glm::distance(found->point, ray.at(depth)), 1e-6 * depth)
                << "seed 11, point " << n;
            EXPECT_NEAR(watertight.hit(triangles[found->triangle]), depth, 1e-6 * depth);
        }
    }
    EXPECT_GT(hits, 5000);
}

}  // namespace
}  // namespace eyrie::truth
