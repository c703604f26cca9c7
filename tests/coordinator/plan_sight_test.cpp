// SPDX-License-Identifier: Apache-2.0
// From where, and through which frustum, planned pictures are seen: walls, heads, eyes and focus.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/compound/plan.h"
#include "planned_room.h"

namespace eyrie::compound {
namespace {

void expectNear(const fabric::Frustum& a, const fabric::Frustum& b) {
    EXPECT_NEAR(a.left, b.left, 1e-12);
    EXPECT_NEAR(a.right, b.right, 1e-12);
    EXPECT_NEAR(a.bottom, b.bottom, 1e-12);
    EXPECT_NEAR(a.top, b.top, 1e-12);
}

fabric::Sight sightOf(const config::Configuration& configuration, const PlanRequest& request) {
    const Plan plan = planned(configuration, request);
    EXPECT_FALSE(plan.draws.empty());
    return plan.draws.empty() ? fabric::Sight{}
                              : plan.draws[0].task.sight.value_or(fabric::Sight{});
}

TEST(Plan, AWiderPictureWidensTheWallAboutItsCentre) {
    // As configured 1280 x 480 pixels show 4 x 2 m from 2 m away.
    expectNear(planned(powerWall(), canvasOf(1280, 480)).draws[0].task.sight->frustum,
               {-1, 1, -.5, .5});
    expectNear(planned(powerWall(), canvasOf(2560, 480)).draws[0].task.sight->frustum,
               {-2, 2, -.5, .5});
    expectNear(planned(powerWall(), canvasOf(640, 240)).draws[0].task.sight->frustum,
               {-1, 1, -.5, .5});
}

TEST(Plan, AModelUnitMovesTheEyesAndKeepsTheFrustum) {
    PlanRequest request = canvasOf(1280, 480);
    request.outputs[0].eye = Eye::Left;
    const fabric::Sight one = sightOf(powerWall(), request);
    EXPECT_NEAR(one.eye.x, -.05, 1e-12);
    for (const double unit : {.5, 2.0}) {
        request.display.modelUnits = {{unit}};
        const fabric::Sight scaled = sightOf(powerWall(), request);
        EXPECT_NEAR(scaled.eye.x, -.05 * unit, 1e-12);
        expectNear(scaled.frustum, one.frustum);
    }
}

TEST(Plan, AHeadThatMovesSeesTheWallFromThere) {
    PlanRequest request = canvasOf(1280, 480);
    fabric::Mat4 head(1.0);
    head[3] = {1, 0, 2, 1};  // a metre to the right, two back
    request.display.heads = {head};
    const fabric::Sight sight = sightOf(powerWall(), request);
    EXPECT_NEAR(sight.eye.x, 1, 1e-12);
    expectNear(sight.frustum, {-3. / 4, 1. / 4, -1. / 4, 1. / 4});
    head[3] = {0, 0, -3, 1};  // through the wall: there is nothing to see
    request.display.heads = {head};
    EXPECT_TRUE(planned(powerWall(), request).draws.empty());
}

TEST(Plan, AWornWallMovesWithTheHead) {
    const config::Configuration worn = room(
        "observer {} layout { view { observer 0 wall { type HMD } } } "
        "canvas { layout 0 segment { channel \"a\" } }");
    PlanRequest request = canvasOf(640, 480);
    const fabric::Sight ahead = sightOf(worn, request);
    fabric::Mat4 head(1.0);  // looking to the left, a metre up
    head[0] = {0, 0, -1, 0};
    head[2] = {1, 0, 0, 0};
    head[3] = {0, 1, 0, 1};
    request.display.heads = {head};
    const fabric::Sight turned = sightOf(worn, request);
    expectNear(turned.frustum, ahead.frustum);
    EXPECT_NEAR(turned.eye.y, 1, 1e-12);
    EXPECT_NEAR(turned.viewFromCamera[0][2], 1, 1e-12) << "behind it is what is at the right";
}

TEST(Plan, AWornWallsFocusStaysWhereverTheHeadIs) {
    for (const char* mode : {"relative_to_origin", "relative_to_observer"}) {
        const config::Configuration worn =
            room("observer { eye_base .1 focus_distance 5 focus_mode " + std::string(mode) +
                 " } layout { view { observer 0 wall { type HMD } } } "
                 "canvas { layout 0 segment { channel \"a\" } }");
        PlanRequest request = canvasOf(640, 480);
        for (const Eye eye : {Eye::Left, Eye::Right}) {
            request.outputs[0].eye = eye;
            request.display.heads = {fabric::Mat4(1.0)};
            const fabric::Frustum still = sightOf(worn, request).frustum;
            fabric::Mat4 head(1.0);  // looking to the left, three metres back and one up
            head[0] = {0, 0, -1, 0};
            head[2] = {1, 0, 0, 0};
            head[3] = {0, 1, 3, 1};
            request.display.heads = {head};
            expectNear(sightOf(worn, request).frustum, still);
            head = fabric::Mat4(1.0);
            head[3] = {0, 0, -.5, 1};
            request.display.heads = {head};
            expectNear(sightOf(worn, request).frustum, still);
        }
    }
}

/// A view whose eyes are 10 cm apart before a wall 2 m ahead.
config::Configuration focused(const std::string& mode, double distance) {
    return room("observer { eye_base .1 focus_mode " + mode + " focus_distance " +
                std::to_string(distance) + " } layout { view { observer 0 } } canvas { layout 0 " +
                kWall + " segment { channel \"a\" } }");
}

TEST(Plan, TheFocusMovesTheWallButNotWhatTheMiddleEyeSees) {
    PlanRequest request = canvasOf(640, 480);
    fabric::Mat4 head(1.0);
    head[3] = {0, 0, 1, 1};  // 3 m from the wall
    request.display.heads = {head};
    for (const auto& [mode, fromWall] : std::vector<std::pair<std::string, double>>{
             {"fixed", 3}, {"relative_to_origin", 6}, {"relative_to_observer", 5}}) {
        request.outputs[0].eye = Eye::Cyclop;
        const config::Configuration configuration = focused(mode, 5);
        const fabric::Frustum middle = sightOf(configuration, request).frustum;
        expectNear(middle, {-2. / 3, 2. / 3, -1. / 3, 1. / 3});
        request.outputs[0].eye = Eye::Left;
        const fabric::Frustum left = sightOf(configuration, request).frustum;
        EXPECT_NEAR(left.left - middle.left, .05 / fromWall, 1e-12) << mode;
    }
}

TEST(Plan, TwoEyesWithoutAWallMeetAtTheFocus) {
    PlanRequest request = canvasOf(640, 480);
    request.outputs[0].stereo = Stereo::SideBySide;
    request.fovYDegrees = 90;
    const Plan plan = planned(room("observer { eye_base .1 focus_distance 4 } layout { view { "
                                   "observer 0 } } canvas { layout 0 segment { channel \"a\" } }"),
                              request);
    ASSERT_EQ(plan.draws.size(), 2U);
    const fabric::Sight left = plan.draws[0].task.sight.value_or(fabric::Sight{});
    EXPECT_NEAR(left.eye.x, -.05, 1e-12);
    expectNear(left.frustum, {-4. / 3 + .05 / 4, 4. / 3 + .05 / 4, -1, 1});
    EXPECT_EQ(plan.pictures.size(), 1U);
}

}  // namespace
}  // namespace eyrie::compound
