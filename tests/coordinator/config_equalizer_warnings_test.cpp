// SPDX-License-Identifier: Apache-2.0
// What is said of equalizers that have nothing, or not what they need, to work on.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

TEST(EqcEqualizerWarnings, SayWhichEqualizersHaveNoPictureToShareOut) {
    const auto found = [](const std::string& equalizer) {
        return describe(
            Read(withCompounds("compound {\n" + equalizer +
                               " {} compound { channel ( segment 0 view 0 ) compound {} } }"))
                .findings,
            "f");
    };
    for (const char* equalizer :
         {"load_equalizer", "tree_equalizer", "tile_equalizer", "DFR_equalizer"})
        EXPECT_EQ(found(equalizer),
                  "f:2:1: warning: the equalizer has no effect: its compound is no part of a "
                  "view's picture, as with channel ( segment 0 view 0 )\n");
    EXPECT_EQ(found("view_equalizer"), "");
}

/// Of an equalizer on line 2, with these children, in a picture of 640 x 480.
std::string foundOfEqualizer(const std::string& equalizer, const std::string& children) {
    return describe(Read(withCompounds("compound { channel ( segment 0 view 0 )\n" + equalizer +
                                       "\n" + children + " }"))
                        .findings,
                    "f");
}

TEST(EqcEqualizerWarnings, SayWhichEqualizersHaveNothingToWorkOn) {
    for (const char* equalizer :
         {"load_equalizer {}", "tree_equalizer {}", "view_equalizer {}", "framerate_equalizer {}"})
        for (const char* children : {"", "compound { task [ CLEAR ] }"})
            EXPECT_THAT(foundOfEqualizer(equalizer, children),
                        testing::StartsWith("f:2:1: warning: the equalizer has no effect: its "
                                            "compound has no children that draw\n"))
                << equalizer << children;
    EXPECT_EQ(foundOfEqualizer("monitor_equalizer {}", ""),
              "f:2:1: warning: the equalizer has no effect: its compound has no inputframe\n");
    EXPECT_EQ(foundOfEqualizer("tile_equalizer {} DFR_equalizer {}", ""), "");
}

TEST(EqcEqualizerWarnings, SayWhichSettingsAreOfAnotherMode) {
    const auto found = [](const std::string& settings) {
        return foundOfEqualizer("load_equalizer { " + settings + " }", "compound {} compound {}");
    };
    EXPECT_EQ(found("mode DB boundary [ 64 64 ] resistance [ 5 5 ]"),
              "f:2:1: warning: a boundary in pixels has no effect in mode DB; write a share of the "
              "data, such as boundary .01\n"
              "f:2:1: warning: a resistance in pixels has no effect in mode DB; write a share of "
              "the data, such as resistance .01\n");
    EXPECT_EQ(found("mode 2D boundary .3"),
              "f:2:1: warning: a boundary that is a share of the data has an effect in mode DB "
              "only; write pixels, such as boundary [ 16 16 ]\n");
    for (const char* settings :
         {"mode DB boundary [ 1 1 ] resistance [ 0 0 ]", "boundary 0 resistance 0",
          "boundary [ 64 64 ] boundary .3", "mode DB boundary .3", "boundary [ 64 64 ]"})
        EXPECT_EQ(found(settings), "") << settings;
}

TEST(EqcEqualizerWarnings, SayWhichBoundariesLeaveOneChildAll) {
    const auto found = [](const std::string& settings) {
        return foundOfEqualizer("tree_equalizer { " + settings + " }", "compound {} compound {}");
    };
    for (const char* settings : {"boundary [ 640 480 ]", "mode VERTICAL boundary [ 640 1 ]",
                                 "mode HORIZONTAL boundary [ 1 480 ]", "mode DB boundary 1"})
        EXPECT_EQ(found(settings),
                  "f:2:1: warning: the boundary is as large as what is shared out, so one child "
                  "draws all of it; write a smaller one\n")
            << settings;
    EXPECT_EQ(found("boundary [ 640 1 ]"), "");
}

TEST(EqcEqualizerWarnings, SayWhatTakesNoTilesOfATileEqualizer) {
    EXPECT_EQ(foundOfEqualizer("tile_equalizer {}",
                               "compound {}\ncompound { channel \"b\" compound {} outputframe {} } "
                               "inputframe { name \"frame.b\" }"),
              "f:4:1: warning: what is drawn for this compound's outputframe takes no tiles of the "
              "tile_equalizer above: the frame would cover others' tiles; give outputframes to the "
              "compounds that draw instead\n");
}

TEST(EqcEqualizerWarnings, SayWhereAnEqualizerTearsPicturesOfSeveralEyesPhasesOrPixels) {
    const auto found = [](const std::string& equalizer, const std::string& first,
                          const std::string& second) {
        return describe(
            Read(withCompounds("compound { channel ( segment 0 view 0 )\n" + equalizer +
                               " {} compound { " + first + " } compound { " + second + " } }"))
                .findings,
            "f");
    };
    for (const char* equalizer : {"load_equalizer", "tree_equalizer"}) {
        EXPECT_THAT(found(equalizer, "period 2 phase 0", "period 2 phase 1"),
                    HasSubstr("f:2:1: warning: the equalizer shares out one picture, but its "
                              "children draw for other eyes, in other frames"));
        EXPECT_THAT(found(equalizer, "pixel [ 0 0 2 1 ]", "pixel [ 1 0 2 1 ]"),
                    HasSubstr("or other pixels or samples than each other"));
        EXPECT_THAT(found(equalizer, "subpixel [ 0 2 ]", "subpixel [ 1 2 ]"),
                    HasSubstr("or other pixels or samples than each other"));
        EXPECT_EQ(found(equalizer, "", ""), "");
        EXPECT_EQ(found(equalizer, "", "task [ CLEAR ] period 2 phase 1"), "");
    }
    EXPECT_EQ(found("framerate_equalizer", "period 2 phase 0", "period 2 phase 1"), "");
}

/// Of a compound with this loadBalancer.
std::string balancer(const std::string& says) {
    return withCompounds("compound { channel ( segment 0 view 0 )\nloadBalancer { " + says +
                         " } compound {} compound {} }");
}

TEST(EqcLoadBalancers, HaveAResistanceInPixelsOrAsAShare) {
    const auto of = [](const std::string& says) {
        return Read(balancer(says)).configuration.compounds[0].equalizers.at(0);
    };
    EXPECT_EQ(of("mode 2D resistance [ 8 6 ]").resistancePixels, fabric::Vec2(8, 6));
    EXPECT_EQ(of("mode DB resistance .25").resistanceRange, .25);
}

TEST(EqcLoadBalancers, WithoutAModeAreToldWhichTheyAreTakenFor) {
    const Read read(balancer("damping .25"));
    EXPECT_EQ(
        describe(read.findings, "f"),
        "f:2:1: warning: a loadBalancer without `mode` is taken for one of mode 2D; say which "
        "it is\n");
    EXPECT_EQ(read.configuration.compounds[0].equalizers.at(0).mode, SplitMode::TwoD);
    EXPECT_EQ(describe(Read(balancer("mode 2D damping .25")).findings, "f"), "");
}

TEST(EqcLoadBalancers, NameAllModesThatThereAre) {
    EXPECT_EQ(firstError(balancer("mode DPLX")),
              "2:16 'mode' is DPLX; expected 2D, DB, HORIZONTAL, VERTICAL, DPLEX, DFR or DDS");
    for (const auto& [mode, kind] : {std::pair{"DB", EqualizerKind::Load},
                                     {"DPLEX", EqualizerKind::Framerate},
                                     {"DFR", EqualizerKind::Dfr},
                                     {"DDS", EqualizerKind::Monitor}})
        EXPECT_EQ(Read(balancer(std::string("mode ") + mode))
                      .configuration.compounds[0]
                      .equalizers.at(0)
                      .kind,
                  kind);
}

}  // namespace
}  // namespace eyrie::config
