// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/equalizers.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/config/equalizer_limits.h"
#include "tests/coordinator/balanced_scene.h"

namespace eyrie::equalizer {
namespace {

using testing::HasSubstr;

constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

config::Configuration sample(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    config::Findings findings;
    return config::readEqc(std::string(std::istreambuf_iterator<char>(in), {}), findings);
}

const Spot kRight{{.75, 0, 1, 1}, 60, 40};

double even(const config::ResolvedCompound& part) {
    return 100 * (part.range.end - part.range.begin) * part.viewport.width * part.viewport.height;
}

TEST(TreeEqualizer, SharesOutWhatTheTimesOfItsSubtreesSay) {
    for (const char* mode : {"2D", "DB", "VERTICAL"}) {
        Balanced balanced(configurationOf(
            3, sharedBetween(4, std::string("tree_equalizer { mode ") + mode + " }")));
        for (int frame = 0; frame < 20; ++frame) balanced.draw(kRight);
        const std::vector<double> times = balanced.draw(kRight);
        EXPECT_LE(*std::ranges::max_element(times), 25 * 1.1) << mode;
        EXPECT_NEAR(balanced.equalizers.states()[0].report.imbalance, 1, .1);
    }
}

TEST(TreeEqualizer, ComesToRestWhileFramesAreInFlight) {
    for (const int children : {2, 4})
        for (const std::size_t late : {1, 3}) {
            Balanced balanced(
                configurationOf(children - 1, sharedBetween(children, "tree_equalizer { }")));
            balanced.late = late;
            std::vector<double> times;
            for (int frame = 0; frame < 40; ++frame) times = balanced.draw(kRight);
            EXPECT_LE(*std::ranges::max_element(times), 1.15 * 100 / children)
                << children << " children, " << late << " late";
        }
}

TEST(TreeEqualizer, CutsPicturesByTurnsAcrossAndAlong) {
    Balanced balanced(configurationOf(3, sharedBetween(4, "tree_equalizer { }")));
    balanced.apply();
    for (std::size_t i = 1; i <= 4; ++i)
        EXPECT_EQ(balanced.at(i).pixelViewport.width * 9, balanced.at(i).pixelViewport.height * 16);
}

/// Of a wall of two segments the left one has nine tenths of the load.
double leftHeavy(const Balanced& wall, const config::ResolvedCompound& part) {
    const bool isLeft = wall.resolved.destinations[*part.destination].index.segment == 0;
    return (isLeft ? 90 : 10) * part.viewport.width * part.viewport.height;
}

TEST(ViewEqualizer, GivesSegmentsPipesByTheirLoad) {
    Balanced wall(sample(std::string(kFolder) + "/8-window.wall.lb.eqc"));
    std::vector<double> times;
    for (int frame = 0; frame < 20; ++frame)
        times = wall.draw([&](const auto& part) { return leftHeavy(wall, part); });
    int left = 0;
    int right = 0;
    for (const config::ResolvedCompound& each : wall.resolved.compounds)
        if (each.tasks.draw)
            ++(wall.resolved.destinations[*each.destination].index.segment == 0 ? left : right);
    EXPECT_GE(left, 7);
    EXPECT_GE(right, 1);
    EXPECT_LE(right, 2);
    EXPECT_LE(*std::ranges::max_element(times), 100. / 8 * 1.3) << "of eight pipes";
}

TEST(ViewEqualizer, LetsAPipeServeTwoSegmentsAtMost) {
    std::string segments = "compound { view_equalizer { }";
    for (int segment = 0; segment < 3; ++segment)
        segments += fmt::format(
            " compound {{ channel ( segment {} view 0 ) load_equalizer {{ }} "
            "compound {{ }} compound {{ channel \"help\" }} }}",
            segment);
    config::Findings findings;
    const std::string pipe = "pipe { window { channel { name \"";
    config::Configuration configuration =
        config::readEqc("server { config { appNode { " + pipe + "a\" } } }" + pipe + "b\" } } }" +
                            pipe + "c\" } } }" + pipe +
                            "help\" } } } } layout { view { } } canvas { layout 0 "
                            "segment { channel \"a\" viewport [ 0 0 .3 1 ] } "
                            "segment { channel \"b\" viewport [ .3 0 .3 1 ] } "
                            "segment { channel \"c\" viewport [ .6 0 .4 1 ] } } " +
                            segments + " } } }",
                        findings);
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    Balanced wall(std::move(configuration));
    for (int frame = 0; frame < 10; ++frame) wall.draw(even);
    int served = 0;
    for (const std::size_t helper : {3, 6, 9}) served += wall.at(helper).tasks.draw ? 1 : 0;
    EXPECT_GE(served, 1);
    EXPECT_LE(served, 2);
}

TEST(FramerateEqualizer, SpacesTheFramesOfAPeriodEvenly) {
    Balanced balanced(sample(std::string(kFolder) + "/3-window.DPlex.eqc"));
    EXPECT_EQ(balanced.equalizers.states()[0].report.framesPerSecond, 0);
    for (int frame = 0; frame < 4; ++frame) {
        balanced.apply();
        FrameTimes times{balanced.number, std::vector<CompoundTime>(3)};
        times.compounds[frame % 2 == 0 ? 1 : 2].draw = frame % 2 == 0 ? 30 : 50;
        balanced.equalizers.record(times);
    }
    EXPECT_NEAR(balanced.equalizers.states()[0].report.framesPerSecond, 1000 / (40. / 2 * 1.05),
                1e-9);
    EXPECT_NEAR(balanced.equalizers.intervalMilliseconds(), 40. / 2 * 1.05, 1e-9);
    Tuning off;
    off.isOn = false;
    ASSERT_TRUE(balanced.equalizers.tune(0, off).ok());
    balanced.apply();
    EXPECT_EQ(balanced.equalizers.intervalMilliseconds(), 0);
    Tuning on;
    on.isOn = true;
    ASSERT_TRUE(balanced.equalizers.tune(0, on).ok());
    balanced.apply();
    EXPECT_GT(balanced.equalizers.intervalMilliseconds(), 0);
    for (config::Destination& each : balanced.resolved.destinations) each.isShown = false;
    config::Configuration live = balanced.live;
    balanced.equalizers.apply(live, {balanced.number + 1, balanced.resolved, {}});
    EXPECT_EQ(balanced.equalizers.intervalMilliseconds(), 0) << "of what is not shown";
    for (config::Destination& each : balanced.resolved.destinations) each.isShown = true;
    balanced.equalizers.apply(
        live, {.frameNumber = balanced.number + 2, .resolved = balanced.resolved, .canvases = {7}});
    EXPECT_EQ(balanced.equalizers.intervalMilliseconds(), 0) << "of what another canvas shows";
}

TEST(FramerateEqualizer, AddsUpWhatOnePipeDrawsForAFrame) {
    Balanced balanced(configurationOf(
        1,
        "compound { channel ( segment 0 view 0 ) framerate_equalizer { } compound { } compound "
        "{ } compound { channel \"s1\" } }"));
    balanced.draw([](const auto&) { return 20; });
    EXPECT_NEAR(balanced.equalizers.intervalMilliseconds(), 40 * 1.05, 1e-9);
}

const std::string kReduced =
    "compound { channel ( segment 0 view 0 ) compound { DFR_equalizer { framerate 20 } "
    "outputframe { name \"small\" } } inputframe { name \"small\" } }";

TEST(DfrEqualizer, HoldsAFrameRateByTheNumberOfPixels) {
    Balanced balanced(configurationOf(0, kReduced));
    std::vector<double> times;
    for (int frame = 0; frame < 20; ++frame)
        times = balanced.draw([](const config::ResolvedCompound& part) {
            return 1e-4 * static_cast<double>(part.pixelViewport.area()) *
                   (part.range.end - part.range.begin);
        });
    EXPECT_NEAR(times[1], 50, 1);
    EXPECT_NEAR(balanced.equalizers.states()[0].report.framesPerSecond, 20, .5);
}

TEST(DfrEqualizer, ComesToRestWhileFramesAreInFlight) {
    for (const double damping : {.5, 1.0})
        for (const std::size_t late : {0, 1, 3, 7}) {
            Balanced balanced(configurationOf(0, kReduced));
            Tuning tuning;
            tuning.damping = damping;
            ASSERT_TRUE(balanced.equalizers.tune(0, tuning).ok());
            balanced.late = late;
            for (int frame = 0; frame < 60; ++frame) {
                const std::vector<double> times = balanced.draw([](const auto& part) {
                    return 1e-4 * static_cast<double>(part.pixelViewport.area());
                });
                if (frame >= 40) {
                    EXPECT_NEAR(times[1], 50, 1) << damping << ", " << late << " late";
                }
            }
        }
}

TEST(DfrEqualizer, HoldsTheRateOfChildrenThatDrawOneAfterTheOther) {
    Balanced balanced(configurationOf(
        1,
        "compound { channel ( segment 0 view 0 ) compound { DFR_equalizer { framerate 20 } "
        "compound { range [ 0 .3 ] } compound { range [ .3 .8 ] } compound { range [ .8 1 ] "
        "channel \"s1\" } outputframe { name \"small\" } } inputframe { name \"small\" } }"));
    std::vector<double> times;
    for (int frame = 0; frame < 20; ++frame)
        times = balanced.draw([](const config::ResolvedCompound& part) {
            return 1e-4 * static_cast<double>(part.pixelViewport.area());
        });
    EXPECT_NEAR(times[2] + times[3], 50, 1);
    EXPECT_NEAR(balanced.equalizers.states()[0].report.framesPerSecond, 20, .5);
}

TEST(DfrEqualizer, ReportsNothingOfBeforeItWasSwitchedOff) {
    Balanced balanced(configurationOf(0, kReduced));
    for (int frame = 0; frame < 5; ++frame) balanced.draw([](const auto&) { return 1e3; });
    EXPECT_LT(balanced.equalizers.states()[0].report.zoom, 1);
    Tuning off;
    off.isOn = false;
    ASSERT_TRUE(balanced.equalizers.tune(0, off).ok());
    balanced.draw([](const auto&) { return 1e3; });
    EXPECT_EQ(balanced.equalizers.states()[0].report.zoom, 1);
    EXPECT_EQ(balanced.equalizers.states()[0].report.framesPerSecond, 0);
}

TEST(DfrEqualizer, LeavesFramesThatAreToBeCompleteAsTheyAreWritten) {
    Balanced balanced(configurationOf(0, kReduced));
    const auto slow = [](const config::ResolvedCompound& part) {
        return 1e-3 * static_cast<double>(part.pixelViewport.area());
    };
    for (int frame = 0; frame < 20; ++frame) balanced.draw(slow);
    const fabric::PixelViewport moving = balanced.at(1).pixelViewport;
    EXPECT_LT(moving.width, 640);
    balanced.isComplete = true;
    balanced.draw(slow);
    EXPECT_EQ(balanced.at(1).pixelViewport, (fabric::PixelViewport{0, 0, 1280, 720}));
    balanced.isComplete = false;
    balanced.draw(slow);
    EXPECT_NEAR(balanced.at(1).pixelViewport.width, moving.width, 4) << "it learned from that";
}

TEST(DfrEqualizer, KeepsToTheLimitsOfThePicture) {
    Balanced balanced(configurationOf(0, kReduced));
    for (int frame = 0; frame < 20; ++frame) balanced.draw([](const auto&) { return 1e8; });
    EXPECT_EQ(balanced.at(1).pixelViewport.height, 128);
    for (int frame = 0; frame < 20; ++frame) balanced.draw([](const auto&) { return .001; });
    EXPECT_EQ(balanced.at(1).pixelViewport, (fabric::PixelViewport{0, 0, 1280, 720}));
}

/// A channel 67 times as high as what is shown, as on a page that is folded up.
TEST(DfrEqualizer, EnlargesNoMoreThanPlansTake) {
    config::Findings findings;
    Balanced balanced(config::readEqc(
        "config { appNode { pipe { window { viewport [ 0 0 16 16 ] channel { name \"a\" } } window "
        "{ viewport [ 0 0 1920 1080 ] channel { name \"b\" } } } } layout { view { } } canvas { "
        "layout 0 segment { channel \"a\" } } compound { channel ( segment 0 view 0 ) compound { "
        "DFR_equalizer { framerate 20 } channel \"b\" outputframe { name \"large\" } } inputframe "
        "{ name \"large\" } } }",
        findings));
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    for (int frame = 0; frame < 20; ++frame) balanced.draw([](const auto&) { return .001; });
    EXPECT_EQ(balanced.live.compounds[0].children[0].zoom,
              fabric::Vec2(config::kMostZoom, config::kMostZoom));
}

/// Every fourth pixel, by a channel that has room for more than a page shows.
TEST(DfrEqualizer, EnlargesNoShareOfPixels) {
    config::Findings findings;
    Balanced balanced(config::readEqc(
        "config { appNode { pipe { window { viewport [ 0 0 1280 720 ] channel { name \"a\" } } "
        "window { viewport [ 0 0 1920 1080 ] channel { name \"b\" } } } } layout { view { } } "
        "canvas { layout 0 segment { channel \"a\" } } compound { channel ( segment 0 view 0 ) "
        "compound { DFR_equalizer { framerate 20 } channel \"b\" pixel [ 0 0 4 1 ] outputframe { "
        "name \"some\" } } inputframe { name \"some\" } } }",
        findings));
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    for (int frame = 0; frame < 20; ++frame) balanced.draw([](const auto&) { return .001; });
    EXPECT_EQ(balanced.live.compounds[0].children[0].zoom, fabric::Vec2(1, 1));
}

TEST(TileEqualizer, HasChildrenFetchTilesWhileItIsOn) {
    Balanced balanced(sample(std::string(kFolder) + "/2-node.tile.eqc"));
    balanced.apply();
    const config::Compound& root = balanced.live.compounds[0];
    ASSERT_EQ(root.outputTiles.size(), 1U);
    EXPECT_EQ(root.outputTiles[0].size, fabric::Vec2(64, 64));
    for (const config::Compound& child : root.children) {
        ASSERT_EQ(child.inputTiles.size(), 1U);
        EXPECT_EQ(child.inputTiles[0].name, root.outputTiles[0].name);
    }
    Tuning off;
    off.isOn = false;
    EXPECT_TRUE(balanced.equalizers.tune("0", off).ok());
    balanced.apply();
    EXPECT_TRUE(balanced.live == balanced.written);
}

TEST(TileEqualizer, HasAQueueOfItsOwnWhateverItIsCalled) {
    const std::string half =
        "compound { name \"half\" tile_equalizer { name \"q\" } compound { } compound { channel "
        "\"s1\" } } ";
    Balanced balanced(
        configurationOf(1, "compound { channel ( segment 0 view 0 ) " + half + half + "}"));
    balanced.apply();
    const std::vector<config::Compound>& halves = balanced.live.compounds[0].children;
    EXPECT_NE(halves[0].outputTiles[0].name, halves[1].outputTiles[0].name);
    for (const config::Compound& each : halves) {
        EXPECT_EQ(each.children[0].inputTiles, each.outputTiles);
        EXPECT_EQ(each.children[1].inputTiles, each.outputTiles);
    }
}

TEST(TileEqualizer, LeavesWhatIsReadBackBelowItAsItIsWritten) {
    Balanced balanced(configurationOf(
        2,
        "compound { channel ( segment 0 view 0 ) tile_equalizer { } "
        "compound { viewport [ 0 0 .5 1 ] compound { } compound { channel \"s1\" outputframe { "
        "name \"a\" } } inputframe { name \"a\" } } "
        "compound { viewport [ .5 0 .5 1 ] channel \"s2\" compound { } outputframe { name "
        "\"b\" } } inputframe { name \"b\" } }"));
    balanced.apply();
    const config::Compound& root = balanced.live.compounds[0];
    EXPECT_EQ(root.children[0].viewport, config::Viewport{});
    for (const config::Compound& taker : root.children[0].children)
        EXPECT_EQ(taker.inputTiles, root.outputTiles);
    EXPECT_TRUE(root.children[1] == balanced.written.compounds[0].children[1]);
}

TEST(TileEqualizer, TakesTurnsWithALoadEqualizer) {
    Balanced balanced(
        configurationOf(1, sharedBetween(2, "load_equalizer { } tile_equalizer { size .25 }")));
    Tuning on;
    on.isOn = true;
    Tuning off;
    off.isOn = false;
    EXPECT_TRUE(balanced.equalizers.tune("load.0", off).ok());
    balanced.apply();
    EXPECT_EQ(balanced.live.compounds[0].outputTiles[0].chunk, .25);
    EXPECT_EQ(balanced.at(2).viewport, config::Viewport{});
    EXPECT_TRUE(balanced.equalizers.tune("load.0", on).ok());
    EXPECT_TRUE(balanced.equalizers.tune("tile.0", off).ok());
    balanced.apply();
    EXPECT_TRUE(balanced.live.compounds[0].outputTiles.empty());
    EXPECT_EQ(balanced.at(2).viewport, (config::Viewport{.5, 0, .5, 1}));
}

TEST(MonitorEqualizer, HasPicturesReadAsSmallAsTheyAreShown) {
    Balanced balanced(sample(std::string(kFolder) + "/3-window.monitor.eqc"));
    balanced.apply();
    const config::Compound& root = balanced.live.compounds[0];
    const auto pixels = [&](std::size_t i) { return balanced.at(i).pixelViewport; };
    for (std::size_t i = 0; i < 2; ++i) {
        const auto zoom = root.children[i].outputFrames[0].zoom;
        ASSERT_TRUE(zoom.has_value());
        EXPECT_DOUBLE_EQ(zoom->x, pixels(3).width / 2. / pixels(i + 1).width);
        EXPECT_DOUBLE_EQ(zoom->y, static_cast<double>(pixels(3).height) / pixels(i + 1).height);
        EXPECT_EQ(root.children[2].inputFrames[i].viewport, config::Viewport{});
    }
    Tuning off;
    off.isOn = false;
    EXPECT_TRUE(balanced.equalizers.tune("monitor.3", off).ok());
    balanced.apply();
    EXPECT_TRUE(balanced.live == balanced.written);
}

/// A wall of 1280 x 720 whose picture, frame "w", comes to these, and the places of the compounds
/// that take it: 2 and 3. `other` is what that of the first does in its canvas's other layout.
Balanced wallWithMonitors(const std::string& first, const std::string& second,
                          const std::string& other = "") {
    const auto window = [](const char* channel, int width, int height) {
        return fmt::format("window {{ viewport [ 0 0 {} {} ] channel {{ name \"{}\" }} }} ", width,
                           height, channel);
    };
    const std::string canvas = "canvas { layout 0 segment { channel \"";
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "server { config { appNode { pipe { " + window("wall", 1280, 720) + window("a", 640, 90) +
            window("b", 320, 360) + "} } layout { view { } } layout { view { } } " + canvas +
            "wall\" } } canvas { layout 0 layout 1 segment { channel \"a\" } } " + canvas +
            "b\" } }\n"
            "compound { compound { channel ( canvas 0 segment 0 layout 0 view 0 ) outputframe { "
            "name \"w\" zoom [ .75 .125 ] } }\n"
            "compound { channel ( canvas 1 segment 0 layout 0 view 0 ) " +
            first + " }\ncompound { channel ( canvas 2 segment 0 layout 0 view 0 ) " + second +
            " }\ncompound { channel ( canvas 1 segment 0 layout 1 view 0 ) " + other + " } } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    return Balanced(std::move(configuration));
}

std::optional<fabric::Vec2> wallZoom(const Balanced& wall) {
    return wall.live.compounds[0].children[0].outputFrames[0].zoom;
}

const std::string kMonitor = "monitor_equalizer { } inputframe { name \"w\" }";

TEST(MonitorEqualizer, HasAFrameReadAsLargeAsTheLargestOfItsMonitorsShowsIt) {
    Balanced wall = wallWithMonitors(kMonitor, kMonitor);
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.5, .5)) << "across for one, along for the other";
    Tuning frozen;
    frozen.isFrozen = true;
    ASSERT_TRUE(wall.equalizers.tune("monitor.2", frozen).ok());
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.5, .5));
    Tuning off;
    off.isOn = false;
    ASSERT_TRUE(wall.equalizers.tune("monitor.2", off).ok());
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.75, .5)) << "as written for what is no monitor now";
    ASSERT_TRUE(wall.equalizers.tune("monitor.3", off).ok());
    wall.apply();
    EXPECT_TRUE(wall.live == wall.written);
}

TEST(MonitorEqualizer, ReducesAFrameForTheCanvasesThatAreAskedFor) {
    Balanced wall = wallWithMonitors(kMonitor, kMonitor);
    wall.canvases = {1};
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.5, .125));
    wall.canvases = {2};
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.25, .5));
    wall.canvases = {0};
    wall.apply();
    EXPECT_TRUE(wall.live == wall.written);
}

TEST(MonitorEqualizer, LeavesWhatOthersTakeAtLeastAsItIsWritten) {
    Balanced wall = wallWithMonitors(kMonitor, "inputframe { name \"w\" }");
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.75, .125));
}

TEST(MonitorEqualizer, LeavesNothingForWhoTakesItInALayoutThatIsNotShown) {
    Balanced wall = wallWithMonitors(kMonitor, kMonitor, "inputframe { name \"w\" }");
    wall.apply();
    EXPECT_EQ(wallZoom(wall), fabric::Vec2(.5, .5));
}

TEST(MonitorEqualizer, ReducesTheFramesOfBothEyes) {
    config::Findings findings;
    Balanced wall(config::readEqc(
        "server { config { appNode { pipe { window { viewport [ 0 0 640 480 ] channel { name "
        "\"a\" } } window { viewport [ 0 0 320 240 ] channel { name \"b\" } } } } layout { view { "
        "mode STEREO } } canvas { layout 0 segment { channel \"a\" } } canvas { layout 0 segment { "
        "channel \"b\" } } compound { compound { channel ( canvas 0 segment 0 layout 0 view 0 ) "
        "compound { eye [ LEFT ] outputframe { name \"w\" } } compound { eye [ RIGHT ] outputframe "
        "{ name \"w\" } } } compound { channel ( canvas 1 segment 0 layout 0 view 0 ) " +
            kMonitor + " } } } }",
        findings));
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    wall.apply();
    for (const config::Compound& eye : wall.live.compounds[0].children[0].children)
        EXPECT_EQ(eye.outputFrames[0].zoom, fabric::Vec2(.5, .5));
}

/// Input frames that say how large a pixel of the frame is are as large as if theirs was the only
/// monitor.
TEST(MonitorEqualizer, KeepsTheSizeOfWhatIsEnlarged) {
    const std::string enlarged = "monitor_equalizer { } inputframe { name \"w\" zoom [ 2 3 ] }";
    Balanced wall = wallWithMonitors(enlarged, kMonitor);
    wall.apply();
    const auto& children = wall.live.compounds[0].children;
    EXPECT_EQ(children[1].inputFrames[0].zoom, fabric::Vec2(2, 3. / 4));
    EXPECT_EQ(children[2].inputFrames[0].zoom, std::nullopt);
    wall.canvases = {1};
    wall.apply();
    EXPECT_EQ(children[1].inputFrames[0].zoom, fabric::Vec2(2, 3));
}

TEST(Equalizers, ReturnToWhatIsWrittenWhenSwitchedOff) {
    const auto switchedOff = [](const std::string& compounds) {
        Balanced balanced(configurationOf(1, compounds));
        for (int frame = 0; frame < 5; ++frame) balanced.draw(kRight);
        EXPECT_NE(balanced.at(1).viewport.width, .5);
        Tuning off;
        off.isOn = false;
        EXPECT_TRUE(balanced.equalizers.tune("0", off).ok());
        balanced.draw(kRight);
        return balanced.at(1).viewport;
    };
    EXPECT_EQ(switchedOff("compound { channel ( segment 0 view 0 ) load_equalizer { } "
                          "compound { viewport [ 0 0 .25 1 ] } "
                          "compound { viewport [ .25 0 .75 1 ] channel \"s1\" } }"),
              (config::Viewport{0, 0, .25, 1}));
    EXPECT_EQ(switchedOff(sharedBetween(2, "load_equalizer { }")), (config::Viewport{0, 0, .5, 1}))
        << "where everyone is written to draw everything";
}

TEST(Equalizers, ShareOutAllThereIsWhateverIsWritten) {
    for (const char* kind : {"load_equalizer", "tree_equalizer"})
        for (const auto& [mode, first, second] :
             {std::array{"DB", "viewport [ 0 0 .25 1 ]", "viewport [ .25 0 .75 1 ]"},
              std::array{"2D", "range [ 0 .5 ]", "range [ .5 1 ]"}}) {
            Balanced balanced(configurationOf(
                1, fmt::format("compound {{ channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ] "
                               "{} {{ mode {} }} compound {{ {} }} compound {{ {} channel \"s1\" "
                               "outputframe {{ }} }} inputframe {{ name \"frame.s1\" }} }}",
                               kind, mode, first, second)));
            balanced.apply();
            EXPECT_DOUBLE_EQ(even(balanced.at(1)) + even(balanced.at(2)), 100) << kind << mode;
        }
}

TEST(Equalizers, LeaveDestinationsTheirWholePictures) {
    for (const char* kind : {"load_equalizer", "tree_equalizer"})
        for (const char* mode : {"2D", "DB"}) {
            Balanced balanced(configurationOf(
                1, fmt::format("compound {{ {} {{ mode {} }} compound {{ channel ( segment 0 view "
                               "0 ) }} compound {{ channel \"s1\" }} }}",
                               kind, mode)));
            balanced.apply();
            EXPECT_DOUBLE_EQ(even(balanced.at(1)), 100) << kind << mode;
        }
}

TEST(Equalizers, StayAsTheyAreWhileFrozen) {
    for (const char* kind : {"load_equalizer", "tree_equalizer"}) {
        Balanced balanced(
            configurationOf(1, sharedBetween(2, std::string(kind) + " { mode VERTICAL }")));
        for (int frame = 0; frame < 3; ++frame) balanced.draw(kRight);
        Tuning frozen;
        frozen.isFrozen = true;
        EXPECT_TRUE(balanced.equalizers.tune("0", frozen).ok());
        balanced.apply();
        const config::Configuration before = balanced.live;
        for (int frame = 0; frame < 3; ++frame) balanced.draw(Spot{{0, 0, .1, 1}});
        EXPECT_TRUE(balanced.live == before) << kind;
    }
}

TEST(Equalizers, TakeOtherSettingsWhileTheyRun) {
    Balanced balanced(configurationOf(1, sharedBetween(2, "load_equalizer { mode VERTICAL }")));
    for (int frame = 0; frame < 3; ++frame) balanced.draw(kRight);
    Tuning tuning;
    tuning.mode = config::SplitMode::Db;
    tuning.boundaryRange = .25;
    tuning.damping = .25;
    EXPECT_TRUE(balanced.equalizers.tune("load.0", tuning).ok());
    EXPECT_EQ(balanced.equalizers.states()[0].settings.damping, .25);
    for (int frame = 0; frame < 5; ++frame) balanced.draw(even);
    EXPECT_EQ(balanced.at(1).range, (fabric::Range{0, .5}));
    EXPECT_EQ(balanced.at(1).viewport, config::Viewport{});
}

TEST(Equalizers, SayWhichSettingCannotBe) {
    Equalizers equalizers(configurationOf(1, sharedBetween(2, "load_equalizer { }")));
    Tuning tuning;
    tuning.damping = 1.5;
    EXPECT_THAT(std::string(equalizers.tune("load.0", tuning).ToString()),
                HasSubstr("damping is 1.5; it must be from 0 to 1"));
    tuning = {};
    tuning.resistancePixels = fabric::Vec2(.5, 3);
    EXPECT_EQ(equalizers.tune("0", tuning).code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(equalizers.tune("tree.0", {}).ToString()),
                HasSubstr("no equalizer is called \"tree.0\"; there are \"load.0\""));
    EXPECT_EQ(equalizers.states()[0].settings.damping, .5);
}

TEST(Equalizers, LearnNothingFromFramesThatTheyDidNotPlan) {
    Balanced balanced(configurationOf(1, sharedBetween(2, "load_equalizer { mode DB }")));
    balanced.apply();
    FrameTimes times{99, std::vector<CompoundTime>(3)};
    times.compounds[1].draw = 1;
    times.compounds[2].draw = 100;
    balanced.equalizers.record(times);
    balanced.apply();
    EXPECT_EQ(balanced.at(1).range.end, .5);
}

TEST(Equalizers, KeepEverySampleWholeWhateverIsGone) {
    std::size_t found = 0;
    for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
        if (file.path().extension() != ".eqc")
            continue;
        Balanced balanced(sample(file.path()));
        found += balanced.equalizers.states().size();
        for (int frame = 0; frame < 4; ++frame) {
            balanced.draw(kRight);
            if (frame == 1 && balanced.at(0).channel)
                balanced.gone = {*balanced.at(0).channel};
        }
        config::Findings findings;
        config::resolve(balanced.live, findings);
        EXPECT_FALSE(findings.hasErrors())
            << file.path() << config::describe(findings, file.path());
    }
    EXPECT_GE(found, 20U);
}

}  // namespace
}  // namespace eyrie::equalizer
