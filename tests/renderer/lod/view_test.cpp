// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/lod/lattice_view.h"
#include "tests/renderer/lod/textbook.h"

namespace eyrie::lod {
namespace {

using fabric::Box;
using fabric::Camera;
using fabric::Mat4;
using fabric::Vec2;
using fabric::Vec3;

using test::Dice;
using test::inPicture;
using test::project;

RC_GTEST_PROP(ScreenSpaceError, IsNeverBelowTheMeasuredDisplacement, (unsigned seed)) {
    Dice dice(seed);
    const int width = 1280;
    const int height = 720;
    Camera camera;
    camera.eye = dice.vector(50);
    camera.target = camera.eye + dice.direction();
    camera.fovYDegrees = dice.in(5, 150);
    if (!fabric::validate(camera).ok())
        return;
    const Box box{Vec3(-1), Vec3(1)};
    const double scale = std::exp(dice.in(-1, 2));
    const Mat4 worldFromObject =
        glm::rotate(glm::scale(glm::translate(Mat4(1.0), dice.vector(20)), Vec3(scale)),
                    dice.in(0, 6), dice.direction());
    const double error = std::exp(dice.in(-7, 0));
    const ObjectView view(View(camera, width, height), worldFromObject);
    const double bound = view.screenSpaceErrorPixels(error, box);
    for (int i = 0; i < 200; ++i) {
        const Vec3 drawn(dice.in(-1, 1), dice.in(-1, 1), dice.in(-1, 1));
        const Vec3 source = drawn + dice.direction() * error;
        const auto p = project(camera, width, height, Vec3(worldFromObject * glm::dvec4(drawn, 1)));
        const auto q =
            project(camera, width, height, Vec3(worldFromObject * glm::dvec4(source, 1)));
        if (!inPicture(p, width, height) || !q)
            continue;
        RC_ASSERT(glm::distance(*p, *q) <= bound * (1 + 1e-9) + 1e-9);
    }
}

TEST(ScreenSpaceError, HoldsInTheCornerOfAWideView) {
    // The rule without the 1/cos of the angle off axis fails this one (120 degrees, corner).
    Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 1, 0};
    camera.fovYDegrees = 120;
    const View view(camera, 1280, 720);
    const double tangent = view.frustum.right * 0.99;
    const Box box = Box{Vec3(tangent * 10, 10, 16), Vec3(tangent * 10, 10, 16)}.grownBy(0.01);
    const double error = 0.05;
    const double bound = ObjectView(view, Mat4(1.0)).screenSpaceErrorPixels(error, box);
    const double withoutSecant = error * view.greatestFocalPixels() / 10;
    const Vec3 point = box.centre();
    double worst = 0;
    for (int i = 0; i < 360; ++i) {
        const Vec3 direction =
            glm::normalize(Vec3(point.x, 0, point.z)) * std::cos(i * M_PI / 180) +
            Vec3(0, 1, 0) * std::sin(i * M_PI / 180);
        const auto p = project(camera, 1280, 720, point);
        const auto q = project(camera, 1280, 720, point + direction * error);
        worst = std::max(worst, glm::distance(*p, *q));
    }
    EXPECT_LE(worst, bound);
    EXPECT_GT(worst, withoutSecant * 1.5);
    EXPECT_LT(bound, worst * 1.1) << "the bound should be tight for a small box";
}

TEST(ScreenSpaceError, IsInfiniteWhenTheEyeIsInsideTheBoundsGrownByTheError) {
    Camera camera;
    camera.eye = {0, 0, 1.05};
    camera.target = {0, 1, 1.05};
    const ObjectView view(View(camera, 640, 480), Mat4(1.0));
    EXPECT_TRUE(std::isinf(view.screenSpaceErrorPixels(0.1, Box{Vec3(-1), Vec3(1)})));
    EXPECT_TRUE(std::isfinite(view.screenSpaceErrorPixels(0.001, Box{Vec3(-1), Vec3(1)})));
}

TEST(ScreenSpaceError, IsZeroForExactDataAndForWhatCannotBeSeen) {
    Camera camera;
    const ObjectView view(View(camera, 640, 480), Mat4(1.0));
    EXPECT_EQ(view.screenSpaceErrorPixels(0, Box{Vec3(-1), Vec3(1)}), 0);
    EXPECT_EQ(view.screenSpaceErrorPixels(0.5, Box{Vec3(-1, -30, -1), Vec3(1, -20, 1)}), 0);
}

/// A triangle that reaches 100 km away, or less, below or above an eye that is right before it.
struct WideTriangle {
    explicit WideTriangle(Dice& dice) {
        const double reach = std::exp(dice.in(3, 12));
        camera.eye = dice.vector(1e5);
        camera.target = camera.eye + dice.direction();
        camera.fovYDegrees = dice.in(5, 120);
        above = std::exp(dice.in(-2, 3));
        for (std::size_t i = 0; i < 3; ++i) {
            const double angle = dice.in(0, 1.5) + 2.1 * static_cast<double>(i);
            corners[i] = camera.eye + Vec3(reach * std::cos(angle), reach * std::sin(angle),
                                           -above + dice.in(-0.01, 0.01) * above);
        }
    }

    /// Beside the foot of the eye by (x, y): `at` with the weights that are the place in `corners`.
    Vec3 weightsOf(double x, double y) const {
        const Vec2 p = Vec2(camera.eye) + Vec2(x, y);
        const auto side = [&](const Vec3& a, const Vec3& b) {
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        };
        const Vec3 weights(side(corners[1], corners[2]), side(corners[2], corners[0]),
                           side(corners[0], corners[1]));
        return weights / (weights.x + weights.y + weights.z);
    }
    static Vec3 at(const std::array<Vec3, 3>& corners, const Vec3& weights) {
        return corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
    }

    Camera camera;
    double above;
    std::array<Vec3, 3> corners;
};

constexpr double kRounding = 9.0 / (1 << 24);  // docs/errors.md#corners-far-away

RC_GTEST_PROP(RoundingPixels, OfATriangleAreNeverBelowWhatItsCornersMoveIt, (unsigned seed)) {
    Dice dice(seed);
    const WideTriangle triangle(dice);
    RC_PRE(fabric::validate(triangle.camera).ok());
    const ObjectView view(View(triangle.camera, 1280, 720), Mat4(1.0));
    const double bound = view.roundingPixels(triangle.corners);
    Box box;
    for (const Vec3& corner : triangle.corners) box.grow(corner);
    RC_ASSERT(view.roundingPixels(box, box) >= bound);
    for (int i = 0; i < 200; ++i) {
        std::array<Vec3, 3> moved = triangle.corners;
        for (Vec3& corner : moved)
            corner += dice.direction() * (kRounding * glm::distance(corner, triangle.camera.eye));
        const double beside = 10 * triangle.above;
        const Vec3 weights = triangle.weightsOf(dice.in(-beside, beside), dice.in(-beside, beside));
        const auto p =
            project(triangle.camera, 1280, 720, WideTriangle::at(triangle.corners, weights));
        const auto q = project(triangle.camera, 1280, 720, WideTriangle::at(moved, weights));
        if (weights.x < 0 || weights.y < 0 || weights.z < 0 ||
            !(inPicture(p, 1280, 720) || inPicture(q, 1280, 720)))
            continue;
        RC_ASSERT(std::isinf(bound) ||
                  (p && q && glm::distance(*p, *q) <= std::max(bound, 1.0 / 256) * (1 + 1e-6)));
    }
}

/// The rounding that is allowed for, by the sums that a vertex shader makes.
RC_GTEST_PROP(RoundingPixels, AllowForWhatFloatsMakeOfACorner, (unsigned seed)) {
    Dice dice(seed);
    const WideTriangle triangle(dice);
    RC_PRE(fabric::validate(triangle.camera).ok());
    const View view(triangle.camera, 1280, 720);
    const double step = 1.0 / 64;
    const LatticeView lattice(view, Mat4(1.0), glm::scale(Mat4(1.0), Vec3(step)));
    const Mat4 projection = fabric::clipFromView(view.frustum, fabric::kNearMetres);
    for (const Vec3& corner : triangle.corners) {
        const Vec3 place = glm::round(corner / step);
        const Vec3 exact = view.viewFromWorldRotation * (place * step - view.eye);
        const glm::vec3 p(place - Vec3(lattice.cameraLattice));
        const glm::mat4& m = lattice.clipFromLattice;
        const auto row = [&](int i) {
            return m[0][i] * p.x + m[1][i] * p.y + m[2][i] * p.z + m[3][i];
        };
        const Vec3 drawn(row(0) / projection[0][0], row(1) / projection[1][1], -row(3));
        RC_ASSERT(glm::distance(drawn, exact) <= kRounding * glm::length(exact));
    }
}

/// What is drawn of a surface that is beside the picture itself.
RC_GTEST_PROP(RoundingPixels, HoldWhereRoundingBringsASurfaceIntoThePicture, (unsigned seed)) {
    Dice dice(seed);
    Camera camera;
    camera.target = {1, 0, 0};
    camera.fovYDegrees = dice.in(1, 60);
    const double reach = std::exp(dice.in(8, 12));
    // A wall along the line of sight, from a tenth of what it is rounded by to a hundred times
    // that.
    const double beside = kRounding * reach * std::exp(dice.in(-2.3, 4.6));
    const double widest = std::tan(camera.fovYDegrees * M_PI / 360) * 1280 / 720;
    const std::array<Vec3, 3> wall = {Vec3(-reach, beside, -reach), Vec3(-reach, beside, reach),
                                      Vec3(reach, beside + 2 * widest * reach, 0)};
    const ObjectView view(View(camera, 1280, 720), Mat4(1.0));
    const double bound = std::max(view.roundingPixels(wall), 1.0 / 256);
    for (int i = 0; i < 200; ++i) {
        std::array<Vec3, 3> moved = wall;
        for (Vec3& corner : moved) corner += dice.direction() * (kRounding * glm::length(corner));
        const double a = dice.in(0, 1);
        const double b = dice.in(0, 1 - a);
        const Vec3 weights(a, b, 1 - a - b);
        const auto p = project(camera, 1280, 720, WideTriangle::at(wall, weights));
        const auto q = project(camera, 1280, 720, WideTriangle::at(moved, weights));
        if (inPicture(p, 1280, 720) || inPicture(q, 1280, 720))
            RC_ASSERT(bound == std::numeric_limits<double>::infinity() ||
                      (p && q && glm::distance(*p, *q) <= bound * (1 + 1e-6)));
    }
}

TEST(RoundingPixels, AreInfiniteWhereASurfaceMayComeToTheEye) {
    Camera camera;
    for (const double above : {0.001, 0.01, 1.0}) {
        camera.eye = {0, 0, above};
        camera.target = {1, 0, above + 1};  // the plain is not in the picture
        const ObjectView view(View(camera, 1280, 720), Mat4(1.0));
        const std::array<Vec3, 3> plain = {Vec3(-1e5, -1e5, 0), Vec3(1e5, -1e5, 0),
                                           Vec3(0, 1e5, 0)};
        const bool mayReach = above < 0.05;  // of 141 km
        EXPECT_EQ(view.roundingPixels(plain),
                  mayReach ? std::numeric_limits<double>::infinity() : 0);
    }
}

TEST(RoundingPixels, CountOnlyRightBeforeTheEye) {
    Camera camera;
    camera.eye = {0, 0, 2};
    camera.target = {100, 0, 2};
    const ObjectView view(View(camera, 1280, 720), Mat4(1.0));
    const Box plain{Vec3(-5e4, -5e4, 0), Vec3(5e4, 5e4, 0)};
    EXPECT_GT(view.roundingPixels(plain, plain), 1);
    EXPECT_EQ(view.roundingPixels(plain, {Vec3(3e4, -1e4, 0), Vec3(5e4, 1e4, 0)}), 0);
    const Box hill{Vec3(-100, -100, 0), Vec3(100, 100, 10)};
    EXPECT_EQ(view.roundingPixels(hill, hill), std::numeric_limits<double>::infinity());
    const Box behind{Vec3(-1e5, -100, 0), Vec3(-1, 100, 1)};
    EXPECT_EQ(view.roundingPixels(behind, behind), 0);
}

RC_GTEST_PROP(Visibility, NeverHidesAPointThatIsInThePicture, (unsigned seed)) {
    Dice dice(seed);
    Camera camera;
    camera.eye = dice.vector(5);
    camera.target = camera.eye + dice.direction();
    if (!fabric::validate(camera).ok())
        return;
    const View view(camera, 1000, 500);
    const fabric::PixelViewport part{200, 100, 300, 250};
    Box box;
    box.grow(dice.vector(10));
    box.grow(dice.vector(10));
    const ObjectView objectView(view, Mat4(1.0));
    for (int i = 0; i < 200; ++i) {
        const Vec3 point = box.min + box.size() * Vec3(dice.in(0, 1), dice.in(0, 1), dice.in(0, 1));
        const auto p = project(camera, 1000, 500, point);
        if (p && p->x >= 200 && p->x <= 500 && p->y >= 100 && p->y <= 350)
            RC_ASSERT(objectView.isVisible(box, subFrustum(view, part)));
    }
}

RC_GTEST_PROP(CoveredPixels, HoldEveryPointOfTheBoxThatIsInThePicture, (unsigned seed)) {
    Dice dice(seed);
    Camera camera;
    camera.eye = dice.vector(20);
    camera.target = camera.eye + dice.direction();
    if (!fabric::validate(camera).ok())
        return;
    Box box;
    box.grow(dice.vector(10));
    box.grow(dice.vector(10));
    const fabric::PixelViewport covered =
        ObjectView(View(camera, 1000, 500), Mat4(1.0)).coveredPixels(box);
    RC_ASSERT((fabric::PixelViewport{0, 0, 1000, 500}).contains(covered));
    for (int i = 0; i < 200; ++i) {
        const Vec3 point = box.min + box.size() * Vec3(dice.in(0, 1), dice.in(0, 1), dice.in(0, 1));
        const auto p = project(camera, 1000, 500, point);
        if (inPicture(p, 999, 499))
            RC_ASSERT(covered.contains({static_cast<int>(p->x), static_cast<int>(p->y), 1, 1}));
    }
}

TEST(CoveredPixels, AreTightAroundABoxInTheMiddle) {
    Camera camera;
    camera.eye = {0, -10, 0};
    camera.target = {0, 0, 0};
    camera.fovYDegrees = 90;
    const ObjectView view(View(camera, 1000, 500), Mat4(1.0));
    // The near face, 2 m wide at 10 m, is 50 pixels of the 500 that 20 m have; one more each side.
    const fabric::PixelViewport covered = view.coveredPixels(Box{Vec3(-1, 0, -1), Vec3(1, 1, 1)});
    EXPECT_EQ(covered, (fabric::PixelViewport{474, 224, 53, 53}));
}

TEST(CoveredPixels, AreNoneOfABoxBesideThePicture) {
    Camera camera;
    camera.eye = {0, -10, 0};
    camera.target = {0, 0, 0};
    const ObjectView view(View(camera, 1000, 500), Mat4(1.0));
    EXPECT_TRUE(view.coveredPixels(Box{Vec3(100, 0, 0), Vec3(101, 1, 1)}).isEmpty());
}

TEST(LatticeView, PlacesTheSamePointAlikeAtAnyDistanceFromTheOrigin) {
    const Vec3 objectOrigin(1.0 / 1024);  // finer than doubles are at the farthest
    const Mat4 objectFromLattice = glm::scale(glm::translate(Mat4(1.0), objectOrigin), Vec3(0.25));
    for (const double far : {0.0, 5e5, 6.378e6, 0x1p45}) {
        Camera camera;
        camera.eye = Vec3(far) + Vec3(10.3, -20.7, 5.2);
        camera.target = Vec3(far) + Vec3(0.4, 0.2, 0.1);
        Camera near = camera;  // exact differences
        near.eye -= Vec3(far);
        near.target -= Vec3(far);
        const LatticeView lattice(View(camera, 1280, 720), glm::translate(Mat4(1.0), Vec3(far)),
                                  objectFromLattice);
        for (const glm::ivec3 point : {glm::ivec3(0, 0, 0), glm::ivec3(7, -12, 3)}) {
            const glm::vec4 clip =
                lattice.clipFromLattice * glm::vec4(glm::vec3(point - lattice.cameraLattice), 1.0F);
            const Vec2 pixel((clip.x / clip.w + 1) * 640, (clip.y / clip.w + 1) * 360);
            const auto expected = project(near, 1280, 720, objectOrigin + Vec3(point) * 0.25);
            ASSERT_TRUE(expected);
            EXPECT_LT(glm::distance(pixel, *expected), 1e-3) << "at " << far << " metres";
        }
    }
}

TEST(LatticeView, TakesAFarOriginBackThatItsObjectIsPlacedBy) {
    Camera camera;
    camera.eye = {10.3, -20.7, 5.2};
    camera.target = {0.4, 0.2, 0.1};
    const View view(camera, 1280, 720);
    const Vec3 far(0x1p43, -0x1p42, 0x1p43);
    const LatticeView here(view, Mat4(1.0), glm::scale(Mat4(1.0), Vec3(0.25)));
    const LatticeView back(view, glm::translate(Mat4(1.0), -far),
                           glm::scale(glm::translate(Mat4(1.0), far), Vec3(0.25)));
    EXPECT_EQ(back.cameraLattice, here.cameraLattice);
    EXPECT_LT(glm::distance(back.cameraOffsetMetres, here.cameraOffsetMetres), 1e-5);
}

/// The camera walks 1,000 steps of a tenth of a millimetre, 6,400 km from the origin,
/// snapping to lattice points of 8 mm and 1 m on its way. Positions there are doubles 1e-9 m apart.
TEST(HardCase21, MovesThePictureSteadilyWhileTheCameraSnaps) {
    for (const double step : {1.0 / 128, 1.0}) {
        const Vec3 origin(6.4e6, -6.4e6, 0);
        const Mat4 worldFromLattice = glm::scale(glm::translate(Mat4(1.0), origin), Vec3(step));
        const glm::ivec3 point = glm::ivec3(glm::round(Vec3(6, 20, -1) / step));
        double before = std::numeric_limits<double>::infinity();
        int snaps = 0;
        glm::ivec3 lastSnapped{};
        for (int k = 0; k < 1000; ++k) {
            Camera camera;
            camera.eye = origin + Vec3(0.47 + 1e-4 * k, 0.3, 1.7);
            camera.target = camera.eye + Vec3(0, 10, -1);
            const LatticeView lattice(View(camera, 1280, 720), glm::translate(Mat4(1.0), origin),
                                      glm::scale(Mat4(1.0), Vec3(step)));
            const glm::vec4 clip =
                lattice.clipFromLattice * glm::vec4(glm::vec3(point - lattice.cameraLattice), 1.0F);
            const double x = (clip.x / clip.w + 1) * 640;
            const auto expected =
                project(camera, 1280, 720, Vec3(worldFromLattice * glm::dvec4(point, 1)));
            ASSERT_TRUE(expected);
            EXPECT_NEAR(x, expected->x, 0.005) << "step " << k;
            // Each step moves the point 0.004 px to the left; a float here is 6e-5 px.
            EXPECT_LT(x, before) << "step " << k;
            before = x;
            snaps += k > 0 && lattice.cameraLattice != lastSnapped ? 1 : 0;
            lastSnapped = lattice.cameraLattice;
        }
        EXPECT_GE(snaps, step < 0.1 ? 12 : 1);
    }
}

TEST(LatticeView, KeepsFarCamerasInTheRangeWhereDifferencesAreExact) {
    Camera camera;
    camera.eye = {1e9, 0, 0};
    camera.target = {0, 0, 0};
    const LatticeView lattice(View(camera, 100, 100), Mat4(1.0), glm::scale(Mat4(1.0), Vec3(1e-3)));
    EXPECT_LE(std::abs(lattice.cameraLattice.x), 1 << 23);
    const glm::vec4 clip =
        lattice.clipFromLattice * glm::vec4(glm::vec3(-lattice.cameraLattice), 1.0F);
    EXPECT_NEAR(clip.x / clip.w, 0, 1e-6);
    EXPECT_NEAR(clip.w, 1e9, 1e3);
}

}  // namespace
}  // namespace eyrie::lod
