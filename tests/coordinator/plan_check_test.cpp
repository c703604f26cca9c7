// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/plan_check.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/resolved.h"
#include "random_compounds.h"

namespace eyrie::compound {
namespace {

using testing::HasSubstr;

/// All that is said of a configuration that is read and resolved without errors.
std::string foundIn(const std::string& text) {
    config::Findings findings;
    const config::Configuration configuration = config::readEqc(text, findings);
    config::resolve(configuration, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "f");
    config::Findings found;
    checkPlans(configuration, found);
    return describe(found, "f");
}

/// Channels "a" to "c" of so many pixels, two views on "a", the second on its canvas's second
/// layout, and these compounds.
std::string withCompounds(std::string_view compounds, std::string_view pixels = "640 480",
                          std::string_view mode = "MONO") {
    std::string channels;
    for (const char name : {'a', 'b', 'c'})
        channels += fmt::format("window {{ viewport [ 0 0 {} ] channel {{ name \"{}\" }} }} ",
                                pixels, name);
    return fmt::format(
        "config {{ appNode {{ pipe {{ {}}} }} layout {{ view {{ name \"v\" mode {} }} }} layout {{ "
        "view {{ name \"w\" }} }} canvas {{ layout 0 layout 1 segment {{ channel \"a\" }} }}\n{} "
        "}}",
        channels, mode, compounds);
}

TEST(PlanCheck, WarnsOfWallsThroughWhichNothingCanBeDrawn) {
    const auto wall = [](std::string_view half) {
        return foundIn(fmt::format(
            "config {{ appNode {{ pipe {{ window {{ channel {{ name \"a\" }} }} }} }} observer "
            "{{}} "
            "layout {{ view {{ observer 0 }} }}\ncanvas {{ layout 0 segment {{ channel \"a\" wall "
            "{{ "
            "bottom_left [ -{0} -{0} -1 ] bottom_right [ {0} -{0} -1 ] top_left [ -{0} {0} -1 ] }} "
            "}} }} }}",
            half));
    };
    EXPECT_EQ(wall(".001"), "");
    EXPECT_THAT(wall(".0000001"),
                testing::AllOf(HasSubstr("warning: nothing is shown: the eye sees what "
                                         "cannot be drawn through its wall: "),
                               HasSubstr("sight.frustum.right")));
}

/// Every third column, at a zoom of 2: the first of them is left of the view.
TEST(PlanCheck, RefusesPixelsThatReachBeyondTheView) {
    const auto shares = [](std::string_view zoom) {
        return foundIn(withCompounds(fmt::format(
            "compound {{ channel ( segment 0 view \"v\" )\ncompound {{ channel \"b\" pixel [ 0 0 3 "
            "1 "
            "] zoom [ {} 1 ] outputframe {{ name \"x\" }} }}\ncompound {{ pixel [ 1 0 3 1 ] }} "
            "compound {{ pixel [ 2 0 3 1 ] }} inputframe {{ name \"x\" }} }}",
            zoom)));
    };
    EXPECT_EQ(shares("1"), "");
    EXPECT_THAT(shares("2"), testing::AllOf(HasSubstr("f:3:1: error: "),
                                            HasSubstr("reaches beyond that: raster.origin.x")));
}

constexpr const char* kRing =
    "compound { channel \"b\" inputframe { name \"x\" } outputframe { name \"y\" } }\n"
    "compound { channel \"c\" inputframe { name \"y\" } outputframe { name \"x\" } }\n"
    "inputframe { name \"x\" } }";

/// A tree of which two compounds wait for each other.
std::string ringIn(std::string_view view) {
    return fmt::format("compound {{ channel ( segment 0 view \"{}\" )\n{}", view, kRing);
}

constexpr const char* kRingFound =
    "f:3:1: error: compounds wait for each other's frames: this one, one at 4:1; one of two that "
    "exchange frames has to read back before it assembles, in a compound of its own\n";

TEST(PlanCheck, FindsFramesThatWaitForEachOtherWithLineAndColumn) {
    EXPECT_EQ(foundIn(withCompounds(ringIn("v"))), kRingFound);
}

TEST(PlanCheck, FindsThemInLayoutsThatAreNotShownAtFirst) {
    EXPECT_EQ(foundIn(withCompounds(ringIn("w"))), kRingFound);
}

TEST(PlanCheck, FindsThemInFramesAfterTheFirst) {
    EXPECT_EQ(foundIn(withCompounds(
                  fmt::format("compound {{ channel ( segment 0 view \"v\" ) compound {{ period 2 "
                              "phase 0 }} compound {{ period 2 phase 1\n{} }}",
                              kRing))),
              kRingFound);
}

TEST(PlanCheck, SaysOfTwoEyesOnceWhatIsWrongForBoth) {
    EXPECT_EQ(foundIn(withCompounds(ringIn("v"), "640 480", "STEREO")), kRingFound);
}

TEST(PlanCheck, FindsFramesInPixelsThatTheirTakerHasNot) {
    EXPECT_EQ(
        foundIn(
            withCompounds("compound { channel ( segment 0 view \"v\" )\n"
                          "compound { channel \"b\" outputframe { name \"whole\" } }\n"
                          "compound { channel \"c\" pixel [ 0 0 2 1 ] task [ ASSEMBLE READBACK ]\n"
                          "  inputframe { name \"whole\" } outputframe { name \"half\" } }\n"
                          "inputframe { name \"half\" } }")),
        "f:5:3: error: an input frame for the picture of channel \"a\" has pixels that are not "
        "among those of the compound that takes it; take it where its pixel, subpixel or "
        "zoom is split\n");
}

TEST(PlanCheck, FindsZoomsThatNothingDraws) {
    EXPECT_EQ(
        foundIn(withCompounds("compound { channel ( segment 0 view \"v\" )\n"
                              "compound { name \"large\" zoom [ 1 65 ] } }")),
        "f:3:1: error: compound \"large\" has the zoom [ 1 65 ]; expected numbers above 0, up "
        "to 64\n");
}

TEST(PlanCheck, WarnsOfPicturesThatAreDrawnSmallerOnly) {
    const std::string zoomed =
        "compound { channel ( segment 0 view \"v\" )\ncompound { zoom [ 4 4 ] } }";
    EXPECT_EQ(foundIn(withCompounds(zoomed)), "");
    EXPECT_THAT(foundIn(withCompounds(zoomed, "6000 400")),
                testing::AllOf(testing::StartsWith("f:3:1: warning: "), HasSubstr("24000x1600")));
}

TEST(PlanCheck, HasNothingToSayOfSharesAboveAViewsPicture) {
    for (const std::string above : {"pixel [ 0 0 2 1 ]", "zoom [ .5 .5 ]", "viewport [ 0 0 .5 1 ]"})
        EXPECT_EQ(foundIn(withCompounds("compound { " + above +
                                        " compound { channel ( segment 0 view \"v\" ) } }")),
                  "")
            << above;
}

/// A destination whose picture two channels make, each what is said of it.
std::string halves(std::string_view b, std::string_view c) {
    return withCompounds(
        fmt::format("compound {{ channel ( segment 0 view \"v\" ) buffer [ COLOR DEPTH ]\n"
                    "compound {{ channel \"b\" {} outputframe {{ name \"b\" }} }}\n"
                    "compound {{ channel \"c\" {} outputframe {{ name \"c\" }} }}\n"
                    "inputframe {{ name \"b\" }} inputframe {{ name \"c\" }} }}",
                    b, c));
}

TEST(PlanCheck, WarnsOfPartsOfThePictureThatNobodyDraws) {
    EXPECT_EQ(foundIn(halves("viewport [ 0 0 .4 1 ]", "viewport [ .5 0 .5 1 ]")),
              "f:2:1: warning: nothing draws 10 % of what is shown, in viewport [ 0.4 0 0.1 1 ]: "
              "it is background\n");
    EXPECT_EQ(foundIn(halves("viewport [ .1 .1 .4 .8 ]", "viewport [ .5 .1 .4 .8 ]")),
              "f:2:1: warning: nothing draws 36 % of what is shown: it is background\n");
    EXPECT_EQ(foundIn(halves("viewport [ 0 0 .5 1 ]", "viewport [ .4 0 .6 1 ]")), "");
}

TEST(PlanCheck, WarnsOfWhatIsDrawnAndDoesNotReachThePicture) {
    const std::string lost =
        "f:2:1: warning: what is drawn does not reach the picture, which is background: other "
        "channels give it as an outputframe, which is taken as an inputframe\n";
    const auto child = [](const std::string& rest) {
        return foundIn(withCompounds("compound { channel ( segment 0 view 0 ) " + rest + " }"));
    };
    EXPECT_EQ(child("compound { channel \"b\" }"), lost);
    EXPECT_EQ(child("compound { channel \"b\" range [ 0 .5 ] } "
                    "compound { channel \"c\" range [ .5 1 ] }"),
              lost);
    EXPECT_EQ(child("compound { period 2 phase 0 } compound { channel \"b\" period 2 phase 1 }"),
              lost);
    EXPECT_EQ(
        child("compound { channel \"b\" compound { channel \"c\" outputframe { name \"c\" } } "
              "inputframe { name \"c\" } }"),
        lost);
    EXPECT_EQ(child("compound { channel \"b\" outputframe { name \"b\" } } "
                    "inputframe { name \"b\" }"),
              "");
}

TEST(PlanCheck, WarnsOfDataThatNobodyDraws) {
    EXPECT_EQ(foundIn(halves("range [ 0 .4 ]", "range [ .5 1 ]")),
              "f:2:1: warning: nothing draws 10 % of what is shown, in range [ 0.4 0.5 ]: it is "
              "background\n");
    EXPECT_EQ(foundIn(halves("range [ 0 .5 ]", "range [ .5 1 ] viewport [ .5 0 .5 1 ]")),
              "f:2:1: warning: nothing draws 25 % of what is shown, in viewport [ 0 0 0.5 1 ], in "
              "range [ 0.5 1 ]: it is background\n");
}

TEST(PlanCheck, WarnsOfDataThatAStripWithoutDepthCovers) {
    const auto strip = [](std::string_view range) {
        return foundIn(withCompounds(fmt::format(
            "compound {{ channel ( segment 0 view \"v\" ) buffer [ COLOR DEPTH ]\n"
            "compound {{ range [ 0 .5 ] outputframe {{ name \"own\" }} }}\n"
            "compound {{ channel \"b\" compound {{ range [ .5 1 ] outputframe {{ name "
            "\"rest\" viewport [ .25 0 .75 1 ] }} }} {}\n"
            "outputframe {{ name \"strip\" buffer [ COLOR ] viewport [ 0 0 .25 1 ] }} }}\n"
            "inputframe {{ name \"rest\" }} inputframe {{ name \"strip\" }} }}",
            range)));
    };
    EXPECT_EQ(strip("inputframe { name \"own\" }"), "");
    EXPECT_EQ(strip(""),
              "f:5:1: warning: the outputframe has a part of the data and no DEPTH, so it covers "
              "what is nearer; buffer [ COLOR DEPTH ] compares them\n"
              "f:2:1: warning: nothing draws 12.5 % of what is shown, in viewport [ 0 0 0.25 1 ], "
              "in range [ 0 0.5 ]: it is background\n");
}

TEST(PlanCheck, WarnsOfPixelsThatNobodyDraws) {
    EXPECT_EQ(foundIn(halves("pixel [ 0 0 2 1 ]", "pixel [ 1 0 2 1 ]")), "");
    EXPECT_EQ(foundIn(halves("pixel [ 0 0 3 1 ]", "pixel [ 1 0 3 1 ]")),
              "f:2:1: warning: nothing draws 33.3 % of what is shown: it is background\n");
    EXPECT_EQ(foundIn(halves("pixel [ 0 0 4 1 ]", "pixel [ 0 0 4 1 ]")),
              "f:2:1: warning: nothing draws 75 % of what is shown: it is background\n");
}

TEST(PlanCheck, WarnsOfPixelsBetweenSharesThatAreCountedDifferently) {
    EXPECT_EQ(foundIn(halves("pixel [ 0 0 2 1 ]", "pixel [ 1 0 3 1 ]")),
              "f:2:1: warning: nothing draws 33.3 % of what is shown: it is background\n");
    EXPECT_EQ(foundIn(halves("pixel [ 0 0 2 1 ]", "pixel [ 0 1 1 2 ]")),
              "f:2:1: warning: nothing draws 25 % of what is shown: it is background\n");
    EXPECT_EQ(
        foundIn(halves("pixel [ 0 0 2 1 ]", "viewport [ 0 0 .5 1 ] pixel [ 1 0 2 1 ]")),
        "f:2:1: warning: nothing draws 25 % of what is shown, in viewport [ 0.5 0 0.5 1 ]: it "
        "is background\n");
    EXPECT_EQ(foundIn(withCompounds(
                  "compound { channel ( segment 0 view \"v\" )\n"
                  "compound { pixel [ 0 0 2 1 ] } compound { pixel [ 1 0 4 1 ] } compound { pixel "
                  "[ 3 0 4 1 ] } }")),
              "");
}

TEST(PlanCheck, SaysNothingOfPixelsThatTakeLongToCount) {
    const auto found = [](const char* pixels) {
        return foundIn(
            withCompounds("compound { channel ( segment 0 view \"v\" )\n"
                          "compound { pixel [ 0 0 1 2 ] } compound { pixel [ 0 0 1000 "
                          "499 ] } }",
                          pixels));
    };
    EXPECT_THAT(found("640 480"), HasSubstr("of what is shown: it is background"));
    EXPECT_EQ(found("16384 16384"), "");
}

RC_GTEST_PROP(PlanCheck, FindsNoGapWhereAllIsDrawn, ()) {
    RandomCompounds random(*rc::gen::arbitrary<std::uint32_t>());
    const config::Configuration whole = random.maybe()
                                            ? random.configuration(1 + random.below(4))
                                            : random.timeMultiplexed(2 + random.below(3));
    config::Findings findings;
    checkPlans(whole, findings);
    RC_ASSERT(describe(findings, "f").empty());
}

/// An equalizer over what "a" and "b" draw, each what is said of it.
std::string balanced(std::string_view equalizer, std::string_view a, std::string_view b) {
    return withCompounds(
        fmt::format("compound {{ channel ( segment 0 view \"v\" ) buffer [ COLOR DEPTH ] {}\n"
                    "compound {{ {} outputframe {{ name \"own\" }} }}\n"
                    "compound {{ channel \"b\" {} }}\n"
                    "inputframe {{ name \"own\" }} inputframe {{ name \"b\" }} }}",
                    equalizer, a, b));
}

TEST(PlanCheck, LeavesPartsToTheEqualizerThatChoosesThem) {
    for (const char* equalizer : {"load_equalizer { mode 2D }", "load_equalizer { mode DB }",
                                  "tree_equalizer {}", "tile_equalizer {}"}) {
        EXPECT_EQ(foundIn(balanced(equalizer, "viewport [ 0 0 .4 1 ]",
                                   "viewport [ .5 0 .5 1 ] outputframe { name \"b\" }")),
                  "")
            << equalizer;
    }
}

TEST(PlanCheck, WarnsOfTheHalfThatAnEqualizerLosesWithAChild) {
    for (const char* equalizer :
         {"load_equalizer { mode 2D }", "tree_equalizer {}", "tile_equalizer { size [ 320 480 ] }"})
        EXPECT_EQ(foundIn(balanced(equalizer, "", "")),
                  "f:2:1: warning: nothing draws 50 % of what is shown, in viewport [ 0.5 0 0.5 1 "
                  "]: it is background\n")
            << equalizer;
    EXPECT_EQ(foundIn(balanced("load_equalizer {}", "pixel [ 0 0 2 1 ]",
                               "pixel [ 1 0 2 1 ] outputframe { name \"b\" }")),
              "f:2:1: warning: nothing draws 50 % of what is shown: it is background\n");
    EXPECT_EQ(foundIn(balanced("load_equalizer { mode DB }", "compound { range [ 0 .5 ] }",
                               "compound { range [ .5 1 ] } outputframe { name \"b\" }")),
              "f:2:1: warning: nothing draws 50 % of what is shown, in range [ 0.25 0.75 ]: it is "
              "background\n");
}

TEST(PlanCheck, FindsNoGapWhereTilesAreTakenInSeveralQueuesOrBelowOutputFrames) {
    const auto half = [](std::string_view viewport, std::string_view frame) {
        return fmt::format(
            "compound {{ viewport [ {0} ] tile_equalizer {{ name \"q\" }} compound {{ }} compound "
            "{{ "
            "channel \"b\" outputframe {{ name \"{1}\" }} }} inputframe {{ name \"{1}\" }} }}",
            viewport, frame);
    };
    EXPECT_EQ(foundIn(withCompounds("compound { channel ( segment 0 view \"v\" )\n" +
                                    half("0 0 .5 1", "f") + half(".5 0 .5 1", "g") + " }")),
              "");
    EXPECT_EQ(foundIn(withCompounds(
                  "compound { channel ( segment 0 view \"v\" ) tile_equalizer { }\n"
                  "compound { compound { viewport [ 0 0 .5 1 ] } compound { viewport [ .5 0 .5 1 ] "
                  "channel \"b\" outputframe { name \"a\" } } inputframe { name \"a\" } }\n"
                  "compound { channel \"c\" compound { } outputframe { name \"r\" } }\n"
                  "inputframe { name \"r\" } }")),
              "");
}

TEST(PlanCheck, WarnsOfGapsBesideAnEqualizerOfOtherParts) {
    const std::string found =
        "f:2:1: warning: nothing draws 10 % of what is shown, in viewport [ 0.4 0 0.1 1 ]: it is "
        "background\n";
    EXPECT_EQ(foundIn(halves("viewport [ 0 0 .4 1 ]",
                             "viewport [ .5 0 .5 1 ] load_equalizer { mode 2D }")),
              found);
    EXPECT_EQ(foundIn(halves("viewport [ 0 0 .4 1 ]",
                             "viewport [ .5 0 .5 1 ] load_equalizer {} compound {} compound {}")),
              found);
    EXPECT_EQ(foundIn(withCompounds("compound { view_equalizer {} compound { channel ( segment 0 "
                                    "view \"v\" ) compound { viewport [ 0 0 .9 1 ] } } }")),
              "f:2:30: warning: nothing draws 10 % of what is shown, in viewport [ 0.9 0 0.1 1 ]: "
              "it is background\n");
}

TEST(PlanCheck, WarnsOfPartsOfTheDataThatComeWithoutDepth) {
    const auto found = [](std::string_view above, std::string_view first, std::string_view second,
                          std::string_view frame) {
        return foundIn(withCompounds(
            fmt::format("compound {{ channel ( segment 0 view \"v\" ) {} compound {{ {} }}\n"
                        "compound {{ channel \"b\" {}\noutputframe {{ name \"f\" {} }} }} "
                        "inputframe {{ name \"f\" }} }}",
                        above, first, second, frame)));
    };
    const std::string noDepth =
        "f:4:1: warning: the outputframe has a part of the data and no DEPTH, so it covers what is "
        "nearer; buffer [ COLOR DEPTH ] compares them\n";
    const std::string covered =
        "f:2:1: warning: nothing draws 50 % of what is shown, in range [ 0 0.5 ]: it is "
        "background\n";
    const char* const a = "range [ 0 .5 ]";
    const char* const b = "range [ .5 1 ]";
    EXPECT_EQ(found("", a, b, ""), noDepth + covered);
    EXPECT_EQ(found("buffer [ COLOR DEPTH ]", a, b, "buffer [ COLOR ]"), noDepth + covered);
    EXPECT_EQ(found("load_equalizer { mode DB }", "", "", ""), noDepth + covered);
    EXPECT_EQ(found("tile_equalizer { size .1 }", "", "", ""), noDepth + covered);
    EXPECT_EQ(found("buffer [ COLOR DEPTH ] load_equalizer { mode DB }", "", "", ""), "");
    EXPECT_EQ(found("load_equalizer { mode 2D }", "", "", ""), "");
    EXPECT_EQ(found("tile_equalizer {}", "", "", ""), "");
    EXPECT_EQ(found("", a, b, "buffer [ COLOR DEPTH ]"), "");
    EXPECT_EQ(foundIn(withCompounds("compound { channel ( segment 0 view \"v\" ) compound { range "
                                    "[ 0 .5 ] }\ncompound { zoom [ .5 .5 ] range [ .5 1 ] } }")),
              "f:3:1: warning: what the compound draws in pixels of its own has a part of the data "
              "and no DEPTH, so it covers what is nearer; buffer [ COLOR DEPTH ] compares them\n");
}

/// Browsers ask for smaller ones, which are drawn.
TEST(PlanCheck, LooksAtWhatIsLargerThanPicturesMayBeAsAtWhatIsSmaller) {
    const std::string compounds =
        "compound { channel ( segment 0 view \"v\" ) compound { range [ 0 .5 ] }\n"
        "compound { channel \"b\" range [ .5 .75 ]\noutputframe { name \"f\" } } "
        "inputframe { name \"f\" } }";
    const std::string small = foundIn(withCompounds(compounds));
    EXPECT_THAT(small, testing::AllOf(HasSubstr("no DEPTH"), HasSubstr("nothing draws 75 %")));
    const std::string large = foundIn(withCompounds(compounds, "40000 30000"));
    EXPECT_THAT(large, testing::AllOf(HasSubstr("ask for a smaller one"), HasSubstr("no DEPTH"),
                                      HasSubstr("nothing draws 75 %")));
}

/// Two that draw halves of the data, each of the whole picture, and send each other a half of that:
/// then "b" has all of the data in its upper half, whose depth nobody needs.
std::string directSend(std::string_view above, std::string_view first, std::string_view second,
                       std::string_view viewport) {
    return withCompounds(fmt::format(
        "compound {{ channel ( segment 0 view \"v\" ) buffer [ COLOR DEPTH ] {}\n"
        "compound {{ {} channel \"b\" compound {{ outputframe {{ name \"low\" viewport [ 0 0 1 .5 "
        "] }} }} inputframe {{ name \"high\" }}\n"
        "outputframe {{ name \"done\" buffer [ COLOR ] viewport [ {} ] }} }}\n"
        "compound {{ {} compound {{ outputframe {{ name \"high\" viewport [ 0 .5 1 .5 ] }} }} }}\n"
        "inputframe {{ name \"low\" }} inputframe {{ name \"done\" }} }}",
        above, first, viewport, second));
}

TEST(PlanCheck, HasNothingToSayOfFramesWithoutDepthThatHaveAllOfTheData) {
    EXPECT_EQ(foundIn(directSend("", "range [ 0 .5 ]", "range [ .5 1 ]", "0 .5 1 .5")), "");
    EXPECT_EQ(foundIn(directSend("load_equalizer { mode DB }", "", "", "0 .5 1 .5")), "");
    for (const char* tooMuch : {"0 0 1 1", "0 .4 1 .6"})
        EXPECT_THAT(foundIn(directSend("", "range [ 0 .5 ]", "range [ .5 1 ]", tooMuch)),
                    testing::StartsWith("f:4:1: warning: the outputframe has a part of the data "
                                        "and no DEPTH"));
}

/// What is said where the first equalizer is to be so.
std::string refusal(const std::string& text, const config::EqualizerTuning& tuning) {
    config::Findings findings;
    const config::Configuration written = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "f");
    config::ConfigurationState state = initialState(written);
    EXPECT_TRUE(tuneEqualizer(written, state, 0, tuning).ok());
    return std::string(checkDivision(written, state, 0).message());
}

TEST(DivisionCheck, DividesNoDataWhoseDepthsNobodySends) {
    const auto divided = [](std::string_view equalizer, std::string_view child,
                            std::string_view frame, const config::EqualizerTuning& tuning) {
        return refusal(
            withCompounds(fmt::format(
                "compound {{ channel ( segment 0 view \"v\" ) {} compound {{ }}\n"
                "compound {{ name \"helper\" channel \"b\" {}\noutputframe {{ name \"f\" {} }} }} "
                "inputframe {{ name \"f\" }} }}",
                equalizer, child, frame)),
            tuning);
    };
    config::EqualizerTuning db;
    db.mode = config::SplitMode::Db;
    config::EqualizerTuning chunks;
    chunks.tileChunk = .1;
    const std::string refused =
        "equalizer 0: it cannot divide data: the outputframe \"f\" of compound \"helper\" at 4:1 "
        "has no DEPTH, so it would cover what is nearer; write buffer [ COLOR DEPTH ] there";
    EXPECT_EQ(divided("load_equalizer { }", "", "buffer [ COLOR ]", db), refused);
    EXPECT_EQ(divided("tree_equalizer { }", "buffer [ COLOR ]", "", db), refused);
    EXPECT_EQ(divided("tile_equalizer { }", "buffer [ COLOR ]", "", chunks), refused);
    EXPECT_EQ(divided("load_equalizer { }", "", "", db), "");
    EXPECT_EQ(divided("load_equalizer { }", "buffer [ COLOR ]", "buffer [ COLOR DEPTH ]", db), "");
    EXPECT_EQ(divided("load_equalizer { mode DB }", "", "buffer [ COLOR ]", db), "")
        << "it does so as it is written";
    EXPECT_EQ(refusal(directSend("load_equalizer { }", "", "", "0 .5 1 .5"), db), "");
    EXPECT_THAT(refusal(directSend("load_equalizer { }", "", "", "0 0 1 1"), db),
                HasSubstr("cannot divide data"));
}

/// Each plan resolves all compounds, so that it would take minutes.
TEST(PlanCheck, SaysWhatItDoesNotTryOfVeryManyLayouts) {
    const auto found = [](int count) {
        std::string layouts;
        std::string shown;
        for (int i = 0; i < count; ++i) {
            layouts += "layout { view {} } ";
            shown += fmt::format("layout {} ", i);
        }
        return foundIn("config { appNode { pipe { window { channel { name \"a\" } } } } " +
                       layouts + "canvas { " + shown + "segment { channel \"a\" } } }");
    };
    EXPECT_EQ(found(100), "");
    EXPECT_EQ(found(1000),
              "f: note: of 1000 pictures, of each canvas in each of its layouts and in each frame, "
              "the first 500 were tried: with as many compounds the others would take long\n");
}

TEST(PlanCheck, WarnsOfWhatOneEyeAloneSeesInStereo) {
    const auto found = [](std::string_view mode, std::string_view segments,
                          std::string_view further) {
        return foundIn(fmt::format(
            "config {{ appNode {{ pipe {{ window {{ channel {{ name \"a\" }} channel {{ "
            "name \"b\" }} }} }} }} layout {{ view {{ mode {} }} }} canvas {{ layout 0\n"
            "{} }}\n{} }}",
            mode, segments, further));
    };
    const auto segment = [](std::string_view channel, std::string_view viewport,
                            std::string_view eyes) {
        return fmt::format("segment {{ channel \"{}\" viewport [ {} ] eye [ {} ] }}", channel,
                           viewport, eyes);
    };
    const auto lone = [](std::string_view place, std::string_view eye) {
        return fmt::format(
            "f:{}: warning: the segment shows the view's eye {} where none shows the other's: in "
            "stereo that sees background there\n",
            place, eye);
    };
    const std::string left = segment("a", "0 0 1 1", "LEFT");
    const std::string right = segment("b", "0 0 1 1", "RIGHT");
    EXPECT_EQ(found("STEREO", left, ""), lone("2:1", "LEFT"));
    EXPECT_EQ(found("MONO", segment("a", "0 0 1 1", "CYCLOP LEFT"), ""), "");
    EXPECT_EQ(found("STEREO", left + right, ""), "");
    EXPECT_EQ(found("STEREO", left, "canvas { layout 0 " + right + " }"), "");
    EXPECT_EQ(found("STEREO",
                    segment("a", "0 0 .333 1", "LEFT RIGHT") +
                        segment("b", ".333 0 .667 1", "LEFT RIGHT"),
                    ""),
              "");
    EXPECT_EQ(
        found("STEREO",
              segment("a", "0 .5 1 .5", "LEFT") + "\n" + segment("b", "0 0 1 .5", "RIGHT"), ""),
        lone("2:1", "LEFT") + lone("3:1", "RIGHT"))
        << "one above the other, but each of another half of the view";
}

TEST(PlanCheck, WarnsOfAConfigurationThatShowsNothing) {
    EXPECT_THAT(foundIn("config { node { pipe {} } }"),
                HasSubstr("f: warning: there is no canvas, so nothing is shown"));
}

TEST(PlanCheck, HasNothingToSayOfEqualizersFiles) {
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(EYRIE_SOURCE_DIR "/../shared/data/eqc")) {
        if (entry.path().extension() != ".eqc")
            continue;
        ++files;
        std::ifstream in(entry.path(), std::ios::binary);
        EXPECT_EQ(foundIn({std::istreambuf_iterator<char>(in), {}}), "") << entry.path();
    }
    EXPECT_EQ(files, 51U);
}

}  // namespace
}  // namespace eyrie::compound
