// SPDX-License-Identifier: Apache-2.0
// Views through walls that stand anywhere before the eye, and what rasters sample of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "renderer/lod/lattice_view.h"
#include "renderer/lod/vertical_error.h"
#include "renderer/lod/view.h"
#include "tests/renderer/lod/wall.h"

namespace eyrie::lod {
namespace {

using fabric::Box;
using fabric::Camera;
using fabric::Mat4;
using fabric::Raster;
using fabric::Vec2;
using fabric::Vec3;
using test::Dice;

constexpr int kWidth = 1000;
constexpr int kHeight = 500;

/// A camera in a room with one wall, before an object, and a picture whose pixels are not square.
struct Room {
    explicit Room(Dice& dice) {
        camera.eye = dice.vector(dice.in(0, 1) < 0.5 ? 4 : 40);
        camera.target = camera.eye + dice.direction();
        camera.up = dice.direction();
        const test::Wall inCamera = test::randomWall(dice);
        const Vec3 eyeInCamera = test::randomEye(dice);
        sight = test::sightThrough(inCamera, eyeInCamera);
        wall = test::inWorld(camera, inCamera);
        eye = test::inWorld(camera, eyeInCamera);
    }

    View view() const { return {camera, sight, kWidth, kHeight}; }
    std::optional<Vec2> at(const Vec3& world) const {
        return test::project(eye, wall, kWidth, kHeight, world);
    }
    static bool isSeen(const std::optional<Vec2>& p) { return test::inPicture(p, kWidth, kHeight); }

    Camera camera;
    fabric::Sight sight;
    test::Wall wall;  ///< in the world
    Vec3 eye;
};

Mat4 anyTransform(Dice& dice) {
    const double scale = std::exp(dice.in(-1, 1));
    return glm::rotate(glm::scale(glm::translate(Mat4(1.0), dice.vector(3)), Vec3(scale)),
                       dice.in(0, 6), dice.direction());
}

RC_GTEST_PROP(ThroughAWall, NoPointMovesFartherThanTheScreenSpaceError, (unsigned seed)) {
    Dice dice(seed);
    const Room room(dice);
    RC_PRE(fabric::validate(room.camera).ok());
    const Mat4 worldFromObject = anyTransform(dice);
    const double error = std::exp(dice.in(-9, 0));
    const double bound = ObjectView(room.view(), worldFromObject)
                             .screenSpaceErrorPixels(error, Box{Vec3(-1), Vec3(1)});
    for (int i = 0; i < 200; ++i) {
        const Vec3 drawn(dice.in(-1, 1), dice.in(-1, 1), dice.in(-1, 1));
        const Vec3 source = drawn + dice.direction() * error;
        const auto p = room.at(Vec3(worldFromObject * glm::dvec4(drawn, 1)));
        const auto q = room.at(Vec3(worldFromObject * glm::dvec4(source, 1)));
        if (Room::isSeen(p) && q)
            RC_ASSERT(glm::distance(*p, *q) <= bound * (1 + 1e-9) + 1e-9);
    }
}

RC_GTEST_PROP(ThroughAWall, NoPointMovesFartherThanTheVerticalError, (unsigned seed)) {
    Dice dice(seed);
    const Room room(dice);
    RC_PRE(fabric::validate(room.camera).ok());
    const Mat4 worldFromObject = anyTransform(dice);
    const double error = std::exp(dice.in(-9, 0));
    const ObjectView view(room.view(), worldFromObject);
    const double bound = VerticalError(view, error).pixels(Box{Vec3(-1), Vec3(1)});
    for (int i = 0; i < 200; ++i) {
        const Vec3 one(dice.in(-1, 1), dice.in(-1, 1), dice.in(-1, 1));
        const Vec3 other = one + Vec3(0, 0, dice.in(-1, 1)) * error;
        const auto p = room.at(Vec3(worldFromObject * glm::dvec4(one, 1)));
        const auto q = room.at(Vec3(worldFromObject * glm::dvec4(other, 1)));
        if (!Room::isSeen(p) && !Room::isSeen(q))
            continue;
        const double moved =
            p && q ? glm::distance(*p, *q) : std::numeric_limits<double>::infinity();
        RC_ASSERT(moved <= bound * (1 + 1e-9) + 1e-9);
    }
}

/// No narrower rule would do where pixels are square.
RC_GTEST_PROP(ThroughAWall, ASmallBoxHasAPointThatMovesNearlyAsFar, (unsigned seed)) {
    Dice dice(seed);
    Room room(dice);
    RC_PRE(fabric::validate(room.camera).ok());
    const Vec3 inWall = (room.wall.lowerRight - room.wall.lowerLeft) * dice.in(0.1, 0.9) +
                        (room.wall.upperLeft - room.wall.lowerLeft) * dice.in(0.1, 0.9);
    const Vec3 point = room.eye + 10.0 * (room.wall.lowerLeft + inWall - room.eye);
    View view = room.view();
    view.height = static_cast<int>(
        std::lround(view.focalPixels.x * (view.frustum.top - view.frustum.bottom)));
    view.focalPixels.y = view.focalPixels.x;
    const double error = 1e-5;
    const double bound =
        ObjectView(view, Mat4(1.0)).screenSpaceErrorPixels(error, Box{point, point}.grownBy(1e-6));
    const double shapeY = view.focalPixels.x / room.view().focalPixels.y;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        const auto p = room.at(point);
        const auto q = room.at(point + dice.direction() * error);
        worst = std::max(worst, glm::length(Vec2(q->x - p->x, (q->y - p->y) * shapeY)));
    }
    RC_ASSERT(worst <= bound * (1 + 1e-6));
    RC_ASSERT(bound <= worst * 1.1);
}

Raster anyRaster(Dice& dice) {
    Raster raster;
    raster.step = {std::exp(dice.in(-1, 2)), std::exp(dice.in(-1, 2))};
    raster.width = static_cast<int>(dice.in(1, kWidth / raster.step.x));
    raster.height = static_cast<int>(dice.in(1, kHeight / raster.step.y));
    raster.origin = {
        dice.in(-0.5 * raster.step.x, kWidth - (raster.width - 0.5) * raster.step.x),
        dice.in(-0.5 * raster.step.y, kHeight - (raster.height - 0.5) * raster.step.y)};
    return raster;
}

RC_GTEST_PROP(RasterView, CullsNoPointThatOneOfItsPixelsShows, (unsigned seed)) {
    Dice dice(seed);
    const Room room(dice);
    RC_PRE(fabric::validate(room.camera).ok());
    const Raster raster = anyRaster(dice);
    RC_ASSERT(fabric::validate(raster, kWidth, kHeight).ok());
    Box box;
    box.grow(room.eye + dice.vector(10));
    box.grow(room.eye + dice.vector(10));
    const View whole = room.view();
    const View drawn = rasterView(whole, raster);
    const fabric::PixelViewport covered = ObjectView(drawn, Mat4(1.0)).coveredPixels(box);
    RC_ASSERT((fabric::PixelViewport{0, 0, raster.width, raster.height}).contains(covered));
    for (int i = 0; i < 200; ++i) {
        const Vec3 point = box.min + box.size() * Vec3(dice.in(0, 1), dice.in(0, 1), dice.in(0, 1));
        const auto p = room.at(point);
        if (!p)
            continue;
        const Vec2 inRaster = (*p - raster.origin) / raster.step;
        if (!test::inPicture(inRaster, raster.width, raster.height))
            continue;
        const fabric::PixelViewport pixel{std::min(static_cast<int>(inRaster.x), raster.width - 1),
                                          std::min(static_cast<int>(inRaster.y), raster.height - 1),
                                          1, 1};
        RC_ASSERT(covered.contains(pixel));
        RC_ASSERT(ObjectView(drawn, Mat4(1.0)).isVisible(box));
        RC_ASSERT(ObjectView(drawn, Mat4(1.0)).isVisible(box, subFrustum(drawn, pixel)));
        if (Room::isSeen(p))
            RC_ASSERT(ObjectView(whole, Mat4(1.0)).isVisible(box));
    }
}

RC_GTEST_PROP(RasterView, PlacesLatticePointsOnItsOwnPixels, (unsigned seed)) {
    Dice dice(seed);
    const Room room(dice);
    RC_PRE(fabric::validate(room.camera).ok());
    const Raster raster = anyRaster(dice);
    const View drawn = rasterView(room.view(), raster);
    const LatticeView lattice(drawn, Mat4(1.0), glm::scale(Mat4(1.0), Vec3(1.0 / 1024)));
    for (int i = 0; i < 20; ++i) {
        const glm::ivec3 point(1024.0 * (room.eye + dice.vector(10)));
        const auto p = room.at(Vec3(point) / 1024.0);
        if (!Room::isSeen(p))
            continue;
        const glm::vec4 clip =
            lattice.clipFromLattice * glm::vec4(glm::vec3(point - lattice.cameraLattice), 1.0F);
        RC_PRE(clip.w > 0.1F);
        const Vec2 pixel((clip.x / clip.w + 1) / 2 * static_cast<float>(raster.width),
                         (clip.y / clip.w + 1) / 2 * static_cast<float>(raster.height));
        RC_ASSERT(glm::distance(raster.origin + pixel * raster.step, *p) < 0.01);
    }
}

TEST(RasterView, OfTheViewsOwnPixelsIsTheViewToTheBit) {
    Dice dice(7);
    for (int i = 0; i < 1000; ++i) {
        const View view = Room(dice).view();
        const View same = rasterView(view, Raster{kWidth, kHeight, {0, 0}, {1, 1}});
        EXPECT_EQ(same.frustum, view.frustum);
        EXPECT_EQ(same.focalPixels, view.focalPixels);
        EXPECT_EQ(same.step, view.step);
        EXPECT_EQ(same.width, view.width);
    }
}

TEST(Sight, ThatIsTheCamerasOwnIsTheViewStraightAhead) {
    Camera camera;
    camera.eye = {4, 5, 6};
    camera.target = {-7, 8, 1};
    const View ahead(camera, kWidth, kHeight);
    const View seen(camera, fabric::Sight{{}, fabric::Mat3(1.0), ahead.frustum}, kWidth, kHeight);
    EXPECT_EQ(seen.eye, ahead.eye);
    EXPECT_EQ(seen.viewFromWorldRotation, ahead.viewFromWorldRotation);
    EXPECT_EQ(seen.frustum, ahead.frustum);
    EXPECT_NEAR(seen.focalPixels.x, ahead.focalPixels.x, 1e-9);
    EXPECT_NEAR(seen.focalPixels.y, ahead.focalPixels.y, 1e-9);
}

TEST(MiddleDirection, IsThatOfTheWallsMiddle) {
    Dice dice(3);
    for (int i = 0; i < 100; ++i) {
        const Room room(dice);
        const Vec3 middle = (room.wall.lowerRight + room.wall.upperLeft) / 2.0;
        EXPECT_LT(glm::distance(middleDirection(room.view()), glm::normalize(middle - room.eye)),
                  1e-12);
    }
}

}  // namespace
}  // namespace eyrie::lod
