// SPDX-License-Identifier: Apache-2.0
// What is said of compounds, frames and eyes that come to nothing.
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

TEST(EqcWarnings, SayHowManyFramesAreUnderWayAtMost) {
    EXPECT_EQ(describe(Read("config { latency 7 }").findings, "f"), "");
    EXPECT_EQ(describe(Read("config { latency 8 }").findings, "f"),
              "f:1:10: warning: 'latency' is 8; no more than 8 frames are under way at once, as "
              "with a latency of 7\n");
}

TEST(EqcWarnings, SayWhichOfTwoValuesCounts) {
    EXPECT_EQ(describe(Read("config { latency 1 latency 2 }").findings, "f"),
              "f:1:20: warning: 'latency' is given again: what it was before does not count\n");
    EXPECT_EQ(Read("config { latency 1 latency 2 }").configuration.latency, 2);
    EXPECT_EQ(describe(Read("config { attributes { eye_base .1 eye_base .2 } }").findings, "f"),
              "f:1:35: warning: 'eye_base' is given again: what it was before does not count\n");
    EXPECT_THAT(
        describe(Read(withCompounds("compound { buffer [ COLOR ] buffers [ DEPTH ] }")).findings,
                 "f"),
        HasSubstr("'buffers' is given again"));
    EXPECT_THAT(
        describe(Read("config { appNode { connection { port 1 TCPIP_port 2 } } }").findings, "f"),
        HasSubstr("'TCPIP_port' is given again"));
    const std::string canvas =
        "config { appNode { pipe { window { channel { name \"a\" } } } } layout { name \"x\" view "
        "{} } layout { name \"y\" view {} } canvas { layout \"x\" layout \"y\" segment { channel "
        "\"a\" } } }";
    EXPECT_EQ(describe(Read(canvas).findings, "f"), "") << "a canvas may have several layouts";
    EXPECT_THAT(describe(Read(withCompounds("compound { load_equalizer { boundary [ 16 16 ] "
                                            "boundary .01 } }"))
                             .findings,
                         "f"),
                testing::Not(HasSubstr("given again")))
        << "one of pixels, the other of the range";
}

/// Blocks, too, of which one counts.
TEST(EqcWarnings, SayWhichOfTwoWallsCounts) {
    const auto found = [](const std::string& text) { return describe(Read(text).findings, "f"); };
    EXPECT_EQ(found("config { layout { view {\n wall {}\n projection {} } } }"),
              "f:3:2: warning: 'projection' is given again (before as 'wall'): what it was before "
              "does not count\n");
    for (const char* twice : {"wall {} wall {}", "projection {} wall {}",
                              "swapbarrier {} swapbarrier { name \"b\" }"}) {
        EXPECT_THAT(found(withCompounds(fmt::format("compound {{ {} }}", twice))),
                    HasSubstr("is given again"))
            << twice;
        EXPECT_THAT(found(fmt::format("config {{ canvas {{ {} }} }}", twice)),
                    HasSubstr("is given again"))
            << twice;
        EXPECT_THAT(found(fmt::format("config {{ canvas {{ segment {{ {} }} }} }}", twice)),
                    HasSubstr("is given again"))
            << twice;
    }
    EXPECT_THAT(found("config { layout { view {} view {} } }"),
                testing::Not(HasSubstr("given again")));
}

/// Measured to the centimetre, on a room's floor.
TEST(EqcWarnings, SayWhichWallsAreNearlyRectangles) {
    const auto found = [](double skew) {
        return describe(
            Read(fmt::format("config {{ layout {{ view {{\n wall {{ bottom_left [ 0 0 0 ] "
                             "bottom_right [ 3 0 0 ] top_left [ {} 2 0 ] }} }} }} }}",
                             2 * skew))
                .findings,
            "f");
    };
    EXPECT_EQ(found(.0009), "");
    for (const double skew : {.01, -.01})
        EXPECT_EQ(found(skew), fmt::format("f:2:2: warning: the wall's sides meet at {} degrees in "
                                           "bottom_left: it is taken for the rectangle with the "
                                           "lower side and as high\n",
                                           skew > 0 ? "89.43" : "90.57"));
    EXPECT_THAT(found(.0199), HasSubstr("warning: the wall's sides"));
    EXPECT_THAT(found(.021), HasSubstr("error"));
}

TEST(EqcWarnings, SayThatALayoutIsCalledAsNoneIs) {
    EXPECT_THAT(
        describe(Read("config {\nlayout { name \"OFF\" view {} } }").findings, "f"),
        HasSubstr("f:2:1: warning: the layout is called \"OFF\", which is how none is asked "
                  "for"));
}

TEST(EqcWarnings, SayWhichZoomsLeaveOnePixelOfMany) {
    const auto found = [](const std::string& zoom, const std::string& output,
                          const std::string& input) {
        return describe(Read(withCompounds(fmt::format(
                                 "compound {{ channel ( segment 0 view 0 )\ncompound {{ {} channel "
                                 "\"b\"\noutputframe {{ name \"f\" {} }} }}\ninputframe {{ name "
                                 "\"f\" {} }} }}",
                                 zoom, output, input)))
                            .findings,
                        "f");
    };
    const std::string rest =
        " pixels; it says how many there are for each one, as [ .5 .5 ] for half of them across "
        "and along\n";
    const char* const tiny = "zoom [ .0001 .0001 ]";
    EXPECT_EQ(found(tiny, "", ""), "f:2:1: warning: the zoom leaves 1x1 of 640x480" + rest);
    EXPECT_EQ(found("", tiny, ""), "f:3:1: warning: the zoom leaves 1x1 of 640x480" + rest);
    EXPECT_EQ(found("zoom [ .5 .5 ]", "viewport [ 0 0 .5 1 ] zoom [ 1 .002 ]", ""),
              "f:3:1: warning: the zoom leaves 160x1 of 160x240" + rest);
    EXPECT_EQ(found("", "zoom [ .5 .5 ]", "zoom [ .001 2 ]"),
              "f:4:1: warning: the zoom leaves 1x480 of 320x240" + rest);
    EXPECT_EQ(found("zoom [ .1 .1 ]", "zoom [ .1 .1 ]", "zoom [ 100 100 ]"), "");
    EXPECT_EQ(found("zoom [ .02 .02 ]", tiny, ""), "") << "of 13x10 pixels";
}

TEST(EqcWarnings, SayWhatShowsNothing) {
    const std::string node = "config { appNode { pipe { window { channel { name \"a\" } } } } ";
    const auto shown = [&node](const std::string& mode, const std::string& eyes) {
        return node + "layout { view { mode " + mode + " } } canvas { layout 0 segment { channel " +
               "\"a\" } segment { channel \"a\" eye [ " + eyes + " ] } } }";
    };
    const auto alone = [&node](const std::string& mode, const std::string& eyes) {
        return node + "layout { view { mode " + mode + " } } canvas { layout 0 segment { channel " +
               "\"a\" eye [ " + eyes + " ] } } }";
    };
    const auto found = [](const std::string& text) { return describe(Read(text).findings, "f"); };
    EXPECT_THAT(found(node + "layout { view {} } canvas { layout 0 } }"),
                HasSubstr("f:1:82: warning: a canvas without segment shows nothing\n"));
    EXPECT_THAT(found(node + "canvas { segment { channel \"a\" } } }"),
                HasSubstr("a canvas without layout shows nothing"));
    EXPECT_THAT(found(node + "layout {} canvas { layout 0 segment { channel \"a\" } } }"),
                HasSubstr("f:1:63: warning: a layout without view shows nothing\n"));
    EXPECT_THAT(found(alone("MONO", "LEFT RIGHT")),
                HasSubstr("f:1:72: warning: no segment of the canvas shows the view: for its mode "
                          "MONO that has to have the eye CYCLOP\n"));
    EXPECT_THAT(found(alone("STEREO", "CYCLOP")), HasSubstr("the eye LEFT or RIGHT"));
    EXPECT_EQ(found(shown("MONO", "LEFT RIGHT")), "") << "the other segment does";
    EXPECT_EQ(found(alone("STEREO", "LEFT")), "");
    EXPECT_EQ(found(withCompounds("compound { channel \"a\" compound { channel \"b\" } }")),
              "f:1:204: warning: nothing of this compound tree is shown: none of its channels is a "
              "view's, as in channel ( canvas 0 segment 0 layout 0 view 0 )\n");
}

TEST(EqcWarnings, SayWhatIsOutsideEveryViewsPictureBesideWhatIsInOne) {
    const auto found = [](const std::string& outside) {
        return describe(
            Read(withCompounds("compound {\n " + outside +
                               "\n compound { channel ( segment 0 view 0 ) task [ CLEAR ASSEMBLE ]"
                               "\ninputframe { name \"f\" } } }"))
                .findings,
            "f");
    };
    const std::string unshown =
        "warning: nothing of this compound tree is shown: none of its channels is a view's, as in "
        "channel ( canvas 0 segment 0 layout 0 view 0 )\n";
    const std::string stays =
        "warning: the outputframe stays empty: its compound is no part of a view's picture, as "
        "with channel ( segment 0 view 0 )\n";
    const std::string noFrame =
        "f:4:1: warning: no outputframe of this compound tree is named \"f\"\n";
    EXPECT_EQ(found("compound { channel \"b\" wall {} outputframe { name \"f\" } }"),
              "f:2:33: " + stays + noFrame + "f:2:2: " + unshown);
    EXPECT_EQ(found("compound { outputframe { name \"f\" } compound { channel \"b\" } }"),
              "f:2:13: " + stays + noFrame + "f:2:2: " + unshown);
    EXPECT_EQ(found("outputframe { name \"f\" }"), "f:2:2: " + stays + noFrame);
    EXPECT_EQ(found("compound { channel ( segment 0 view 0 ) outputframe { name \"f\" } }\n"
                    "compound { channel \"b\" task [ ASSEMBLE ] inputframe { name \"f\" } }"),
              "f:3:42: warning: the inputframe has no effect: its compound is no part of a view's "
              "picture, as with channel ( segment 0 view 0 )\n");
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

TEST(EqcWarnings, NameQueuesThatAnotherOfTheirNameLeavesWithoutEffect) {
    const auto found = [](const std::string& first, const std::string& second) {
        return describe(
            Read(withCompounds(
                     "compound { channel ( segment 0 view 0 )\n compound { " + first +
                     " outputtiles { name \"q\" size [ 64 64 ] }\n compound { inputtiles { name "
                     "\"q\" } } }\n compound { " +
                     second +
                     "\n outputtiles { name \"q\" size [ 32 32 ] }\n compound { inputtiles { name "
                     "\"q\" } } } }"))
                .findings,
            "f");
    };
    const std::string second =
        "f:5:2: warning: other outputtiles are named \"q\" already; these have no effect\n";
    EXPECT_THAT(found("", ""), HasSubstr(second));
    const auto isNone = [&](const std::string& text) { return text.find(second) == text.npos; };
    EXPECT_TRUE(isNone(found("period 2 phase 0", "period 2 phase 1"))) << "of other frames";
    EXPECT_TRUE(isNone(found("zoom [ .5 .5 ]", ""))) << "of other pixels";
}

TEST(EqcWarnings, ProposeTheSettingThatIsNearlyOneThatIsNone) {
    const auto found = [](const std::string& global, const std::string& attributes) {
        return describe(Read("global { " + global +
                             " }\nconfig { appNode { pipe { window { "
                             "attributes { " +
                             attributes + " } channel { name \"a\" } } } } }")
                            .findings,
                        "f");
    };
    EXPECT_EQ(found("", "hint_stereoo OFF"),
              "f:2:49: warning: 'hint_stereoo' is no setting here and is left out, did you mean "
              "'hint_stereo'?\n");
    EXPECT_EQ(
        found("EQ_CONFIG_FATTR_EYE_BAS .05", ""),
        "f:1:10: warning: 'EQ_CONFIG_FATTR_EYE_BAS' is no global setting and is left out, did "
        "you mean 'EQ_CONFIG_FATTR_EYE_BASE'?\n");
    EXPECT_EQ(found("", "colour OFF"),
              "f:2:49: warning: 'colour' is no setting here and is left out\n");
}

/// As older files have them.
TEST(EqcWarnings, SayHowWordsOfSettingsAreReadWhateverTheirCase) {
    const Read read("config { appNode { pipe { window { attributes { hint_fullscreen on } } } } }");
    EXPECT_FALSE(read.findings.hasErrors());
    EXPECT_THAT(describe(read.findings, "f"),
                HasSubstr("f:1:49: warning: 'hint_fullscreen' is on, which is read as ON"));
    EXPECT_EQ(std::get<Attribute::Words>(
                  read.configuration.nodes.at(0).pipes[0].windows[0].attributes.at(0).value)
                  .words,
              std::vector<std::string>{"ON"});
    EXPECT_THAT(firstError("config { appNode { pipe { window { attributes { hint_fullscreen yes }"
                           " } } } }"),
                HasSubstr("expected a whole number or a word such as ON"));
}

TEST(EqcWarnings, NoteSegmentsThatTakeTheSamePlace) {
    const auto found = [](const std::string& left, const std::string& right) {
        return describe(Read("config { appNode { pipe { window { channel { name \"a\" }"
                             " channel { name \"b\" } } } } layout { view { mode STEREO } }"
                             " canvas { layout 0 wall {} segment { channel \"a\" " +
                             left + " } segment { channel \"b\" " + right + " } } }")
                            .findings,
                        "f");
    };
    EXPECT_THAT(found("", ""),
                HasSubstr("note: another segment of the canvas takes the same place"));
    EXPECT_EQ(found("viewport [ 0 0 .5 1 ]", "viewport [ .5 0 .5 1 ]"), "");
    EXPECT_EQ(found("eye [ LEFT CYCLOP ]", "eye [ RIGHT CYCLOP ]"), "")
        << "never in one picture, of a stereo view";
    EXPECT_THAT(found("eye [ LEFT ]", "eye [ RIGHT ] } segment { channel \"b\" eye [ RIGHT ]"),
                HasSubstr("takes the same place"));
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

TEST(EqcWarnings, NameFramesThatAreTakenForOtherEyesOrPhasesThanTheyAreDrawnFor) {
    const auto found = [](const std::string& mode, const std::string& drawn,
                          const std::string& taken) {
        std::string text = withCompounds(
            "\ncompound { channel ( segment 0 view 0 ) compound {}\n compound { "
            "channel \"b\" " +
            drawn + " outputframe { name \"f\" } }\n compound { task [ ASSEMBLE ] " + taken +
            "\ninputframe { name \"f\" } } }");
        return describe(Read(text.replace(text.find("view {"), 6, "view { mode " + mode)).findings,
                        "f");
    };
    for (const auto& [drawn, taken] : std::vector<std::pair<std::string, std::string>>{
             {"eye [ LEFT ]", "eye [ RIGHT ]"}, {"period 2 phase 1", "period 2 phase 0"}}) {
        const std::string text = found("STEREO", drawn, taken);
        EXPECT_THAT(text, HasSubstr("f:5:1: warning: the outputframe \"f\" is never drawn for an "
                                    "eye and in a frame in which it is taken here\n"));
        EXPECT_THAT(text, HasSubstr("warning: nobody takes the outputframe \"f\"\n"));
    }
    EXPECT_EQ(found("STEREO", "eye [ LEFT ]", "eye [ LEFT RIGHT ]"), "");
    EXPECT_EQ(found("STEREO", "period 4 phase 3", "period 2 phase 1"), "");
    EXPECT_EQ(found("MONO", "eye [ LEFT ]", "eye [ RIGHT ]"), "");
    EXPECT_EQ(found("MONO", "eye [ LEFT ]", ""), "") << "the view may be switched to STEREO";
}

TEST(EqcWarnings, SayThatChildrenDrawWhereTheirCompoundIsToldTo) {
    const Read read(
        withCompounds("compound { channel ( segment 0 view 0 ) task [ CLEAR DRAW ]\ncompound { "
                      "task [ DRAW ] } }"));
    EXPECT_EQ(describe(read.findings, "f"),
              "f:1:204: note: 'DRAW' has no effect here: where a compound has children, they "
              "draw\n");
    EXPECT_FALSE(read.resolved.compounds[0].tasks.draw);
    EXPECT_TRUE(read.resolved.compounds[1].tasks.draw);
}

TEST(EqcWarnings, SayWhichOutputFramesHaveANameThatAnotherHas) {
    const auto found = [](const std::string& first) {
        return describe(Read(withCompounds("compound { channel ( segment 0 view 0 )\n compound { "
                                           "channel \"b\" " +
                                           first +
                                           " outputframe { name \"f\" } }\n compound { channel "
                                           "\"b\" outputframe { name \"f\" } }\n inputframe { "
                                           "name \"f\" } }"))
                            .findings,
                        "f");
    };
    EXPECT_EQ(found(""),
              "f:3:25: warning: another outputframe is named \"f\" already; this one has no "
              "effect\n");
    EXPECT_EQ(
        found("task [ CLEAR DRAW ]"),
        "f:2:45: warning: the compound's task has no READBACK: the outputframe stays empty\n");
}

TEST(EqcWarnings, SayWhereVeryManyFramesOfOneNameAreNotComparedAnyMore) {
    const auto read = [](int count) {
        std::string compounds;
        for (int i = 0; i < count; ++i)
            compounds += fmt::format(
                "compound {{ channel \"b\" period {} phase {} outputframe {{ name \"f\" }} }} ",
                count, i);
        return Read(withCompounds("compound { channel ( segment 0 view 0 )\n" + compounds +
                                  "inputframe { name \"f\" } inputframe { name \"typo\" } }"));
    };
    EXPECT_THAT(describe(read(100).findings, "f"), HasSubstr("is named \"typo\""));
    const Read many = read(2000);
    EXPECT_THAT(describe(many.findings, "f"),
                HasSubstr("note: frames of one name are compared with each other in up to 1000000 "
                          "pairs: from \"f\" here on"));
    EXPECT_EQ(many.findings.all().size(), 2U);
    EXPECT_THAT(describe(many.findings, "f"), HasSubstr("is named \"typo\""))
        << "which needs no comparing";
    EXPECT_TRUE(many.resolved.compounds.front().inputFrames.at(0).isMatched);
    EXPECT_TRUE(many.resolved.compounds.back().outputFrames.at(0).isMatched);
}

/// A canvas shows one of its layouts at a time.
TEST(EqcWarnings, AreNotOfFramesOfOneNameInTwoLayoutsOfACanvas) {
    const auto read = [](const std::string& second) {
        return Read(
            "config { appNode { pipe { window { channel { name \"a\" } channel { name \"b\" } } } "
            "} "
            "layout { name \"l\" view {} } layout { name \"m\" view {} } canvas { layout \"l\" "
            "layout "
            "\"m\" segment { channel \"a\" } }\n"
            "compound { compound { channel ( layout \"l\" ) compound { channel \"b\"\n"
            "outputframe { name \"f\" } } inputframe { name \"f\" } }\n"
            "compound { channel ( layout \"m\" ) compound { channel \"b\"\n"
            "outputframe { name \"" +
            second + "\" } } inputframe { name \"f\" } } } }");
    };
    const Read both = read("f");
    EXPECT_EQ(describe(both.findings, "f"), "");
    ASSERT_EQ(both.resolved.compounds.size(), 5U);
    for (const std::size_t taker : {1U, 3U})
        EXPECT_TRUE(both.resolved.compounds[taker].inputFrames.at(0).isMatched);
    for (const std::size_t maker : {2U, 4U})
        EXPECT_TRUE(both.resolved.compounds[maker].outputFrames.at(0).isMatched);
    EXPECT_THAT(describe(read("g").findings, "f"),
                HasSubstr("the outputframe \"f\" is never drawn"))
        << "the other layout's is no help";
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

TEST(EqcWarnings, SayWhereCompoundsMakeNothingOfWhatTheViewShows) {
    const auto found = [](const std::string& compound) {
        return describe(
            Read("#Equalizer 1.2 ascii\n" +
                 withCompounds("\ncompound { channel ( segment 0 view 0 ) " + compound + " }"))
                .findings,
            "f");
    };
    const std::string background =
        "f:3:1: warning: no compound draws or assembles what the view shows, that of the eye "
        "CYCLOP: it is background\n";
    EXPECT_EQ(found("eye [ LEFT RIGHT ]"), background);
    EXPECT_EQ(found("compound { eye [ LEFT ] } compound { eye [ RIGHT ] }"), background);
    EXPECT_EQ(found("task [ CLEAR ]"), background);
    EXPECT_EQ(found("eye [ LEFT CYCLOP ]"), "");
    EXPECT_EQ(found("compound { eye [ LEFT ] } compound { eye [ CYCLOP ] }"), "");
}

TEST(EqcWarnings, SayWhichEyeNoCompoundDraws) {
    const auto found = [](const std::string& segments, const std::string& compounds) {
        return describe(Read("#Equalizer 1.2 ascii\nconfig { appNode { pipe { window { channel { "
                             "name \"a\" } channel { name \"b\" } channel { name \"c\" } } } } "
                             "layout { view { mode STEREO } } canvas { layout 0 wall {} " +
                             segments + " }\n" + compounds + " }")
                            .findings,
                        "f");
    };
    const std::string right =
        "f:3:1: warning: no compound draws or assembles what the view shows, that of the eye "
        "RIGHT: it is background\n";
    const std::string whole = "segment { channel \"a\" }";
    const std::string top = "compound { channel ( segment 0 view 0 ) ";
    const std::string taken = "inputframe { name \"f\" }";
    const std::string given = "outputframe { name \"f\" }";
    EXPECT_EQ(found(whole, top + "eye [ LEFT CYCLOP ] }"), right);
    EXPECT_EQ(found(whole, top + "compound { eye [ LEFT ] } compound { eye [ LEFT ] } }"), right);
    EXPECT_EQ(found(whole, top + "compound { eye [ LEFT ] } compound { eye [ RIGHT ] } }"), "");
    EXPECT_EQ(found(whole, top + "eye [ LEFT ] } " + top + "eye [ RIGHT ] }"), "");
    EXPECT_EQ(
        found(whole, top + "compound { channel \"b\" eye [ LEFT ] " + given + " } " + taken + " }"),
        right);
    EXPECT_EQ(found(whole, top + "compound { channel \"b\" " + given + " } " + taken + " }"), "");

    const std::string ofB = "compound { channel ( segment 1 view 0 ) ";
    const std::string over = whole + " segment { channel \"b\" }";
    const std::string beside =
        "segment { channel \"a\" viewport [ 0 0 .5 1 ] } segment { channel \"b\" viewport [ .5 0 "
        ".5 1 ] }";
    EXPECT_THAT(found(over, top + "eye [ LEFT ] } " + ofB + "eye [ RIGHT ] }"),
                testing::Not(HasSubstr("no compound")));
    EXPECT_EQ(found(beside, top + "eye [ LEFT ] } " + ofB + "}"), right);
    EXPECT_THAT(found(over, top + "} " + ofB + "task [ CLEAR ] }"),
                HasSubstr("of the eye LEFT and RIGHT"));
    const std::string head = " compound { wall { type HMD } } } ";
    EXPECT_EQ(found(beside, top + "eye [ LEFT ]" + head + ofB + "eye [ RIGHT ]" + head), "");
    EXPECT_THAT(found(beside, top + "eye [ LEFT ]" + head + ofB + "eye [ LEFT ]" + head),
                HasSubstr(right));
    // Another segment's picture is taken, with the eyes that it has.
    EXPECT_EQ(found(beside, "compound { " + ofB + given + " } " + top + "task [ ASSEMBLE ] " +
                                taken + " } }"),
              "");
    EXPECT_THAT(found(beside, "compound { " + ofB + "compound { eye [ LEFT ] " + given + " } }\n" +
                                  top + "task [ ASSEMBLE ] " + taken + " } }"),
                HasSubstr("f:4:1: warning: no compound draws or assembles what the view shows, "
                          "that of the eye RIGHT"));
}

TEST(EqcWarnings, SayWhichCompoundsHaveNoneOfTheEyesAboveThem) {
    const auto found = [](const std::string& mode, const std::string& compounds) {
        std::string text =
            withCompounds("\ncompound { channel ( segment 0 view 0 ) " + compounds + " }");
        return describe(Read(text.replace(text.find("view {"), 6, "view { mode " + mode)).findings,
                        "f");
    };
    const std::string none =
        "f:3:1: warning: none of the compound's eyes are among those of the compound above it: it "
        "does nothing\n";
    const std::string left =
        "eye [ CYCLOP LEFT ] compound {} \ncompound { eye [ RIGHT ] compound {} }";
    EXPECT_EQ(found("STEREO", left), none);
    EXPECT_EQ(found("MONO", left), none);
    EXPECT_EQ(
        found("STEREO", "compound {}\ncompound { eye [ CYCLOP ] compound { eye [ CYCLOP ] } }"),
        "");
    EXPECT_EQ(found("MONO", "compound {}\ncompound { eye [ LEFT ] }"), "");
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

/// As in Equalizer, whose reader has one, which each block adds to.
TEST(EqcWarnings, SayWhichAppNodeAnotherIsAddedTo) {
    const Read read(
        "config {\n appNode { name \"a\" pipe { name \"p\" } }\n node { name \"n\" }\n"
        " appNode { host \"viz\" pipe { name \"q\" } } }");
    EXPECT_EQ(describe(read.findings, "f"),
              "f:4:2: warning: there is an appNode already, at 2:2: what is here is added to it; "
              "call other machines 'node'\n");
    ASSERT_EQ(read.configuration.nodes.size(), 2U);
    const Node& node = read.configuration.nodes[0];
    EXPECT_EQ(node.name, "a");
    EXPECT_EQ(node.host, "viz");
    ASSERT_EQ(node.pipes.size(), 2U);
    EXPECT_EQ(node.pipes[1].name, "q");
    EXPECT_FALSE(read.configuration.nodes[1].isApplication);
}

TEST(EqcWarnings, SayThatALayoutIsOnItsCanvasAlready) {
    const Read read(
        "config { node { pipe { window { channel { name \"a\" } } } } layout { view {} }"
        " canvas { layout 0 layout OFF layout 0 segment { channel \"a\" } } }");
    EXPECT_THAT(describe(read.findings, "f"), HasSubstr("layout 0 is on the canvas already"));
    EXPECT_EQ(read.resolved.destinations.size(), 1U);
}

}  // namespace
}  // namespace eyrie::config
