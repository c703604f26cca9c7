// SPDX-License-Identifier: Apache-2.0
// What a pick in a planned picture looks along: the ray from the eye through the wall.
#include <cstddef>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "coordinator/compound/plan.h"
#include "fabric/seen_area.h"
#include "planned_room.h"

namespace eyrie::compound {
namespace {

/// From the eye through a place of a wall, by its corners; the direction has any length.
struct WallRay {
    fabric::Vec3 eye;
    fabric::Vec3 direction;
};
WallRay rayThroughWall(const config::Wall& wall, const fabric::Vec3& eye, double x, double y) {
    const fabric::Vec3 onWall = wall.bottomLeft + x * (wall.bottomRight - wall.bottomLeft) +
                                y * (wall.topLeft - wall.bottomLeft);
    return {eye, onWall - eye};
}

/// What a pick at a share of a picture would follow, in the camera's axes.
WallRay rayOfPick(const Picture& picture, double x, double y) {
    fabric::PickRequest request;
    request.viewWidth = picture.area.width;
    request.viewHeight = picture.area.height;
    request.place = {x * picture.area.width, y * picture.area.height};
    const auto seen = fabric::pickIn(picture.seen, request);
    EXPECT_TRUE(seen.ok() && seen->has_value() && (*seen)->sight);
    if (!seen.ok() || !seen->has_value() || !(*seen)->sight)
        return {};
    const fabric::Sight& sight = *(*seen)->sight;
    const double u = (*seen)->place.x / (*seen)->viewWidth;
    const double v = (*seen)->place.y / (*seen)->viewHeight;
    const fabric::Vec3 inView(sight.frustum.left + u * (sight.frustum.right - sight.frustum.left),
                              sight.frustum.bottom + v * (sight.frustum.top - sight.frustum.bottom),
                              -1);
    return {sight.eye, glm::transpose(sight.viewFromCamera) * inView};
}

void expectSameRay(const WallRay& a, const WallRay& b) {
    EXPECT_LT(glm::length(a.eye - b.eye), 1e-12);
    EXPECT_LT(glm::length(glm::normalize(a.direction) - glm::normalize(b.direction)), 1e-12);
}

TEST(Plan, PicksFollowTheRaysThroughTheCornersOfWalls) {
    const config::Wall wall{{-2, -1, -2}, {2, -1, -2}, {-2, 1, -2}, false};
    PlanRequest request;
    for (const char* compounds : {"",
                                  "compound { channel ( segment 0 ) compound { channel \"c\" "
                                  "pixel [ 0 0 2 1 ] outputframe { name \"f\" } } compound { "
                                  "channel \"d\" pixel [ 1 0 2 1 ] outputframe { name \"g\" } } "
                                  "inputframe { name \"f\" } inputframe { name \"g\" } }"})
        for (const Eye eye : {Eye::Left, Eye::Cyclop, Eye::Right})
            for (std::size_t segment : {0U, 1U}) {
                request.outputs.assign(1, {});
                request.outputs[0].segment = segment;
                request.outputs[0].eye = eye;
                const Plan plan = planned(powerWall(compounds), request);
                ASSERT_EQ(plan.pictures.size(), 1U);
                const double x = eye == Eye::Left ? -.05 : eye == Eye::Right ? .05 : 0;
                for (const fabric::Vec2& at :
                     {fabric::Vec2(0, 0), fabric::Vec2(.25, .7), fabric::Vec2(1, 1)})
                    expectSameRay(rayOfPick(plan.pictures[0], at.x, at.y),
                                  rayThroughWall(wall, {x, 0, 0},
                                                 (static_cast<double>(segment) + at.x) / 2, at.y));
            }
}

TEST(Plan, PicksInOneOfTwoPicturesBesideEachOtherAreOfItsEye) {
    const config::Wall wall{{-2, -1, -2}, {2, -1, -2}, {-2, 1, -2}, false};
    for (const Stereo stereo : {Stereo::SideBySide, Stereo::TopBottom, Stereo::Anaglyph}) {
        PlanRequest request = canvasOf(1280, 480);
        request.outputs[0].stereo = stereo;
        const Picture picture = planned(powerWall(), request).pictures.front();
        const bool isBeside = stereo == Stereo::SideBySide;
        const bool isAbove = stereo == Stereo::TopBottom;
        expectSameRay(rayOfPick(picture, isBeside ? .15 : .3, isAbove ? .8 : .6),
                      rayThroughWall(wall, {-.05, 0, 0}, .3, .6));
        if (stereo != Stereo::Anaglyph)
            expectSameRay(rayOfPick(picture, isBeside ? .65 : .3, isAbove ? .3 : .6),
                          rayThroughWall(wall, {.05, 0, 0}, .3, .6));
    }
}

TEST(Plan, PicksInAPartOfThePictureWithoutAWallAreOfThatPart) {
    const config::Configuration configuration = room(
        "layout { view { } } canvas { layout 0 "
        "segment { channel \"a\" viewport [ 0 0 .5 1 ] }"
        "segment { channel \"b\" viewport [ .5 0 .5 1 ] } }");
    EXPECT_EQ(planned(room("layout { view { } } canvas { layout 0 segment { channel \"a\" } }"),
                      canvasOf(640, 480))
                  .pictures.front()
                  .seen,
              std::nullopt)
        << "all of the camera's own picture";
    PlanRequest request;
    request.fovYDegrees = 90;
    request.outputs.resize(1);
    request.outputs[0].segment = 1;
    const Picture picture = planned(configuration, request).pictures.front();
    const double aspect = 1280.0 / 480;
    expectSameRay(rayOfPick(picture, .5, .75), {{0, 0, 0}, {aspect / 2, .5, -1}});
}

TEST(Plan, AnEyeBehindItsWallSeesNothingAndNothingIsPickedThere) {
    PlanRequest request = canvasOf(1280, 480);
    request.display.heads = {glm::translate(fabric::Mat4(1), fabric::Vec3(0, 0, -5))};
    const Plan plan = planned(powerWall(), request);
    EXPECT_EQ(planned(powerWall(), canvasOf(1280, 480)).blind, 0U);
    EXPECT_EQ(plan.blind, 2U) << "both segments";
    EXPECT_TRUE(plan.draws.empty());
    ASSERT_EQ(plan.pictures.size(), 1U);
    ASSERT_TRUE(plan.pictures[0].seen.has_value());
    EXPECT_TRUE(plan.pictures[0].seen->empty());
    const auto picked = fabric::pickIn(plan.pictures[0].seen, {{}, 1280, 480, {640, 240}});
    ASSERT_TRUE(picked.ok()) << picked.status();
    EXPECT_FALSE(picked->has_value());
}

}  // namespace
}  // namespace eyrie::compound
