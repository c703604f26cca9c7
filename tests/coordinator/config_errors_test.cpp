// SPDX-License-Identifier: Apache-2.0
// What is wrong in configurations, and where.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

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
    EXPECT_THAT(firstError("config { @ }"), HasSubstr("1:10 '@' means nothing here"));
    EXPECT_THAT(firstError("config { \x01 }"), HasSubstr("1:10 the byte 0x01"));
    EXPECT_THAT(firstError("config { /* x */ }"), HasSubstr("comments begin with # or //"));
    EXPECT_THAT(firstError("config { latency }"), HasSubstr("1:10 'latency' has no value"));
    EXPECT_THAT(firstError("config { { } }"), HasSubstr("'{' belongs to no keyword"));
    EXPECT_THAT(firstError("config { layout { view { viewport [ 0 0 1 1 } } }"),
                HasSubstr("1:45 '}' within [ ]: is a ']' missing?"));
    EXPECT_THAT(firstError("config { compound { channel ( segment [ 0 ) } }"),
                HasSubstr("1:43 ')' within [ ]: is a ']' missing?"));
    EXPECT_THAT(firstError(""), HasSubstr("there is no config"));
    EXPECT_THAT(firstError("\n #Equalizer 2.0 ascii\nconfig {}"), HasSubstr("2:2 the file is of "
                                                                            "version 2.0"));
}

TEST(EqcErrors, AreFoundHoweverDeepBlocksLie) {
    std::string deep = "config ";
    for (int i = 0; i < 100'000; ++i) deep += "{ compound ";
    EXPECT_THAT(firstError(deep), HasSubstr("blocks within each other"));

    std::string closed = "config { ";
    for (int i = 0; i < 100; ++i) closed += "compound { ";
    const Read read(closed + std::string(101, '}'));
    EXPECT_EQ(read.findings.errors(), 1U) << describe(read.findings, "f");
}

TEST(EqcText, HasTheVersionOfItsHeaderNotOfComments) {
    EXPECT_EQ(Read("#Equalizer 2.1 configuration of our cave\nconfig {}").configuration.version,
              "");
    EXPECT_EQ(Read("#Equalizer 1.2 ascii\n#Equalizer 1.0 had no canvases\n"
                   "#Equalizer 1.1 ascii\nconfig {}")
                  .configuration.version,
              "1.2");
}

TEST(EqcText, MayBeginWithAByteOrderMark) {
    const Read read("\xef\xbb\xbf#Equalizer 1.1 ascii\nconfig {}");
    EXPECT_EQ(describe(read.findings, "f"), "");
    EXPECT_EQ(read.configuration.version, "1.1");
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
             {"wall { bottom_left [ 0 0 0 ] bottom_right [ 1 0 0 ] top_left [ .021 1 0 ] }",
              "right angle"},
             {"wall { bottom_left [ 0 0 0 ] bottom_right [ 0 0 0 ] top_left [ 0 1 0 ] }",
              "two are one"},
             {"projection { distance 0 }", "above 0"},
             {"load_equalizer { damping 2 }", "from 0 to 1"},
             {"load_equalizer { boundary 1.5 }", "a share from 0 to 1"},
             {"load_equalizer { resistance [ -1 2 ] }",
              "2 whole numbers from 0 to 1000000000 in [ ]"},
             {"load_equalizer { assemble_only_limit 0 }", "above 0"},
             {"tile_equalizer { size 1.5 }", "a share above 0, 1 at most"},
             {"tile_equalizer { size [ 0 4 ] }", "a pixel or more"},
             {"DFR_equalizer { framerate 0 }", "above 0"}})
        EXPECT_THAT(firstError(withCompounds("compound { " + compound + " }")), HasSubstr(message))
            << compound;
}

TEST(EqcErrors, AreSaidOnceOfASettingThatIsNoNumber) {
    for (const char* equalizer :
         {"load_equalizer { assemble_only_limit", "DFR_equalizer { framerate"})
        EXPECT_EQ(Read(withCompounds(std::string("compound { ") + equalizer + " \"x\" } }"))
                      .findings.errors(),
                  1U)
            << equalizer;
}

TEST(EqcText, TakesTheLastSizeOfTiles) {
    const auto read = [](const std::string& sizes) {
        return Read(withCompounds("compound { tile_equalizer { " + sizes + " } outputtiles { " +
                                  sizes + " } }"))
            .configuration.compounds[0];
    };
    const Compound tiles = read("size .1 size [ 32 16 ]");
    EXPECT_EQ(tiles.equalizers[0].tileChunk, std::nullopt);
    EXPECT_EQ(tiles.equalizers[0].tileSize, fabric::Vec2(32, 16));
    EXPECT_EQ(tiles.outputTiles[0].chunk, std::nullopt);
    EXPECT_EQ(tiles.outputTiles[0].size, fabric::Vec2(32, 16));
    const Compound chunks = read("size [ 32 16 ] size .1");
    EXPECT_EQ(chunks.equalizers[0].tileChunk, .1);
    EXPECT_EQ(chunks.outputTiles[0].chunk, .1);
}

TEST(EqcErrors, AreViewportsOfPixelsThatHaveNone) {
    const auto error = [](const std::string& window, const std::string& channel) {
        return firstError("config { appNode { pipe { window {\nviewport [ " + window +
                          " ] channel {\nviewport [ " + channel + " ] } } } } }");
    };
    const std::string none =
        "; expected 1 x 1 pixels or more: a width or a height above 1 makes all four pixels";
    EXPECT_EQ(error("0 0 1 1", ".5 .5 .5 1.5"), "3:1 'viewport' is [ .5 .5 .5 1.5 ]" + none);
    EXPECT_EQ(error("0 0 1.001 .5", "0 0 1 1"), "2:1 'viewport' is [ 0 0 1.001 .5 ]" + none);
    EXPECT_EQ(error("0 0 1 1.5", ".5 .5 .5 .5"), "none");
}

TEST(EqcErrors, AreFocusesThatAreNotAheadOrTooFar) {
    for (const char* distance : {"0", "-2", "1000001"})
        EXPECT_THAT(
            firstError(std::string("config { observer { focus_distance ") + distance + " } }"),
            HasSubstr(std::string("1:10 an observer's focus distance is ") + distance +
                      "; it must be above 0 and at most 1000000"));
}

TEST(EqcErrors, AreEyesThatAreNotBeforeTheirWall) {
    EXPECT_THAT(firstError("config { appNode { pipe { window { channel { name \"a\" } } } }"
                           " observer { eye_cyclop [ 0 0 -2 ] } layout { view { observer 0 } }"
                           " canvas { layout 0 wall {} segment { channel \"a\" } } }"),
                HasSubstr("1:155 the eye CYCLOP is not before the wall that it looks through"));
    const auto found = [](const std::string& wall) {
        return describe(Read("config { appNode { pipe { window { channel { name \"a\" } } } }"
                             " observer {} layout { view { observer 0 mode STEREO } }"
                             " canvas { layout 0 wall { " +
                             wall + " } segment { channel \"a\" } } }")
                            .findings,
                        "f");
    };
    EXPECT_EQ(found("top_left [ -.8 .5 -1 ] bottom_left [ -.8 -.5 -1 ]"), "");
    const std::string turned = found(
        "top_left [ -.8 -.5 -1 ] bottom_left [ -.8 .5 -1 ]"
        " bottom_right [ .8 .5 -1 ]");
    for (const char* const eye : {"LEFT", "RIGHT"})
        EXPECT_THAT(turned,
                    HasSubstr(std::string("error: the eye ") + eye +
                              " is not before the wall that it looks through; where the wall shows "
                              "its back, exchange its bottom and top, or its left and right"));
}

/// A room whose origin is on its floor, say: the head is elsewhere.
TEST(EqcErrors, AreNotEyesThatATrackerMoves) {
    const auto trackedBy = [](const std::string& tracker) {
        return Read(
            "config { appNode { pipe { window { channel { name \"a\" } } } }"
            " observer { eye_cyclop [ 0 0 -2 ] " +
            tracker +
            " } layout { view { observer 0 } }"
            " canvas { layout 0 wall {} segment { channel \"a\" } } }");
    };
    EXPECT_TRUE(trackedBy("opencv_camera OFF").findings.hasErrors());
    EXPECT_FALSE(trackedBy("opencv_camera ON").findings.hasErrors());
    const Read read = trackedBy("vrpn_tracker \"head\"");
    EXPECT_FALSE(read.findings.hasErrors());
    EXPECT_THAT(describe(read.findings, "f"),
                HasSubstr("warning: the eye CYCLOP is not before the wall that it looks through: "
                          "it sees nothing until its head is moved there"));
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

}  // namespace
}  // namespace eyrie::config
