// SPDX-License-Identifier: Apache-2.0
#include "fabric/frustum.h"

#include <limits>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

Vec4 project(const Frustum& frustum, const Vec3& inView) {
    const Vec4 clip = clipFromView(frustum, kNearMetres) * Vec4(inView, 1.0);
    return clip / clip.w;
}

TEST(Frustum, SpansItsFieldOfView) {
    const Frustum frustum = symmetricFrustum(90, 2);
    EXPECT_DOUBLE_EQ(frustum.top, 1);
    EXPECT_DOUBLE_EQ(frustum.bottom, -1);
    EXPECT_DOUBLE_EQ(frustum.right, 2);
    EXPECT_DOUBLE_EQ(frustum.left, -2);
}

TEST(Frustum, ItsCornersAreThePicturesCorners) {
    const Frustum offAxis{-0.25, 1.5, -0.5, 2};
    const Vec4 lowerLeft = project(offAxis, Vec3(-0.25, -0.5, -1) * 7.0);
    EXPECT_NEAR(lowerLeft.x, -1, 1e-12);
    EXPECT_NEAR(lowerLeft.y, -1, 1e-12);
    const Vec4 upperRight = project(offAxis, Vec3(1.5, 2, -1) * 0.3);
    EXPECT_NEAR(upperRight.x, 1, 1e-12);
    EXPECT_NEAR(upperRight.y, 1, 1e-12);
}

TEST(Frustum, DepthIsOneAtTheNearPlaneAndFallsTowardsZero) {
    const Frustum frustum = symmetricFrustum(45, 1);
    EXPECT_DOUBLE_EQ(project(frustum, {0, 0, -kNearMetres}).z, 1);
    EXPECT_GT(project(frustum, {0, 0, -10}).z, project(frustum, {0, 0, -11}).z);
    EXPECT_GT(project(frustum, {0, 0, -1e12}).z, 0);
}

TEST(Frustum, ViewDepthUndoesTheProjection) {
    const Frustum frustum = symmetricFrustum(45, 1);
    for (const double depth : {0.5, 3.0, 40'000.0})
        EXPECT_NEAR(viewDepthMetres(project(frustum, {0, 0, -depth}).z, kNearMetres), depth,
                    1e-9 * depth);
    EXPECT_EQ(viewDepthMetres(0, kNearMetres), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace eyrie::fabric
