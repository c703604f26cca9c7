// SPDX-License-Identifier: Apache-2.0
#include "fabric/smaller_picture.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/frustum.h"

namespace eyrie::fabric {
namespace {

TEST(SmallerPicture, HasTheShapeOfWholeRatios) {
    const PictureSides moving = smallerPicture(1920, 1080, 0.761);
    EXPECT_EQ(moving.width, 1456);
    EXPECT_EQ(moving.height, 819);
    EXPECT_EQ(shapeErrorPixels(1920, 1080, moving), 0);
    const PictureSides odd = smallerPicture(1280, 721, 0.5);
    EXPECT_EQ(odd.width, 632);
    EXPECT_EQ(odd.height, 356);
    EXPECT_NEAR(shapeErrorPixels(1280, 721, odd), 0.0112, 0.0001);
    EXPECT_NEAR(shapeErrorPixels(1280, 721, {640, 361}), 0.888, 0.001);
}

RC_GTEST_PROP(SmallerPicture, IsAboutAsLargeAndNearlyOfTheShape, ()) {
    const int width = *rc::gen::inRange(16, 16385);
    const int height = *rc::gen::inRange(16, 16385);
    const double scale = *rc::gen::inRange(1, 101) / 100.0;
    const PictureSides drawn = smallerPicture(width, height, scale, 16);
    RC_ASSERT(drawn.width >= 16 && drawn.width <= width);
    RC_ASSERT(drawn.height >= 16 && drawn.height <= height);
    if (scale * std::min(width, height) < 17)
        return;  // it may be no smaller
    RC_ASSERT(drawn.width >= scale * width * 15 / 16 - 1);
    RC_ASSERT(drawn.width <= scale * width + 0.5);
    const double error = shapeErrorPixels(width, height, drawn);
    for (int each = drawn.width; each <= std::lround(scale * width); ++each) {
        const auto other = std::lround(static_cast<double>(each) * height / width);
        RC_ASSERT(error <= shapeErrorPixels(width, height, {each, static_cast<int>(other)}) + 1e-9);
    }
}

TEST(SmallerPicture, TakesNoFewerPixelsForNothing) {
    for (const int width : {100, 1000, 1300}) {
        const PictureSides drawn = smallerPicture(width, width - 1, 0.25);
        EXPECT_EQ(drawn.width, width / 4);
        EXPECT_EQ(drawn.height, width / 4);
    }
}

/// Directions through both pictures' projections.
RC_GTEST_PROP(SmallerPicture, SaysHowFarAPointIsBesideItsPlace, ()) {
    const int width = *rc::gen::inRange(100, 3000);
    const int height = *rc::gen::inRange(100, 3000);
    const PictureSides drawn{*rc::gen::inRange(50, 100), *rc::gen::inRange(50, 100)};
    const double fovYDegrees = *rc::gen::inRange(10, 120);
    const Frustum whole = symmetricFrustum(fovYDegrees, static_cast<double>(width) / height);
    const Frustum small =
        symmetricFrustum(fovYDegrees, static_cast<double>(drawn.width) / drawn.height);
    double most = 0;
    for (double place = 0; place <= 1; place += 0.125) {
        const double tangent = whole.left + place * (whole.right - whole.left);
        const double stretched = (tangent - small.left) / (small.right - small.left) * width;
        most = std::max(most, std::abs(stretched - place * width));
    }
    const double said = shapeErrorPixels(width, height, drawn);
    RC_ASSERT(most <= said * (1 + 1e-9) + 1e-9);
    RC_ASSERT(most >= said * (1 - 1e-9) - 1e-9);
}

}  // namespace
}  // namespace eyrie::fabric
