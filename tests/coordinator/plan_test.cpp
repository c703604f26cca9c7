// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/config/swap_barriers.h"
#include "planned_room.h"

namespace eyrie::compound {
namespace {

using testing::HasSubstr;

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

/// As Equalizer has it, and as nearly all of its own walls are written.
TEST(Plan, SwapBarriersWithoutANameJoinTheScreensOfARoot) {
    const config::Configuration configuration = room(
        "layout { view { } } canvas { layout 0 "
        "segment { channel \"a\" } segment { channel \"b\" } segment { channel \"c\" } "
        "segment { channel \"d\" } } "
        "compound { compound { channel ( segment 0 view 0 ) swapbarrier { } } "
        "           compound { compound { channel ( segment 1 view 0 ) swapbarrier { } } } } "
        "compound { channel ( segment 2 view 0 ) swapbarrier { } } "
        "compound { channel ( segment 3 view 0 ) }");
    EXPECT_EQ(config::swapBarriers(configuration, 0, 0),
              (config::CanvasBarriers{"", {"compound 0", "compound 0", "compound 1", ""}}));
}

TEST(Plan, SwapBarriersWithoutANameJoinTheSegmentsOfACanvas) {
    const config::Configuration configuration = room(
        "layout { view { } } canvas { layout 0 "
        "segment { channel \"a\" swapbarrier { } } segment { channel \"b\" swapbarrier { } } "
        "segment { channel \"c\" } }");
    EXPECT_EQ(config::swapBarriers(configuration, 0, 0),
              (config::CanvasBarriers{"", {"canvas 0", "canvas 0", ""}}));
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

TEST(Plan, TakesTheStereoModeOfTheGlobalsInBothSpellings) {
    config::Configuration stereo = room(
        "observer {} layout { view { observer 0 mode STEREO } } canvas { layout 0 wall {} "
        "segment { channel \"a\" eye [ LEFT ] } segment { channel \"b\" eye [ RIGHT ] } }");
    for (const auto& [word, pictures] :
         {std::pair{"PASSIVE", 2U}, {"ANAGLYPH", 1U}, {"anaglyph", 1U}}) {
        stereo.globals = {{"EQ_COMPOUND_IATTR_STEREO_MODE", config::Attribute::Words{{word}}}};
        EXPECT_EQ(planned(stereo, canvasOf(20, 10)).pictures.size(), pictures) << word;
    }
}

/// A helper's segment in the same place, such as of a canvas that is read back and not shown.
TEST(Plan, ASegmentThatDrawsNothingHidesNoOther) {
    for (const char* const task : {"[ READBACK ]", "[ CLEAR ]", "[ ]"}) {
        const config::Configuration both = room(
            "layout { view {} } canvas { layout 0 segment { channel \"a\" } segment { channel "
            "\"b\" } } "
            "compound { compound { channel ( segment 0 view 0 ) } compound { channel ( segment 1 "
            "view "
            "0 ) task " +
            std::string(task) + " } }");
        const Plan plan = planned(both, canvasOf(20, 10));
        ASSERT_EQ(plan.draws.size(), 1U) << task;
        ASSERT_EQ(plan.pictures.size(), 1U);
        EXPECT_EQ(plan.pictures[0].parts.size(), 1U) << task;
        const auto drawn =
            fabric::makeImage(plan.draws[0].task.pixelViewport, {7, 8, 9, 255}, false);
        const auto pictures = composePictures(plan, {drawn}, {1, 2, 3, 255});
        EXPECT_EQ(pictures[0].colour[0], (fabric::Rgba{7, 8, 9, 255})) << task;
    }
    const config::Configuration alone = room(
        "layout { view {} } canvas { layout 0 segment { channel \"a\" viewport [ 0 0 .5 1 ] } "
        "segment "
        "{ channel \"b\" } } compound { compound { channel ( segment 0 view 0 ) } compound { "
        "channel ( "
        "segment 1 view 0 ) task [ CLEAR ] } }");
    EXPECT_EQ(planned(alone, canvasOf(20, 10)).pictures[0].parts.size(), 2U)
        << "no other shows all of its place";
}

/// One channel that shows both eyes, in a window of these settings.
config::Configuration stereoIn(const std::string& global, const std::string& window,
                               const std::string& channel, const std::string& compounds) {
    config::Findings findings;
    const config::Configuration read = config::readEqc(
        "global { " + global + " } server { config { appNode { pipe { window { attributes { " +
            window + " } viewport [ 0 0 64 48 ] channel { name \"a\" " + channel +
            " } } } } observer {} layout { view { observer 0 mode STEREO } } canvas { layout 0 "
            "wall {} segment { channel \"a\" } } " +
            compounds + " } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return read;
}

/// As Equalizer resolves AUTO.
TEST(Plan, StereoWindowsHaveAPictureForEachEye) {
    const auto pictures = [](const std::string& global, const std::string& window,
                             const std::string& channel = {}, const std::string& compounds = {}) {
        return planned(stereoIn(global, window, channel, compounds), canvasOf(20, 10))
            .pictures.size();
    };
    const std::string on = "EQ_WINDOW_IATTR_HINT_STEREO ON";
    EXPECT_EQ(pictures("", ""), 1U);
    EXPECT_EQ(pictures("", "hint_stereo ON"), 2U);
    EXPECT_EQ(pictures("", "hint_stereo 1"), 2U);
    EXPECT_EQ(pictures("", "hint_stereo AUTO"), 1U);
    EXPECT_EQ(pictures(on, ""), 2U);
    EXPECT_EQ(pictures(on, "hint_stereo OFF"), 1U) << "the window's own counts";
    EXPECT_EQ(pictures("", "hint_stereo ON hint_drawable window"), 2U);
    EXPECT_EQ(pictures("", "hint_stereo ON hint_drawable FBO"), 1U);
    EXPECT_EQ(pictures(on, "hint_drawable pbuffer"), 1U);
    EXPECT_EQ(pictures(on + " EQ_WINDOW_IATTR_HINT_DRAWABLE FBO", ""), 1U);
    EXPECT_EQ(pictures(on + " EQ_WINDOW_IATTR_HINT_DRAWABLE FBO", "hint_drawable window"), 2U);
    EXPECT_EQ(pictures(on, "", "drawable [ FBO_COLOR FBO_DEPTH ]"), 1U);
    EXPECT_EQ(pictures(on, "", "",
                       "compound { channel ( segment 0 view 0 ) attributes { stereo_mode ANAGLYPH "
                       "} }"),
              1U)
        << "as the compound says";
}

TEST(Plan, StereoWindowsShowTheLeftEyeFirst) {
    const Plan plan = planned(stereoIn("", "hint_stereo ON", "", ""), canvasOf(20, 10));
    ASSERT_EQ(plan.pictures.size(), 2U);
    EXPECT_EQ(plan.pictures[0].eye, Eye::Left);
    EXPECT_EQ(plan.pictures[1].eye, Eye::Right);
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

}  // namespace
}  // namespace eyrie::compound
