// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"
#include "coordinator/config/upgrade.h"
#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

/// A configuration with one channel of 640 x 480, one view, and these compounds.
std::string withCompounds(const std::string& compounds) {
    return "config { appNode { pipe { window { viewport [ 0 0 640 480 ]"
           " channel { name \"a\" } channel { name \"b\" } } } }"
           " observer {} layout { view { observer 0 } }"
           " canvas { layout 0 wall {} segment { channel \"a\" } } " +
           compounds + " }";
}

std::string firstError(const std::string& text) {
    const Read read(text);
    for (const Finding& finding : read.findings.all())
        if (finding.kind == Finding::Kind::Error)
            return std::to_string(finding.place.line) + ":" + std::to_string(finding.place.column) +
                   " " + finding.message;
    return "none";
}

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

TEST(EqcErrors, AreAllFoundWithLineAndColumn) {
    const Read read(
        "config\n"
        "{\n"
        "    latency -1\n"
        "    appNode { pipe { device x window { channel { name 5 } } } }\n"
        "    layout { view { observer \"none\" mode SIDE } }\n"
        "}\n");
    EXPECT_EQ(describe(read.findings, "f"),
              "f:3:5: error: 'latency' is -1; expected a whole number from 0 to 1000\n"
              "f:4:22: error: 'device' is x; expected a whole number from 0 to 1000000000\n"
              "f:4:50: error: 'name' is 5; expected a text in quotes\n"
              "f:5:30: error: no observer named \"none\" is defined before this\n"
              "f:5:37: error: 'mode' is SIDE; expected MONO or STEREO\n");
}

TEST(EqcErrors, NameWhatIsOpenClosedOrStray) {
    EXPECT_THAT(firstError("config { appNode {"), HasSubstr("1:18 what opens here"));
    EXPECT_THAT(firstError("config { } }"), HasSubstr("1:12 '}' closes nothing"));
    EXPECT_THAT(firstError("config { name \"x\n }"), HasSubstr("1:15 no '\"' ends"));
    EXPECT_THAT(firstError("config { @ }"), HasSubstr("1:10 the byte 0x40"));
    EXPECT_THAT(firstError("config { latency }"), HasSubstr("1:10 'latency' has no value"));
    EXPECT_THAT(firstError("config { { } }"), HasSubstr("'{' belongs to no keyword"));
    EXPECT_THAT(firstError("config { layout { view { viewport [ 0 0 1 } } }"),
                HasSubstr("expected [ x y width height ]"));
    EXPECT_THAT(firstError(""), HasSubstr("there is no config"));
    EXPECT_THAT(firstError("#Equalizer 2.0 ascii\nconfig {}"), HasSubstr("version 2.0"));
}

TEST(EqcErrors, AreFoundHoweverDeepBlocksLie) {
    std::string deep = "config ";
    for (int i = 0; i < 100'000; ++i) deep += "{ compound ";
    EXPECT_THAT(firstError(deep), HasSubstr("blocks within each other"));
}

TEST(EqcErrors, AreImpossibleShares) {
    for (const auto& [compound, message] : std::vector<std::pair<std::string, std::string>>{
             {"range [ .5 .2 ]", "0 <= begin <= end <= 1"},
             {"range [ 0 2 ]", "0 <= begin <= end <= 1"},
             {"viewport [ 0 0 2 1 ]", "a part of [ 0 0 1 1 ]"},
             {"viewport [ 0 0 0 1 ]", "a width and a height above 0"},
             {"pixel [ 2 0 2 1 ]", "x < width"},
             {"subpixel [ 4 4 ]", "index < count"},
             {"zoom [ 0 1 ]", "above 0"},
             {"period 2 phase 2", "phase 2 of a period of 2"},
             {"channel \"c\"", "no channel named \"c\""},
             {"channel ( segment 4 )", "no segment 4: 1 are defined"},
             {"channel ( view \"v\" )", "no view named \"v\""},
             {"} layout {} compound { channel ( layout 1 )", "first segment or view of what has"},
             {"wall { bottom_left [ 0 0 0 ] bottom_right [ 1 0 0 ] top_left [ 1 1 0 ] }",
              "right angle"},
             {"projection { distance 0 }", "above 0"},
             {"load_equalizer { damping 2 }", "from 0 to 1"},
             {"load_equalizer { boundary 1.5 }", "a share from 0 to 1"},
             {"load_equalizer { resistance [ -1 2 ] }", "2 whole numbers"},
             {"load_equalizer { assemble_only_limit 0 }", "above 0"},
             {"tile_equalizer { size 1.5 }", "a share above 0, 1 at most"},
             {"tile_equalizer { size [ 0 4 ] }", "a pixel or more"},
             {"DFR_equalizer { framerate 0 }", "above 0"}})
        EXPECT_THAT(firstError(withCompounds("compound { " + compound + " }")), HasSubstr(message))
            << compound;
}

TEST(EqcErrors, AreEyesThatAreNotBeforeTheirWall) {
    EXPECT_THAT(firstError("config { appNode { pipe { window { channel { name \"a\" } } } }"
                           " observer { eye_cyclop [ 0 0 -2 ] } layout { view { observer 0 } }"
                           " canvas { layout 0 wall {} segment { channel \"a\" } } }"),
                HasSubstr("not before the wall"));
}

TEST(EqcWarnings, SayWhatHasNoEffect) {
    const Read read(withCompounds("nonsense 5 compound { inputframe { name \"x\" } }"));
    EXPECT_FALSE(read.findings.hasErrors());
    const std::string text = describe(read.findings, "f");
    EXPECT_THAT(text, HasSubstr("'nonsense' means nothing in a config"));
    EXPECT_THAT(text, HasSubstr("no outputframe of this compound tree is named \"x\""));
    EXPECT_THAT(describe(sample("1-pipe.eqc").findings, "f"),
                HasSubstr("on screen only: 'EQ_WINDOW_IATTR_HINT_FULLSCREEN'"));
}

/// Every setting of a configuration, wherever it stands.
std::vector<Attribute> settingsOf(const Configuration& configuration) {
    std::vector<Attribute> all;
    const auto add = [&all](const Attributes& some) {
        all.insert(all.end(), some.begin(), some.end());
    };
    add(configuration.globals);
    add(configuration.attributes);
    for (const Layout& layout : configuration.layouts)
        for (const View& view : layout.views) add(view.attributes);
    for (const Node& node : configuration.nodes) {
        add(node.attributes);
        for (const Pipe& pipe : node.pipes) {
            add(pipe.attributes);
            for (const Window& window : pipe.windows) {
                add(window.attributes);
                for (const Channel& channel : window.channels) add(channel.attributes);
            }
        }
    }
    return all;
}

/// As it is written.
std::string written(const Attribute& setting) {
    std::string text = setting.name;
    if (const auto* number = std::get_if<std::int64_t>(&setting.value))
        text += " " + std::to_string(*number);
    if (const auto* words = std::get_if<Attribute::Words>(&setting.value))
        for (const std::string& word : words->words) text += " " + word;
    return text;
}

bool isFound(const Findings& findings, const Attribute& setting) {
    return std::ranges::any_of(findings.all(), [&](const Finding& each) {
        return each.place.line == setting.place.line && each.place.column == setting.place.column &&
               each.message.starts_with("'" + setting.name + "' has no effect here: ");
    });
}

TEST(EqcWarnings, AreOfEverySettingOfEqualizersFilesThatHasNoEffect) {
    const std::set<std::string> withEffect = {"eye_base", "EQ_CONFIG_FATTR_EYE_BASE",
                                              "EQ_COMPOUND_IATTR_STEREO_MODE",
                                              "EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_LEFT_MASK",
                                              "EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_RIGHT_MASK"};
    const std::set<std::string> soAnyway = {"EQ_CONNECTION_IATTR_TYPE TCPIP",
                                            "EQ_PIPE_IATTR_HINT_AFFINITY AUTO",
                                            "EQ_PIPE_IATTR_HINT_THREAD ON",
                                            "EQ_WINDOW_IATTR_HINT_DRAWABLE FBO",
                                            "EQ_WINDOW_IATTR_HINT_STEREO OFF",
                                            "EQ_WINDOW_IATTR_PLANES_ALPHA 8",
                                            "EQ_WINDOW_IATTR_PLANES_COLOR 8",
                                            "EQ_WINDOW_IATTR_PLANES_DEPTH 24",
                                            "hint_doublebuffer AUTO",
                                            "hint_drawable FBO",
                                            "hint_stereo AUTO",
                                            "planes_alpha 4",
                                            "planes_color 4",
                                            "planes_depth 16",
                                            "planes_depth ON",
                                            "planes_samples OFF",
                                            "planes_stencil OFF"};
    std::set<std::string> silent;
    for (const std::string& name : samples()) {
        const Read read = sample(name);
        for (const Attribute& each : settingsOf(read.configuration)) {
            const bool isSaid = isFound(read.findings, each);
            EXPECT_FALSE(isSaid && withEffect.contains(each.name)) << name << ": " << each.name;
            if (!isSaid && !withEffect.contains(each.name))
                silent.insert(written(each));
        }
    }
    EXPECT_EQ(silent, soAnyway);
}

TEST(EqcWarnings, OfWhatHasNoEffectComeLastAndOnceForAllPlaces) {
    const Read read(
        "config {\n"
        " appNode { pipe { device 1 window { attributes { planes_samples 4 }\n"
        "  channel { name \"a\" attributes { dump_image \"x\" } } } }\n"
        "  pipe { device 2 window { attributes { planes_samples 8 } channel {} } }\n"
        "  pipe { device 3 window { attributes { hint_fullscreen ON } channel {} } } }\n"
        " nonsense 1 }");
    EXPECT_EQ(
        describe(read.findings, "f"),
        "f:6:2: warning: 'nonsense' means nothing in a config and is left out\n"
        "f:2:19: note: 'device' has no effect here: `eyrie renderer --device` says what a renderer "
        "draws on (here and in 2 more places)\n"
        "f:2:50: note: 'planes_samples' has no effect here: a channel draws one sample a pixel; "
        "compounds with `subpixel` draw more (here and in 1 more place)\n"
        "f:3:35: note: 'dump_image' has no effect here: `eyrie render --config` writes pictures\n"
        "f:5:41: on screen only: 'hint_fullscreen' has no effect here: there is no screen\n");
}

TEST(EqcWarnings, AreNotOfSettingsThatAskForWhatIsSoAnyway) {
    const auto found = [](const std::string& attributes) {
        return describe(Read("config { appNode { pipe { window { attributes { " + attributes +
                             " } channel {} } } } }")
                            .findings,
                        "f");
    };
    for (const char* asItIs :
         {"planes_samples OFF", "planes_samples 1", "planes_samples AUTO", "planes_color 8",
          "planes_alpha ON", "planes_depth 24", "planes_stencil OFF", "hint_drawable FBO",
          "hint_stereo OFF", "hint_opengl_major 3", "hint_core_profile ON", "hint_statistics ON"})
        EXPECT_EQ(found(asItIs), "");
    for (const char* other : {"planes_samples 2", "planes_color RGBA16F", "planes_color 10",
                              "planes_depth 64", "planes_stencil ON", "hint_drawable pbuffer",
                              "hint_drawable OFF", "hint_stereo QUAD", "hint_opengl_major 5",
                              "hint_core_profile OFF", "hint_statistics NICEST", "hint_width 640"})
        EXPECT_THAT(found(other), HasSubstr("note: '")) << other;
}

TEST(EqcWarnings, AreNotLostAmongManyNotes) {
    std::string pipes;
    for (std::size_t i = 0; i <= Findings::kMost; ++i) pipes += "pipe { device 1 }";
    EXPECT_THAT(describe(Read("config { node { " + pipes + " } nonsense 1 }").findings, "f"),
                HasSubstr("'nonsense' means nothing"));
}

TEST(EqcWarnings, NameQueuesThatNobodyMakesOrTakes) {
    const Read read(withCompounds(
        "compound { channel ( segment 0 view 0 )\n outputtiles { name \"q\" size [ 64 64 ] }\n"
        " compound { inputtiles { name \"q\" } }\n"
        " compound { channel \"b\" inputtiles { name \"Q\" } outputframe { name \"b\" } }\n"
        " outputtiles { name \"unused\" size [ 64 64 ] } inputframe { name \"b\" } }"));
    EXPECT_EQ(describe(read.findings, "f"),
              "f:5:2: warning: nobody takes the outputtiles \"unused\"\n"
              "f:4:25: warning: no outputtiles of this compound tree are named \"Q\": the compound "
              "draws all of its part\n");
}

TEST(EqcWarnings, NameFramesThatTheTasksLeaveOut) {
    const auto found = [](const std::string& ofWhole, const std::string& ofPart) {
        return describe(
            Read(withCompounds("compound { channel ( segment 0 view 0 ) " + ofWhole +
                               "\n compound { channel \"b\" " + ofPart +
                               " outputframe { name \"f\" } }\n inputframe { name \"f\" } }"))
                .findings,
            "f");
    };
    EXPECT_EQ(found("task [ CLEAR ASSEMBLE ]", "task [ CLEAR DRAW READBACK ]"), "");
    EXPECT_EQ(found("", ""), "");
    EXPECT_EQ(
        found("task [ CLEAR ]", ""),
        "f:3:2: warning: the compound's task has no ASSEMBLE: the inputframe has no effect\n");
    EXPECT_EQ(
        found("", "task [ CLEAR DRAW ]"),
        "f:2:45: warning: the compound's task has no READBACK: the outputframe stays empty\n");
}

TEST(EqcWarnings, SayInWhichFramesNothingIsDrawn) {
    const auto found = [](const std::string& children) {
        return describe(
            Read(withCompounds("compound { channel ( segment 0 view 0 )\n" + children + " }"))
                .findings,
            "f");
    };
    const std::string b = "outputframe { name \"f\" } channel \"b\"";
    const std::string taken = "inputframe { name \"f\" }";
    EXPECT_EQ(found("compound { period 3 phase 0 } compound { period 3 phase 1 }"),
              "f:1:204: warning: nothing draws the picture in 1 of 3 frames, such as that of phase "
              "2: it is background then\n");
    EXPECT_EQ(found("compound { period 3 phase 0 } compound { period 3 phase 1 } compound { period "
                    "3 phase 2 }"),
              "");
    EXPECT_THAT(found("compound { period 2 phase 1 compound { period 3 phase 0 } } compound { "
                      "period 6 phase 2 }"),
                HasSubstr("in 4 of 6 frames, such as that of phase 0"));
    EXPECT_EQ(found("compound { period 2 phase 0 } compound { viewport [ 0 0 .5 1 ] }"), "");
    EXPECT_EQ(found("compound { period 2 phase 0 " + b + " } compound { period 2 phase 1 " + b +
                    " } " + taken),
              "");
}

TEST(EqcWarnings, NameBothPlacesOfANameThatTwoThingsHave) {
    const Read read(
        "config {\n node { name \"n\" pipe { name \"p\" window { channel { name \"c\" }\n"
        "  channel { name \"c\" } } } }\n node { name \"n\" }\n"
        " layout { view { name \"v\" } view { name \"v\" } }\n layout { view { name \"v\" } } }");
    EXPECT_EQ(describe(read.findings, "f"),
              "f:4:2: warning: another node is named \"n\" already, at 2:2; the name finds that\n"
              "f:3:3: warning: another channel is named \"c\" already, at 2:43; the name finds "
              "that\n"
              "f:5:29: warning: another view is named \"v\" already, at 5:11; the name finds "
              "that\n");
}

TEST(EqcWarnings, SayThatALayoutIsOnItsCanvasAlready) {
    const Read read(
        "config { node { pipe { window { channel { name \"a\" } } } } layout { view {} }"
        " canvas { layout 0 layout OFF layout 0 segment { channel \"a\" } } }");
    EXPECT_THAT(describe(read.findings, "f"), HasSubstr("layout 0 is on the canvas already"));
    EXPECT_EQ(read.resolved.destinations.size(), 1U);
}

TEST(EqcErrors, AreMoreStatementsThanAnyFileHas) {
    std::string nodes;
    for (std::size_t i = 0; i <= kMostStatements; ++i) nodes += "node{}";
    EXPECT_THAT(firstError("config{" + nodes + "}"), HasSubstr("more than 200000 statements"));
}

TEST(EqcErrors, AreMorePairsOfViewsAndSegmentsThanCanBeShown) {
    std::string views;
    std::string segments;
    for (int i = 0; i < 200; ++i) {
        views += "view {}";
        segments += "segment { channel \"a\" }";
    }
    EXPECT_THAT(firstError("config { node { pipe { window { channel { name \"a\" } } } } layout {" +
                           views + "} canvas { layout 0 " + segments + "} }"),
                HasSubstr("more than 20000 pairs"));
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

TEST(EqcUpgrade, LeavesTreesOfNewerFilesAloneBesideACanvas) {
    const std::string rest =
        " config { node { pipe { window { channel { name \"a\" } } } } canvas {}"
        " compound { channel \"a\" } }";
    EXPECT_EQ(Read("#Equalizer 1.1 ascii\n" + rest).resolved.destinations.size(), 1U);
    EXPECT_TRUE(Read("#Equalizer 1.2 ascii\n" + rest).resolved.destinations.empty());
    EXPECT_TRUE(Read(rest).resolved.destinations.empty());
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

TEST(EqcUpgrade, GivesOldFilesAnObserver) {
    const std::string rest = " config { layout { view {} } }";
    const Configuration old = Read("#Equalizer 1.1 ascii\n" + rest).configuration;
    EXPECT_EQ(old.observers.size(), 1U);
    EXPECT_EQ(old.layouts[0].views[0].observer, 0U);
    EXPECT_TRUE(Read("#Equalizer 1.2 ascii\n" + rest).configuration.observers.empty());
    const Configuration has =
        Read("#Equalizer 1.1 ascii\n config { observer {} layout { view {} } }").configuration;
    EXPECT_EQ(has.observers.size(), 1U);
    EXPECT_FALSE(has.layouts[0].views[0].observer.has_value());
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
