// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/pinhole.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace eyrie::truth {
namespace {

using fabric::Camera;
using fabric::Vec2;
using fabric::Vec3;

/// Looks north over UTM-sized coordinates, 90 degrees, so that the focal length is 50 of 100 rows.
Pinhole northward() {
    return Pinhole({.eye = {6e5, 5e6, 1000}, .target = {6e5, 5e6 + 1, 1000}, .fovYDegrees = 90},
                   200, 100);
}

TEST(Pinhole, LooksAtItsTargetThroughTheMiddleOfThePicture) {
    const Ray ray = northward().rayThrough(100, 50);
    EXPECT_NEAR(glm::distance(ray.direction, Vec3(0, 1, 0)), 0, 1e-15);
}

TEST(Pinhole, PutsEastOnTheRightAndUpAtTheTop) {
    const Pinhole camera = northward();
    const auto p = camera.project(Vec3(6e5 + 10, 5e6 + 20, 1000 + 4));
    ASSERT_TRUE(p);
    EXPECT_NEAR(p->x, 100 + 50 * 10 / 20.0, 1e-9);
    EXPECT_NEAR(p->y, 50 + 50 * 4 / 20.0, 1e-9);
}

TEST(Pinhole, ProjectsAPointOfARayBackToItsPixel) {
    const Pinhole camera(
        {.eye = {6e5, 5e6, 3000}, .target = {6.1e5, 5.02e6, 500}, .fovYDegrees = 35}, 1280, 720);
    for (const Vec2 pixel : {Vec2(0.5, 0.5), Vec2(640, 360), Vec2(1279.5, 3.25)}) {
        const Vec3 point = camera.rayThrough(pixel.x, pixel.y).at(12345);
        EXPECT_NEAR(glm::distance(*camera.project(point), pixel), 0, 1e-8);
        EXPECT_NEAR(camera.depth(point), 12345, 1e-8);
    }
}

TEST(Pinhole, ProjectsNothingBehindTheEye) {
    EXPECT_FALSE(northward().project(Vec3(6e5, 5e6 - 1, 1000)));
    EXPECT_FALSE(northward().project(Vec3(6e5, 5e6, 1000)));
}

}  // namespace
}  // namespace eyrie::truth
