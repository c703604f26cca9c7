// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/compound/jitter.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/swap_barriers.h"
#include "fabric/seen_area.h"
#include "layered_scene.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;
using testing::HasSubstr;

constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

config::Configuration read(const std::string& text) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

/// Channels "a" to "d" of 640 x 480, and these canvases, layouts and compounds.
config::Configuration room(const std::string& rest) {
    std::string windows;
    for (const char name : {'a', 'b', 'c', 'd'})
        windows += std::string("pipe { window { viewport [ 0 0 640 480 ] channel { name \"") +
                   name + "\" } } } ";
    return read("config { appNode { " + windows + " } " + rest + " }");
}

constexpr const char* kWall =
    "wall { bottom_left [ -2 -1 -2 ] bottom_right [ 2 -1 -2 ] top_left [ -2 1 -2 ] }";

/// Two segments beside each other on one wall.
config::Configuration powerWall(const std::string& compounds = {}) {
    return room(std::string("observer { eye_base .1 } layout { view { observer 0 } } "
                            "canvas { layout 0 ") +
                kWall +
                " segment { channel \"a\" viewport [ 0 0 .5 1 ] }"
                " segment { channel \"b\" viewport [ .5 0 .5 1 ] } } " +
                compounds);
}

PlanRequest canvasOf(std::int32_t width, std::int32_t height) {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = config::PixelSize{width, height};
    return request;
}

Plan planned(const config::Configuration& configuration, const PlanRequest& request) {
    const auto plan = makePlan(configuration, request);
    EXPECT_TRUE(plan.ok()) << plan.status();
    return plan.ok() ? *plan : Plan{};
}

void expectNear(const fabric::Frustum& a, const fabric::Frustum& b) {
    EXPECT_NEAR(a.left, b.left, 1e-12);
    EXPECT_NEAR(a.right, b.right, 1e-12);
    EXPECT_NEAR(a.bottom, b.bottom, 1e-12);
    EXPECT_NEAR(a.top, b.top, 1e-12);
}

TEST(Plan, SegmentsOfAWallArePartsOfOneView) {
    const Plan plan = planned(powerWall(), canvasOf(1280, 480));
    ASSERT_EQ(plan.draws.size(), 2U);
    for (const PlannedDraw& draw : plan.draws) {
        EXPECT_EQ(draw.task.viewWidth, 1280);
        EXPECT_EQ(draw.task.viewHeight, 480);
        EXPECT_FALSE(draw.task.wantsDepth);
        EXPECT_EQ(draw.task.sight, plan.draws[0].task.sight);
    }
    EXPECT_EQ(plan.draws[0].task.pixelViewport, (fabric::PixelViewport{0, 0, 640, 480}));
    EXPECT_EQ(plan.draws[1].task.pixelViewport, (fabric::PixelViewport{640, 0, 640, 480}));
    ASSERT_EQ(plan.pictures.size(), 1U);
    EXPECT_EQ(plan.pictures[0].area, (fabric::PixelViewport{0, 0, 1280, 480}));
}

TEST(Plan, ASegmentAloneIsTheSamePartOfTheSameView) {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].segment = 1;
    const Plan plan = planned(powerWall(), request);
    ASSERT_EQ(plan.draws.size(), 1U);
    EXPECT_EQ(plan.draws[0].task.viewWidth, 1280);
    EXPECT_EQ(plan.draws[0].task.pixelViewport, (fabric::PixelViewport{640, 0, 640, 480}));
    EXPECT_EQ(plan.pictures[0].area, (fabric::PixelViewport{0, 0, 640, 480}));
}

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

TEST(Plan, ScreensHaveTheNearestSwapBarrier) {
    const config::Configuration configuration = room(
        "layout { view { } } layout { view { } } canvas { layout 0 layout 1 "
        "segment { channel \"a\" viewport [ 0 0 .5 1 ] swapbarrier { name \"own\" } }"
        "segment { channel \"b\" viewport [ .5 0 .5 1 ] } }"
        "canvas { layout 0 swapbarrier { } segment { channel \"c\" } segment { channel \"d\" } } "
        "canvas { layout 1 segment { channel \"c\" } } "
        "compound { swapbarrier { name \"above\" } "
        "compound { channel ( canvas 0 segment 1 layout 0 view 0 ) } }");
    const auto of = [&](std::size_t canvas, std::optional<std::size_t> layout) {
        return config::swapBarriers(configuration, canvas, layout);
    };
    EXPECT_EQ(of(0, 0), (config::CanvasBarriers{"", {"own", "above"}}));
    EXPECT_EQ(of(0, 1), (config::CanvasBarriers{"", {"own", ""}}));
    EXPECT_EQ(of(0, std::nullopt), (config::CanvasBarriers{"", {"own", ""}}));
    EXPECT_EQ(of(1, 0), (config::CanvasBarriers{"canvas 1", {"canvas 1", "canvas 1"}}));
    EXPECT_EQ(of(2, 1), (config::CanvasBarriers{"", {""}}));
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

TEST(Plan, BandsAreDrawnOfWhatTheyShowOnly) {
    PlanRequest request = canvasOf(1280, 480);
    request.outputs[0].part = fabric::PixelViewport{0, 100, 700, 50};
    const Plan plan = planned(powerWall(), request);
    ASSERT_EQ(plan.draws.size(), 2U);
    EXPECT_EQ(plan.draws[0].task.pixelViewport, (fabric::PixelViewport{0, 100, 640, 50}));
    EXPECT_EQ(plan.draws[1].task.pixelViewport, (fabric::PixelViewport{640, 100, 60, 50}));
    request.outputs[0].part = fabric::PixelViewport{0, 0, 640, 480};
    EXPECT_EQ(planned(powerWall(), request).draws.size(), 1U);
}

TEST(Plan, WithoutAWallTheCameraSeesTheWholeView) {
    const Plan plan = planned(room("observer {} layout { view { observer 0 } } canvas { layout 0 "
                                   "segment { channel \"a\" viewport [ 0 0 .5 1 ] } "
                                   "segment { channel \"b\" viewport [ .5 0 .5 1 ] } }"),
                              canvasOf(200, 100));
    ASSERT_EQ(plan.draws.size(), 2U);
    EXPECT_EQ(plan.draws[1].task.viewWidth, 200);
    EXPECT_FALSE(plan.draws[1].task.sight.has_value());
    EXPECT_FALSE(plan.draws[1].task.raster.has_value());
}

TEST(Plan, DepthIsAskedForOnlyWhereItIsComparedOrWanted) {
    const config::Configuration data = powerWall(
        "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ]"
        "  compound { range [ 0 .5 ] }"
        "  compound { channel \"c\" range [ .5 1 ] outputframe { } }"
        "  inputframe { name \"frame.c\" } }");
    PlanRequest request = canvasOf(1280, 480);
    const Plan plan = planned(data, request);
    ASSERT_EQ(plan.draws.size(), 3U);
    EXPECT_TRUE(plan.draws[0].task.wantsDepth);
    EXPECT_TRUE(plan.draws[1].task.wantsDepth);
    EXPECT_FALSE(plan.draws[2].task.wantsDepth) << "the other segment";
    request.outputs[0].wantsDepth = true;
    for (const PlannedDraw& draw : planned(data, request).draws) EXPECT_TRUE(draw.task.wantsDepth);
}

TEST(Plan, WhatNobodyNeedsIsNotDrawn) {
    const Plan plan = planned(
        powerWall("compound { channel ( segment 0 view 0 )"
                  "  compound { viewport [ 0 0 1 1 ] }"
                  "  compound { channel \"c\" outputframe { } }"
                  "  compound { channel \"d\" outputframe { name \"unused\" } }"
                  "  compound { channel \"d\" range [ .5 .5 ] outputframe { name \"empty\" } }"
                  "  inputframe { name \"frame.c\" } }"),
        canvasOf(1280, 480));
    ASSERT_EQ(plan.draws.size(), 2U) << "that of channel c covers the destination's own";
    EXPECT_EQ(plan.draws[0].channel, (config::ChannelIndex{0, 2, 0, 0}));
    EXPECT_EQ(plan.draws[1].channel, (config::ChannelIndex{0, 1, 0, 0}));
}

TEST(Plan, FramesThatWaitForEachOtherAreRefused) {
    const auto plan = makePlan(
        powerWall("compound { channel ( segment 0 view 0 )"
                  " compound { channel \"c\" inputframe { name \"d\" } outputframe { name \"c\" } }"
                  " compound { channel \"d\" inputframe { name \"c\" } outputframe { name \"d\" } }"
                  " inputframe { name \"c\" } }"),
        canvasOf(1280, 480));
    EXPECT_EQ(plan.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(plan.status().message()), HasSubstr("wait for each other"));
    EXPECT_THAT(std::string(plan.status().message()),
                testing::StartsWith("the configuration, at 1:"));
}

TEST(Plan, OfFramesThatWaitForEachOtherEachRingIsFoundAndNothingElse) {
    Refusals refusals;
    const config::Configuration configuration = powerWall(
        "compound { channel ( segment 0 view 0 )\n"
        "compound { name \"one\" channel \"c\" inputframe { name \"3\" } outputframe { name \"1\" "
        "} }\n"
        "compound { name \"two\" channel \"d\" inputframe { name \"1\" } outputframe { name \"2\" "
        "} }\n"
        "compound { channel \"b\" inputframe { name \"2\" } outputframe { name \"3\" } }\n"
        "compound { channel \"a\" inputframe { name \"3\" } outputframe { name \"late\" } }\n"
        "inputframe { name \"late\" } }\n"
        "compound { channel ( segment 1 view 0 )\n"
        "compound { channel \"c\" inputframe { name \"own\" } outputframe { name \"own\" } }\n"
        "inputframe { name \"own\" } }");
    EXPECT_FALSE(makePlan(configuration, canvasOf(1280, 480), refusals));
    EXPECT_EQ(describe(refusals.impossible, "f"),
              "f:2:1: error: compounds wait for each other's frames: this one, \"two\" at 3:1, one "
              "at 4:1; one of two that exchange frames has to read back before it assembles, in a "
              "compound of its own\n"
              "f:8:1: error: the compound takes a frame that it makes itself, once it has taken "
              "it\n");
    EXPECT_FALSE(refusals.tooLarge.hasErrors());
}

TEST(Plan, NamesWhatIsNotThere) {
    PlanRequest request = canvasOf(10, 10);
    request.outputs[0].canvas = 3;
    EXPECT_THAT(std::string(makePlan(powerWall(), request).status().message()),
                HasSubstr("no canvas 3: the configuration has 1"));
    request.outputs[0].canvas = 0;
    request.outputs[0].segment = 2;
    EXPECT_THAT(std::string(makePlan(powerWall(), request).status().message()),
                HasSubstr("no segment 2: canvas 0 has 2"));
    EXPECT_THAT(std::string(makePlan(powerWall(), canvasOf(0, 10)).status().message()),
                HasSubstr("0x10"));
}

TEST(Plan, AnOffCanvasShowsNothing) {
    PlanRequest request = canvasOf(64, 48);
    request.display.canvases.resize(1);
    request.display.canvases[0].layout = std::nullopt;
    const Plan plan = planned(powerWall(), request);
    EXPECT_TRUE(plan.draws.empty());
    const auto pictures = composePictures(plan, {}, {1, 2, 3, 255});
    ASSERT_EQ(pictures.size(), 1U);
    EXPECT_EQ(pictures[0], fabric::makeImage({0, 0, 64, 48}, {1, 2, 3, 255}, false));
}

fabric::Sight sightOf(const config::Configuration& configuration, const PlanRequest& request) {
    const Plan plan = planned(configuration, request);
    EXPECT_FALSE(plan.draws.empty());
    return plan.draws.empty() ? fabric::Sight{}
                              : plan.draws[0].task.sight.value_or(fabric::Sight{});
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

TEST(Plan, AnaglyphsTakeTheirMasksFromTheCompound) {
    const config::Configuration stereo = room(
        "observer {} layout { view { observer 0 mode STEREO } } canvas { layout 0 wall {} "
        "segment { channel \"a\" } } compound { channel ( segment 0 view 0 ) attributes { "
        "stereo_anaglyph_left_mask [ GREEN ] stereo_anaglyph_right_mask [ RED BLUE ] } }");
    const Plan plan = planned(stereo, canvasOf(20, 10));
    ASSERT_EQ(plan.draws.size(), 2U);
    ASSERT_EQ(plan.pictures.size(), 1U);
    std::vector<fabric::LentImage> drawn;
    for (const PlannedDraw& draw : plan.draws) {
        const bool isLeft = draw.task.sight && draw.task.sight->eye.x < 0;
        drawn.push_back(fabric::makeImage(
            draw.task.pixelViewport,
            isLeft ? fabric::Rgba{1, 2, 3, 255} : fabric::Rgba{7, 8, 9, 255}, false));
    }
    const auto pictures = composePictures(plan, drawn, {});
    EXPECT_EQ(pictures[0].colour[0], (fabric::Rgba{7, 2, 9, 255}));
}

TEST(Plan, EyesOfSegmentsOfTheirOwnArePicturesOfTheirOwn) {
    const config::Configuration passive = room(
        "observer {} layout { view { observer 0 mode STEREO } } canvas { layout 0 wall {} "
        "segment { channel \"a\" eye [ LEFT ] } segment { channel \"b\" eye [ RIGHT ] } }");
    const Plan plan = planned(passive, canvasOf(64, 48));
    ASSERT_EQ(plan.pictures.size(), 2U);
    EXPECT_EQ(plan.pictures[0].eye, Eye::Left);
    EXPECT_EQ(plan.pictures[1].eye, Eye::Right);
    EXPECT_EQ(plan.draws.size(), 2U);
    PlanRequest request = canvasOf(64, 48);
    request.outputs[0].segment = 0;
    request.outputs[0].eye = Eye::Right;
    EXPECT_THAT(std::string(makePlan(passive, request).status().message()),
                HasSubstr("shown to the right eye"));
}

/// What may stand anywhere, sensible or not.
double anyNumber(std::mt19937& random) {
    static constexpr double kOdd[] = {0,
                                      1,
                                      .5,
                                      .25,
                                      -1,
                                      2,
                                      1e-12,
                                      1e300,
                                      -1e300,
                                      std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity()};
    return random() % 2 == 0 ? static_cast<double>(random() % 1001) / 1000
                             : kOdd[random() % std::size(kOdd)];
}

config::Compound& anyCompound(std::vector<config::Compound>& among, std::mt19937& random) {
    config::Compound& found = among[random() % among.size()];
    return found.children.empty() || random() % 3 == 0 ? found
                                                       : anyCompound(found.children, random);
}

void editNumbers(config::Compound& compound, std::mt19937& random) {
    const auto small = [&] { return static_cast<std::int64_t>(random() % 5) - 1; };
    switch (random() % 6) {
        case 0:
            compound.viewport = {anyNumber(random), anyNumber(random), anyNumber(random),
                                 anyNumber(random)};
            break;
        case 1:
            compound.range = {anyNumber(random), anyNumber(random)};
            break;
        case 2:
            compound.pixel = {small(), small(), small() + 1, small() + 1};
            break;
        case 3:
            compound.subpixel = {small(), small()};
            break;
        case 4:
            compound.zoom = {anyNumber(random), anyNumber(random)};
            break;
        default:
            compound.period = small() + 1;
            compound.phase = small();
    }
}

void editShape(config::Configuration& configuration, config::Compound& compound,
               std::mt19937& random) {
    config::Compound& other = anyCompound(configuration.compounds, random);
    switch (random() % 6) {
        case 0:
            compound.channel = other.channel;
            break;
        case 1:
            compound.children.clear();
            break;
        case 2:
            std::swap(compound.inputFrames, other.inputFrames);
            break;
        case 3:
            std::swap(compound.outputFrames, other.outputFrames);
            break;
        case 4:
            compound.tasks = config::Tasks{random() % 2 == 0, random() % 2 == 0, random() % 2 == 0,
                                           random() % 2 == 0};
            break;
        default:
            for (config::Frame& frame : compound.outputFrames) {
                frame.viewport.height = anyNumber(random);
                frame.zoom = fabric::Vec2(anyNumber(random), 1);
            }
            for (config::Frame& frame : compound.inputFrames) {
                frame.viewport.x = anyNumber(random);
                frame.zoom = fabric::Vec2(1, anyNumber(random));
            }
    }
}

void edit(config::Configuration& configuration, std::mt19937& random) {
    if (configuration.compounds.empty())
        return;
    for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
        config::Compound& compound = anyCompound(configuration.compounds, random);
        if (random() % 2 == 0)
            editNumbers(compound, random);
        else
            editShape(configuration, compound, random);
    }
}

TEST(Plan, CopesWithWhateverABalancerOrAnEditorWrites) {
    std::mt19937 random(11);
    const LayeredScene scene(1);
    int refused = 0;
    int composed = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        config::Findings findings;
        const config::Configuration whole = config::readEqc(text, findings);
        for (int i = 0; i < 20; ++i) {
            config::Configuration edited = whole;
            edit(edited, random);
            PlanRequest request = canvasOf(48, 32);
            request.frameNumber = random();
            request.outputs[0].stereo = static_cast<Stereo>(random() % 5);
            const auto plan = makePlan(edited, request);
            if (!plan.ok()) {
                ++refused;
                EXPECT_EQ(plan.status().code(), absl::StatusCode::kInvalidArgument);
                continue;
            }
            ++composed;
            std::vector<fabric::LentImage> drawn;
            std::int64_t pixels = 0;
            for (const PlannedDraw& draw : plan->draws) pixels += draw.task.pixelViewport.area();
            if (pixels > 200'000)
                continue;
            for (const PlannedDraw& draw : plan->draws)
                drawn.push_back(scene.draw(draw.task).image);
            EXPECT_EQ(composePictures(*plan, std::move(drawn), {}).size(), plan->pictures.size());
        }
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(composed, 100);
}

TEST(Jitter, HasEverySampleInAColumnAndARowOfItsOwn) {
    for (const std::int64_t count : {1, 2, 3, 4, 5, 7, 8, 16, 24, 66, 256}) {
        std::vector<bool> columns(static_cast<std::size_t>(count), false);
        std::vector<bool> rows = columns;
        for (std::int64_t i = 0; i < count; ++i) {
            const fabric::Vec2 place = (jitter(i, count) + .5) * static_cast<double>(count) - .5;
            EXPECT_NEAR(place.x, std::round(place.x), 1e-9);
            EXPECT_NEAR(place.y, std::round(place.y), 1e-9);
            columns.at(static_cast<std::size_t>(std::lround(place.x))) = true;
            rows.at(static_cast<std::size_t>(std::lround(place.y))) = true;
        }
        EXPECT_EQ(std::count(columns.begin(), columns.end(), false), 0) << count;
        EXPECT_EQ(std::count(rows.begin(), rows.end(), false), 0) << count;
    }
}

}  // namespace
}  // namespace eyrie::compound
