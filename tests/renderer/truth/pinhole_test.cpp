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

TEST(Pinhole, ThroughAScreenSeesItsCornersInThePicturesCorners) {
    const Vec3 eye(6e5 + 1, 5e6 - 2, 1000.5);
    const Screen screen{{6e5, 5e6, 1000}, {6e5 + 3, 5e6 + 2, 1000}, {6e5, 5e6, 1002}};
    const Pinhole camera(eye, screen, 640, 480);
    EXPECT_NEAR(glm::distance(*camera.project(screen.lowerLeft), Vec2(0, 0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(*camera.project(screen.lowerRight), Vec2(640, 0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(*camera.project(screen.upperLeft), Vec2(0, 480)), 0, 1e-6);
    const Vec3 beyond = eye + 7.0 * (screen.lowerRight - eye);
    EXPECT_NEAR(glm::distance(*camera.project(beyond), Vec2(640, 0)), 0, 1e-6);
    const Vec3 seen = camera.rayThrough(640, 0).at(camera.depth(beyond));
    EXPECT_NEAR(glm::distance(seen, beyond), 0, 1e-6);
    EXPECT_NEAR(camera.depth(screen.upperLeft), camera.depth(screen.lowerRight), 1e-9);
    EXPECT_FALSE(camera.project(eye + eye - screen.lowerLeft));
}

TEST(Pinhole, ThroughAScreenStraightAheadIsThatOfACamera) {
    const Pinhole camera = northward();  // its picture is 4 x 2 at unit depth
    const Vec3 eye(6e5, 5e6, 1000);
    const Pinhole same(eye, {eye + Vec3(-2, 1, -1), eye + Vec3(2, 1, -1), eye + Vec3(-2, 1, 1)},
                       200, 100);
    for (const Vec2 p : {Vec2(0.5, 0.5), Vec2(100, 50), Vec2(199.5, 3.25)})
        EXPECT_NEAR(glm::distance(same.rayThrough(p.x, p.y).direction,
                                  camera.rayThrough(p.x, p.y).direction),
                    0, 1e-9);
    EXPECT_NEAR(same.focalPixels(), 50, 1e-9);
}

TEST(Pinhole, SampledShowsThePointsNamedAndCountsThePixelsOfThePicture) {
    const Pinhole whole = northward();
    const Pinhole third = whole.sampled({-0.5, 1}, {3, 2}, 60, 40);
    const Ray ray = third.rayThrough(7.5, 4.5);  // pixel (7, 4)
    const Ray same = whole.rayThrough(-0.5 + 7.5 * 3, 1 + 4.5 * 2);
    EXPECT_NEAR(glm::distance(ray.direction, same.direction), 0, 1e-12);
    EXPECT_NEAR(glm::distance(*third.project(ray.at(50)), Vec2(7.5, 4.5)), 0, 1e-8);
    EXPECT_EQ(third.pixelsBetween({1, 1}, {2, 3}), 5);
    EXPECT_EQ(whole.pixelsBetween({1, 1}, {4, 5}), 5);
}

TEST(Pinhole, ProjectsNothingBehindTheEye) {
    EXPECT_FALSE(northward().project(Vec3(6e5, 5e6 - 1, 1000)));
    EXPECT_FALSE(northward().project(Vec3(6e5, 5e6, 1000)));
}

}  // namespace
}  // namespace eyrie::truth
