// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"
#include "coordinator/config/upgrade.h"
#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

TEST(EqcConformance, EveryFileOfEqualizersIsReadAndResolvedInFull) {
    std::size_t files = 0;
    std::size_t nodes = 0;
    std::size_t layouts = 0;
    std::size_t roots = 0;
    std::size_t compounds = 0;
    for (const std::string& name : samples()) {
        const Read read = sample(name);
        EXPECT_FALSE(read.findings.hasErrors()) << describe(read.findings, name);
        ++files;
        nodes += read.configuration.nodes.size();
        layouts += read.configuration.layouts.size();
        roots += read.configuration.compounds.size();
        for (const ResolvedCompound& compound : read.resolved.compounds)
            compounds += compound.compound != nullptr ? 1 : 0;
    }
    // The words "node" and "appNode", "layout" and "compound" that open a block in these files,
    // counted by grep.
    EXPECT_EQ(files, 51U);
    EXPECT_EQ(nodes, 108U);
    EXPECT_EQ(layouts, 87U);
    EXPECT_EQ(roots, 74U);
    EXPECT_EQ(compounds, 457U);
}

TEST(EqcConformance, CutOffAnywhereNoFileCrashesTheReader) {
    const std::string whole = contents(std::filesystem::path(kSamples) / "4-window.all.eqc");
    for (std::size_t length = 0; length < whole.size(); length += 97) {
        const Read read(whole.substr(0, length));
        EXPECT_TRUE(read.findings.hasErrors()) << length;
    }
}

TEST(EqcConformance, WithBytesChangedNoFileCrashesTheReader) {
    const std::string whole = contents(std::filesystem::path(kSamples) / "test.eqc");
    std::mt19937 random(7);
    for (int i = 0; i < 500; ++i) {
        std::string text = whole;
        for (int flips = 0; flips < 5; ++flips)
            text[random() % text.size()] = static_cast<char>(random() % 256);
        const Read read(text);
        SUCCEED();
    }
}

TEST(EqcReferences, FindChannelsWithoutNamesByPosition) {
    const std::string nodes =
        "config { node { pipe { window { channel {} channel { name \"a\" } } } } canvas {} ";
    const Read read(nodes + "compound { channel ( node 0 channel 1 ) } }");
    EXPECT_EQ(std::get<ChannelIndex>(read.configuration.compounds[0].channel),
              (ChannelIndex{0, 0, 0, 1}));
    EXPECT_THAT(firstError(nodes + "compound { channel ( node 0 channel 2 ) } }"),
                HasSubstr("no channel 2: 2 are defined"));
    EXPECT_THAT(firstError(nodes + "compound { channel ( node 0 view 1 ) } }"),
                HasSubstr("'view' in a channel's position"));
    EXPECT_THAT(firstError("config { node {} compound { channel ( node 0 ) } }"),
                HasSubstr("there is no pipe"));
}

TEST(EqcUpgrade, GivesOldTreesWithoutViewOneOfTheirOwn) {
    const std::string rest =
        " config { node { pipe { window { viewport [ 0 0 64 48 ] channel { name \"a\" }"
        " channel { name \"b\" } } } }"
        " compound { compound { channel \"a\" wall {} compound { eye [ LEFT ] }"
        "                       compound { channel \"b\" eye [ RIGHT ] outputframe {} }"
        "                       inputframe { name \"frame.b\" } } } }";
    for (const char* const version : {"", "1.0", "1.1", "1.2"}) {
        const std::string header = "#Equalizer " + std::string(version) + " ascii\n";
        const Read old((*version == '\0' ? "" : header) + rest);
        EXPECT_EQ(describe(old.findings, "f"), "");
        ASSERT_EQ(old.resolved.destinations.size(), 1U);
        EXPECT_EQ(old.resolved.destinations[0].channel, (ChannelIndex{0, 0, 0, 0}));
        EXPECT_TRUE(old.resolved.destinations[0].wall.has_value());
        EXPECT_EQ(old.resolved.destinations[0].eyes, (Eyes{false, true, true}));
        ASSERT_EQ(old.resolved.compounds.size(), 4U);
        EXPECT_EQ(old.resolved.compounds[3].sights.at(0).eye, EyeSight::Eye::Right);
        Configuration again = old.configuration;
        upgrade(again);
        EXPECT_EQ(again, old.configuration);
    }
}

TEST(EqcUpgrade, LeavesTreesWithoutViewAloneBesideACanvas) {
    const std::string rest =
        "config { node { pipe { window { channel { name \"a\" } } } }"
        " layout { view {} } canvas { layout 0 segment { channel \"a\" } }"
        " compound { channel \"a\" } }";
    for (const char* const header :
         {"", "#Equalizer 1.0 ascii\n", "#Equalizer 1.1 ascii\n", "#Equalizer 1.2 ascii\n"}) {
        const Read read(header + rest);
        EXPECT_EQ(read.resolved.destinations.size(), 1U) << header;
        EXPECT_THAT(describe(read.findings, "f"),
                    HasSubstr("nothing of this compound tree is shown"))
            << header;
    }
}

TEST(EqcUpgrade, MakesSegmentsOfOneCanvasOfAGroup) {
    const Read old(
        "config { node { pipe { window { viewport [ 0 0 480 300 ] channel { name \"a\" } }"
        "                       window { viewport [ 0 0 480 300 ] channel { name \"b\" } } } }"
        " compound { wall { bottom_left [ -.64 -.2 -1 ] bottom_right [ .64 -.2 -1 ]"
        "                   top_left [ -.64 .2 -1 ] }"
        "   compound { channel \"a\" viewport [ 0 0 .25 1 ] }"
        "   compound { channel \"b\" viewport [ .25 0 .75 1 ] } } }");
    EXPECT_EQ(describe(old.findings, "f"), "");
    ASSERT_EQ(old.configuration.canvases.size(), 1U);
    ASSERT_EQ(old.resolved.destinations.size(), 2U);
    for (const Destination& destination : old.resolved.destinations) {
        EXPECT_EQ(destination.pixelViewport, (fabric::PixelViewport{0, 0, 480, 300}));
        ASSERT_TRUE(destination.wall.has_value());
    }
    EXPECT_NEAR(old.resolved.destinations[0].wall->bottomRight.x, -0.32, 1e-12);
    EXPECT_NEAR(old.resolved.destinations[1].wall->bottomLeft.x, -0.32, 1e-12);
    ASSERT_EQ(old.resolved.compounds.size(), 3U);
    for (const std::size_t part : {1U, 2U})
        EXPECT_EQ(old.resolved.compounds[part].pixelViewport,
                  (fabric::PixelViewport{0, 0, 480, 300}));
    // Each sees through its own share, not through the group's wall.
    EXPECT_NEAR(old.resolved.compounds[1].sights.at(0).sight->frustum.right, -0.32, 1e-12);
    EXPECT_NEAR(old.resolved.compounds[2].sights.at(0).sight->frustum.left, -0.32, 1e-12);
}

/// Two channels under one group, each as `left` and `right` say.
std::string oldGroup(const std::string& group, const std::string& left, const std::string& right) {
    return "#Equalizer 1.0 ascii\n config { node { pipe { window { channel { name \"a\" }"
           " channel { name \"b\" } } } } compound { wall {} " +
           group + " compound { channel \"a\" viewport [ 0 0 .5 1 ] " + left +
           " } compound { channel \"b\" viewport [ .5 0 .5 1 ] " + right + " } } }";
}

TEST(EqcUpgrade, TakesEyesFromGroups) {
    const Read old(oldGroup("eye [ LEFT RIGHT ]", "", ""));
    EXPECT_EQ(describe(old.findings, "f"), "");
    ASSERT_EQ(old.resolved.destinations.size(), 2U);
    for (const Destination& destination : old.resolved.destinations)
        EXPECT_EQ(destination.eyes, (Eyes{false, true, true}));
    for (const std::size_t part : {1U, 2U})
        EXPECT_EQ(old.resolved.compounds[part].sights.size(), 2U);
}

TEST(EqcUpgrade, ShowsTheEyesOfItsTreesOnASegment) {
    const Read old(oldGroup("", "eye [ LEFT ]", "eye [ RIGHT ]"));
    ASSERT_EQ(old.resolved.destinations.size(), 2U);
    EXPECT_EQ(old.resolved.destinations[0].eyes, (Eyes{false, true, false}));
    EXPECT_EQ(old.resolved.destinations[1].eyes, (Eyes{false, false, true}));
}

TEST(EqcUpgrade, LeavesViewsThatHaveTheEyeBetweenAsTheyAre) {
    const Read old(oldGroup("eye [ CYCLOP LEFT RIGHT ]", "", ""));
    for (const Destination& destination : old.resolved.destinations)
        EXPECT_EQ(destination.eyes, (Eyes{true, false, false}));
}

TEST(EqcUpgrade, GivesTreesOfEachEyeOneView) {
    const Read old(
        "#Equalizer 1.0 ascii\n config { node { pipe { window { channel { name \"a\" } } } }"
        " compound { channel \"a\" eye [ LEFT ] wall {} }"
        " compound { channel \"a\" eye [ RIGHT ] wall {} } }");
    EXPECT_EQ(describe(old.findings, "f"), "");
    ASSERT_EQ(old.resolved.destinations.size(), 1U);
    ASSERT_EQ(old.resolved.compounds.size(), 2U);
    EXPECT_EQ(old.resolved.compounds[0].sights.at(0).eye, EyeSight::Eye::Left);
    EXPECT_EQ(old.resolved.compounds[1].sights.at(0).eye, EyeSight::Eye::Right);
}

/// Two views side by side on two segments, and these compounds.
std::string twoViews(const std::string& header, const std::string& compounds) {
    return header +
           "config { node { pipe { window { channel { name \"a\" } channel { name \"b\" } } } }"
           " layout { view { viewport [ 0 0 .5 1 ] } view { viewport [ .5 0 .5 1 ] } }"
           " canvas { layout 0 wall {} segment { channel \"a\" viewport [ 0 0 .5 1 ] }"
           " segment { channel \"b\" viewport [ .5 0 .5 1 ] } } " +
           compounds + " }";
}

/// Of the destinations, whose compounds draw as many.
void expectEyes(const std::string& file, const std::vector<Eyes>& eyes) {
    const Read old(file);
    EXPECT_EQ(describe(old.findings, "f"), "") << file;
    ASSERT_EQ(old.resolved.destinations.size(), eyes.size()) << file;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        Eyes drawn;
        for (const ResolvedCompound& each : old.resolved.compounds)
            if (each.destination == i)
                drawn = {drawn.cyclop || each.eyes.cyclop, drawn.left || each.eyes.left,
                         drawn.right || each.eyes.right};
        EXPECT_EQ(drawn, eyes[i]) << file;
        EXPECT_EQ(old.resolved.destinations[i].eyes, eyes[i]) << file;
    }
    Configuration again = old.configuration;
    upgrade(again);
    EXPECT_EQ(again, old.configuration) << file;
}

TEST(EqcUpgrade, MakesViewsStereoWhereCompoundsOfTheOldestFilesSayTwoEyes) {
    constexpr Eyes kTwo{false, true, true};
    constexpr Eyes kBetween{true, false, false};
    const std::string left = "compound { channel ( segment 0 view 0 ) ";
    const std::string right = "compound { channel ( segment 1 view 1 ) ";
    for (const char* const header : {"", "#Equalizer 1.0 ascii\n"}) {
        const auto expect = [&](const std::string& compounds, const std::vector<Eyes>& eyes) {
            expectEyes(twoViews(header, compounds), eyes);
        };
        expect(left + "eye [ LEFT RIGHT ] } " + right + "}", {kTwo, kBetween});
        expect("compound { eye [ LEFT RIGHT ] " + left + "} " + right + "} }", {kTwo, kTwo});
        expect("compound { eye [ LEFT RIGHT ] " + left + "} " + right + "eye [ CYCLOP ] } }",
               {kTwo, kBetween});
        expect(left + "eye [ LEFT ] } " + right + "eye [ RIGHT ] }",
               {{false, true, false}, {false, false, true}});
        expect(left + "eye [ LEFT ] } " + left + "eye [ RIGHT ] }", {kTwo, kBetween});
        expect(left + "eye [ CYCLOP LEFT RIGHT ] }", {kBetween, kBetween});
    }
    expectEyes(twoViews("#Equalizer 1.1 ascii\n", left + "eye [ CYCLOP LEFT RIGHT ] }"),
               {kBetween, kBetween});
    EXPECT_FALSE(Read(twoViews("#Equalizer 1.1 ascii\n", left + "eye [ LEFT RIGHT ] }"))
                     .configuration.layouts[0]
                     .views[0]
                     .isStereo);
}

TEST(EqcUpgrade, LeavesOldSegmentsTheEyesThatTheySay) {
    const Configuration old =
        Read(
            "config { node { pipe { window { channel { name \"a\" } } } } layout { view {} }"
            " canvas { layout 0 segment { channel \"a\" eye [ LEFT ] } }"
            " compound { channel ( segment 0 view 0 ) eye [ LEFT RIGHT ] } }")
            .configuration;
    EXPECT_TRUE(old.layouts[0].views[0].isStereo);
    EXPECT_EQ(old.canvases[0].segments[0].eyes, (Eyes{false, true, false}));
}

TEST(EqcUpgrade, GivesFilesOfEveryVersionAnObserver) {
    for (const std::string header :
         {"", "#Equalizer 1.0 ascii\n", "#Equalizer 1.1 ascii\n", "#Equalizer 1.2 ascii\n"}) {
        const Configuration none = Read(header + "config { layout { view {} } }").configuration;
        EXPECT_EQ(none.observers.size(), 1U) << header;
        EXPECT_EQ(none.layouts[0].views[0].observer, 0U) << header;
        const Configuration has =
            Read(header + "config { observer {} layout { view {} } }").configuration;
        EXPECT_EQ(has.observers.size(), 1U) << header;
        EXPECT_FALSE(has.layouts[0].views[0].observer.has_value()) << header;
    }
}

TEST(Resolve, MakesAPlainCompoundOfAViewThatNoneShows) {
    const Read read(withCompounds(""));
    ASSERT_EQ(read.resolved.compounds.size(), 1U);
    const ResolvedCompound& plain = read.resolved.compounds.front();
    EXPECT_EQ(plain.compound, nullptr);
    EXPECT_EQ(plain.tasks, (Tasks{true, true, false, false}));
    EXPECT_EQ(plain.pixelViewport, (fabric::PixelViewport{0, 0, 640, 480}));
    EXPECT_EQ(plain.eyes, (Eyes{true, false, false}));
}

/// .4 and .2 are more than .6 by 1e-16 of a canvas.
TEST(Resolve, FindsNoViewOnASegmentThatItMeetsByRoundingAlone) {
    std::string segments;
    for (const char* const x : {"0", ".2", ".4", ".6", ".8"})
        segments += fmt::format("segment {{ channel \"a\" viewport [ {} 0 .2 1 ] }} ", x);
    const Read read(
        "config { appNode { pipe { window { channel { name \"a\" } } } } layout { view { viewport "
        "[ 0 0 .6 1 ] } view { viewport [ .6 0 .4 1 ] } } canvas { layout 0 " +
        segments + "} }");
    EXPECT_EQ(describe(read.findings, "f"), "");
    ASSERT_EQ(read.resolved.destinations.size(), 5U);
    for (const Destination& each : read.resolved.destinations)
        EXPECT_EQ(each.index.view, each.index.segment < 3 ? 0U : 1U);
}

TEST(Resolve, MultipliesWhatChildrenInherit) {
    const Read read(withCompounds(
        "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ]"
        "  compound { viewport [ .5 0 .5 1 ] range [ .5 1 ]"
        "    compound { channel \"b\" viewport [ 0 .5 1 .5 ] range [ 0 .5 ] pixel [ 1 0 3 1 ]"
        "               subpixel [ 1 2 ] period 3 phase 1 outputframe {} }"
        "    inputframe { name \"frame.b\" } } }"));
    EXPECT_FALSE(read.findings.hasErrors()) << describe(read.findings, "f");
    ASSERT_EQ(read.resolved.compounds.size(), 3U);
    const ResolvedCompound& leaf = read.resolved.compounds[2];
    EXPECT_EQ(leaf.viewport, (Viewport{.5, .5, .5, .5}));
    // 320 columns from 320 on, of which 1, 4, 7, … 319: 107.
    EXPECT_EQ(leaf.pixelViewport, (fabric::PixelViewport{320, 240, 107, 240}));
    EXPECT_EQ(leaf.range, (fabric::Range{.5, .75}));
    EXPECT_EQ(leaf.pixel, (PixelShare{1, 0, 3, 1}));
    EXPECT_EQ(leaf.subpixel, (SubPixelShare{1, 2}));
    EXPECT_EQ(leaf.period, 3);
    EXPECT_EQ(leaf.phase, 1);
    EXPECT_EQ(leaf.buffers, (Buffers{true, true}));
    EXPECT_EQ(leaf.tasks, (Tasks{true, true, false, true}));
    EXPECT_EQ(leaf.outputFrames.front().name, "frame.b");
    EXPECT_TRUE(leaf.outputFrames.front().isMatched);
    const ResolvedCompound& middle = read.resolved.compounds[1];
    EXPECT_EQ(middle.tasks, (Tasks{true, false, true, false}));
}

/// As in Equalizer: its compound's, else its channel's, whoever names that, else those above.
TEST(Resolve, CallsFramesWithoutANameByCompoundOrInheritedChannel) {
    const auto named = [](const std::string& name, const std::string& child) {
        const Read read(withCompounds(
            "compound { name \"top\" channel ( segment 0 view 0 ) compound { " + child +
            " outputframe { type texture } } inputframe { name \"" + name + "\" } }"));
        EXPECT_EQ(describe(read.findings, "f"), "") << child;
        return read.resolved.compounds.at(1).outputFrames.at(0);
    };
    EXPECT_TRUE(named("frame.a", "subpixel [ 0 2 ]").isMatched) << "the destination's channel";
    EXPECT_TRUE(named("frame.b", "channel \"b\"").isMatched);
    EXPECT_TRUE(named("frame.c", "channel \"b\" name \"c\"").isMatched);
    const Read nameless(
        "config { appNode { pipe { window { channel {} } } } layout { view {} } canvas { layout 0 "
        "segment { channel ( node 0 channel 0 ) } } compound { name \"top\" channel ( segment 0 "
        "view 0 ) compound { outputframe {} } inputframe { name \"frame.top\" } } }");
    EXPECT_EQ(nameless.resolved.compounds.at(1).outputFrames.at(0).name, "frame.top");
}

/// Equalizer's lexer takes 'buffers' for 'buffer', wherever it stands, and its files have both.
TEST(Resolve, TakesBuffersOfFramesHoweverTheyAreSpelt) {
    for (const char* word : {"buffer", "buffers"}) {
        const Read read(withCompounds(fmt::format(
            "compound {{ channel ( segment 0 view 0 ) compound {{ channel \"b\" outputframe {{ "
            "{} [ COLOR DEPTH ] }} }} inputframe {{ name \"frame.b\" }} }}",
            word)));
        EXPECT_THAT(read.findings.all(), testing::IsEmpty()) << describe(read.findings, "f");
        ASSERT_EQ(read.resolved.compounds.size(), 2U);
        EXPECT_EQ(read.resolved.compounds[1].outputFrames.front().frame->buffers,
                  (Buffers{true, true}));
    }
}

/// As in Equalizer, a destination has the frustum of its view or segment.
TEST(Resolve, TakesWallsOfCompoundsWithinADestinationOnly) {
    const std::string wall =
        "wall { bottom_left [ -5 -5 -1 ] bottom_right [ 5 -5 -1 ] top_left [ -5 5 -1 ] }";
    const auto right = [](const Read& read) {
        return read.resolved.compounds.back().sights.at(0).sight->frustum.right;
    };
    for (const std::string& tree :
         {"compound { channel ( segment 0 view 0 ) " + wall + " }",
          "compound { " + wall + " compound { channel ( segment 0 view 0 ) } }"}) {
        const Read read(withCompounds(tree));
        EXPECT_THAT(describe(read.findings, "f"), HasSubstr("the compound's wall has no effect"));
        EXPECT_NEAR(right(read), .8, 1e-12);
    }
    const Read within(
        withCompounds("compound { channel ( segment 0 view 0 ) compound { " + wall + " } }"));
    EXPECT_EQ(describe(within.findings, "f"), "");
    EXPECT_NEAR(right(within), 5, 1e-12);
}

TEST(Resolve, TakesAllOfADestinationsPictureWhateverStandsAboveIt) {
    const std::string shown = " compound { channel ( segment 0 view 0 ) } }";
    const Read plain(withCompounds("compound {" + shown));
    for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
             {"viewport", "[ 0 0 .5 1 ]"}, {"pixel", "[ 0 0 2 1 ]"}, {"zoom", "[ .5 .5 ]"}}) {
        const Read read(withCompounds("compound { " + name + " " + value + shown));
        EXPECT_EQ(describe(read.findings, "f"),
                  "f:1:204: warning: the compound's " + name +
                      " has no effect: it stands above compounds of views' pictures, not within "
                      "one\n");
        ASSERT_EQ(read.resolved.compounds.size(), 2U);
        const ResolvedCompound& own = read.resolved.compounds[1];
        EXPECT_EQ(own.pixelViewport, (fabric::PixelViewport{0, 0, 640, 480}));
        EXPECT_EQ(own.viewport, Viewport{}) << name;
        EXPECT_EQ(own.pixel, PixelShare{}) << name;
        EXPECT_EQ(own.zoom, fabric::Vec2(1, 1)) << name;
        EXPECT_TRUE(own.regriddings.empty()) << name;
        EXPECT_EQ(own.sights.at(0).sight, plain.resolved.compounds[1].sights.at(0).sight) << name;
    }
}

TEST(Resolve, TakesTheEyesOfTheInnermostCompoundAboveADestination) {
    const Read read(
        withCompounds("compound { eye [ LEFT ] compound { channel ( segment 0 view 0 ) "
                      "eye [ CYCLOP ] compound { eye [ CYCLOP RIGHT ] } } }"));
    ASSERT_EQ(read.resolved.compounds.size(), 3U);
    EXPECT_EQ(read.resolved.compounds[1].eyes, (Eyes{true, false, false}));
    EXPECT_EQ(read.resolved.compounds[2].eyes, (Eyes{true, false, false}));
}

TEST(Resolve, ClearsAChannelOnceAndDropsTasksWithoutFrames) {
    const Read read = sample("2-window.2D.eqc");
    const std::vector<ResolvedCompound>& compounds = read.resolved.compounds;
    ASSERT_GE(compounds.size(), 3U);
    EXPECT_EQ(compounds[0].tasks, (Tasks{true, false, true, false}));
    EXPECT_EQ(compounds[1].tasks,
              (Tasks{false, true, false, false}));  // the destination's own part
    EXPECT_EQ(compounds[2].tasks, (Tasks{true, true, false, true}));
}

}  // namespace
}  // namespace eyrie::config
