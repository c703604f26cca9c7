// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/vertical_error.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/renderer/lod/textbook.h"

namespace eyrie::lod {
namespace {

using fabric::Box;
using fabric::Camera;
using fabric::Mat4;
using fabric::Vec3;
using test::Dice;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

/// A camera, an object and an error, of any sizes and directions.
struct Situation {
    explicit Situation(Dice& dice) {
        camera.eye = dice.vector(dice.in(0, 1) < 0.5 ? 4 : 40);
        camera.target = camera.eye + dice.direction();
        camera.fovYDegrees = dice.in(5, 150);
        const double scale = std::exp(dice.in(-1, 1));
        worldFromObject = glm::rotate(
            glm::scale(glm::translate(Mat4(1.0), dice.vector(3)), Vec3(scale, scale, 2 * scale)),
            dice.in(0, 6), dice.direction());
        error = std::exp(dice.in(-9, 0));
    }

    /// How far apart two points of the object are in the picture when either is visible, or 0.
    double distance(const Vec3& one, const Vec3& other) const {
        const auto p = at(one);
        const auto q = at(other);
        const bool isSeen =
            test::inPicture(p, kWidth, kHeight) || test::inPicture(q, kWidth, kHeight);
        if (!isSeen)
            return 0;
        return p && q ? glm::distance(*p, *q) : std::numeric_limits<double>::infinity();
    }

    std::optional<fabric::Vec2> at(const Vec3& point) const {
        return test::project(camera, kWidth, kHeight, Vec3(worldFromObject * glm::dvec4(point, 1)));
    }

    Camera camera;
    Mat4 worldFromObject;
    double error;
};

RC_GTEST_PROP(VerticalError, OfABoxIsNeverBelowTheMeasuredDisplacement, (unsigned seed)) {
    Dice dice(seed);
    const Situation situation(dice);
    RC_PRE(fabric::validate(situation.camera).ok());
    const Box box{Vec3(-1), Vec3(1)};
    const ObjectView view(View(situation.camera, kWidth, kHeight), situation.worldFromObject);
    const double bound = VerticalError(view, situation.error).pixels(box);
    for (int i = 0; i < 200; ++i) {
        const Vec3 one(dice.in(-1, 1), dice.in(-1, 1), dice.in(-1, 1));
        const Vec3 other = one + Vec3(0, 0, dice.in(-1, 1) < 0 ? -1 : 1) * situation.error;
        RC_ASSERT(situation.distance(one, other) <= bound * (1 + 1e-9) + 1e-9);
    }
}

RC_GTEST_PROP(VerticalError, OfTrianglesIsNeverBelowTheMeasuredDisplacement, (unsigned seed)) {
    Dice dice(seed);
    const Situation situation(dice);
    RC_PRE(fabric::validate(situation.camera).ok());
    std::vector<Vec3> corners;
    for (int i = 0; i < 12; ++i) corners.push_back(dice.vector(5));
    const ObjectView view(View(situation.camera, kWidth, kHeight), situation.worldFromObject);
    const double bound = VerticalError(view, situation.error).pixels(corners);
    for (int i = 0; i < 200; ++i) {
        const std::size_t first = 3 * static_cast<std::size_t>(dice.in(0, 3.999));
        const double a = dice.in(0, 1);
        const double b = dice.in(0, 1 - a);
        const Vec3 one =
            corners[first] * (1 - a - b) + corners[first + 1] * a + corners[first + 2] * b;
        const Vec3 other = one + Vec3(0, 0, dice.in(-1, 1)) * situation.error;
        RC_ASSERT(situation.distance(one, other) <= bound * (1 + 1e-9) + 1e-9);
    }
}

/// No narrower rule would do: a small box has a point that moves by nearly that much.
RC_GTEST_PROP(VerticalError, OfASmallBoxIsWhatIsMeasured, (unsigned seed)) {
    Dice dice(seed);
    Camera camera;
    camera.eye = dice.vector(40);
    camera.target = dice.vector(1);
    RC_PRE(fabric::validate(camera).ok() && glm::distance(camera.eye, camera.target) > 10);
    const ObjectView view(View(camera, kWidth, kHeight), Mat4(1.0));
    const double error = 0.01;
    const Box box{camera.target - Vec3(0.01), camera.target + Vec3(0.01)};
    const auto p = test::project(camera, kWidth, kHeight, camera.target);
    const auto q = test::project(camera, kWidth, kHeight, camera.target + Vec3(0, 0, error));
    const double seenFlat =
        glm::length(glm::cross(glm::normalize(camera.target - camera.eye), Vec3(0, 0, 1)));
    RC_PRE(seenFlat > VerticalError::kLeastSlant * 1.1);
    RC_ASSERT(VerticalError(view, error).pixels(box) <= glm::distance(*p, *q) * 1.05);
}

TEST(VerticalError, CountsLessTheMoreSteeplyOneLooksDownButNotNothing) {
    const Box box{Vec3(-0.1), Vec3(0.1)};
    const auto pixelsFrom = [&](const Vec3& eye) {
        Camera camera;
        camera.eye = eye;
        camera.target = {0, 0, 0};
        camera.up = {0, 1, 0};
        const ObjectView view(View(camera, kWidth, kHeight), Mat4(1.0));
        return VerticalError(view, 1).pixels(box);
    };
    const double level = pixelsFrom({-100, 0, 0});
    EXPECT_NEAR(pixelsFrom({-86.6, 0, 50}) / level, 0.866, 0.01);
    EXPECT_NEAR(pixelsFrom({-50, 0, 86.6}) / level, 0.5, 0.02);
    EXPECT_NEAR(pixelsFrom({0, 0, 100}) / level, VerticalError::kLeastSlant, 0.01);
}

TEST(VerticalError, IsFiniteCloseAboveASlopeWhoseBoxHoldsTheEye) {
    Camera camera;
    camera.eye = {0, 0, 2};
    camera.target = {10, 0, 5};
    const std::vector<Vec3> slope = {{-50, -50, -50}, {50, -50, 50}, {50, 50, 50}};
    Box box;
    for (const Vec3& corner : slope) box.grow(corner);
    const ObjectView view(View(camera, 640, 480), Mat4(1.0));
    EXPECT_TRUE(std::isinf(VerticalError(view, 0.01).pixels(box)));
    EXPECT_LT(VerticalError(view, 0.01).pixels(slope), 10);
    EXPECT_GT(VerticalError(view, 0.01).pixels(slope), 1);
    EXPECT_TRUE(std::isinf(VerticalError(view, 8).pixels(slope))) << "within the error of the eye";
}

TEST(VerticalError, IsZeroForExactDataAndForWhatCannotBeSeen) {
    const ObjectView view(View(Camera{}, 640, 480), Mat4(1.0));
    const Box behind{Vec3(-1, -30, -1), Vec3(1, -20, 1)};
    EXPECT_EQ(VerticalError(view, 0).pixels(Box{Vec3(-1), Vec3(1)}), 0);
    EXPECT_EQ(VerticalError(view, 0.5).pixels(behind), 0);
}

}  // namespace
}  // namespace eyrie::lod
