// SPDX-License-Identifier: Apache-2.0
// What is said of configurations that are wrong, or have no effect.
#include <set>
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
                HasSubstr("not before the wall"));
}

TEST(EqcWarnings, SayWhatHasNoEffect) {
    const Read read(withCompounds(
        "nonsense 5 compound { channel ( segment 0 view 0 ) inputframe { name \"x\" } }"));
    EXPECT_FALSE(read.findings.hasErrors());
    const std::string text = describe(read.findings, "f");
    EXPECT_THAT(text, HasSubstr("'nonsense' means nothing in a config"));
    EXPECT_THAT(text, HasSubstr("no outputframe of this compound tree is named \"x\""));
    EXPECT_THAT(describe(sample("1-pipe.eqc").findings, "f"),
                HasSubstr("on screen only: 'EQ_WINDOW_IATTR_HINT_FULLSCREEN'"));
}

TEST(EqcWarnings, SayHowManyFramesAreUnderWayAtMost) {
    EXPECT_EQ(describe(Read("config { latency 7 }").findings, "f"), "");
    EXPECT_EQ(describe(Read("config { latency 8 }").findings, "f"),
              "f:1:10: warning: 'latency' is 8; no more than 8 frames are under way at once, as "
              "with a latency of 7\n");
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

TEST(EqcWarnings, NameTheKeywordThatIsNearlyMeant) {
    const auto found = [](const std::string& text) { return describe(Read(text).findings, "f"); };
    EXPECT_EQ(found("config { node { pipe {}\nhosts \"x\" } }"),
              "f:2:1: warning: 'hosts' means nothing in a node and is left out, did you mean "
              "'host'?\n");
    EXPECT_THAT(found(withCompounds("compound { channel ( segment 0 view 0 ) load_equaliser {} }")),
                HasSubstr("'load_equaliser' means nothing in a compound and is left out, did you "
                          "mean 'load_equalizer'?\n"));
    EXPECT_EQ(found("config { nonsense 1 }"),
              "f:1:10: warning: 'nonsense' means nothing in a config and is left out\n");
}

TEST(EqcWarnings, NameTheSettingThatIsMeantWhereCaseOrTypeIsAnother) {
    const auto found = [](const std::string& global, const std::string& own) {
        return describe(Read("global { " + global + " }\nserver { config {\nattributes { " + own +
                             " } appNode { pipe { window { channel { name \"a\" } } } } layout { "
                             "view {} } canvas { layout 0 segment { channel \"a\" } } } }")
                            .findings,
                        "f");
    };
    const auto isNone = [](const std::string& written) {
        return "f:1:10: warning: '" + written +
               "' is no global setting and is left out; 'EQ_CONFIG_FATTR_EYE_BASE' is one\n";
    };
    EXPECT_EQ(found("EQ_CONFIG_FATTR_EYE_BASE .2", "eye_base .2"), "");
    for (const std::string written :
         {"EQ_CONFIG_IATTR_EYE_BASE", "EQ_CONFIG_FATTR_eye_base", "EQ_CONFIG_iATTR_EYE_BASE"})
        EXPECT_EQ(found(written + " .2", ""), isNone(written));
    EXPECT_EQ(found("EQ_CONFIG_FATTR_EYE 1", ""),
              "f:1:10: warning: 'EQ_CONFIG_FATTR_EYE' is no global setting and is left out\n");
    EXPECT_EQ(
        found("", "EYE_BASE .2"),
        "f:3:14: warning: 'EYE_BASE' is no setting here and is left out; 'eye_base' is one\n");
    EXPECT_EQ(found("", "hint_stereo ON"),
              "f:3:14: warning: 'hint_stereo' is no setting here and is left out\n");
}

/// Names of Equalizer's lexer that are not of small letters alone.
TEST(EqcWarnings, KnowSettingsAsEqualizerSpellsThem) {
    const auto found = [](const std::string& text) { return describe(Read(text).findings, "f"); };
    EXPECT_EQ(found("config { appNode { pipe { attributes { hint_cuda_GL_interop ON } window { "
                    "channel { name \"a\" } } } } layout { view { attributes { DisplayCluster "
                    "\"x\" } } } canvas { layout 0 segment { channel \"a\" swapbarrier { NV_group "
                    "1 NV_barrier 1 } } } compound { channel ( segment 0 view 0 ) attributes { "
                    "update_FOV ON } } }")
                  .find("warning"),
              std::string::npos);
}

/// As older versions wrote it.
TEST(EqcWarnings, KnowAViewsDisplayClusterBesideItsAttributes) {
    const Read read("config { layout { view { DisplayCluster \"x\" } } }");
    EXPECT_THAT(describe(read.findings, "f"),
                HasSubstr("f:1:26: on screen only: 'DisplayCluster' has no effect here"));
    const Attributes& settings = read.configuration.layouts[0].views[0].attributes;
    ASSERT_EQ(settings.size(), 1U);
    EXPECT_EQ(settings[0].name, "DisplayCluster");
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
            Read(withCompounds("\ncompound { channel ( segment 0 view 0 ) " + compound + " }"))
                .findings,
            "f");
    };
    const std::string background =
        "f:2:1: warning: no compound draws or assembles what the view shows, that of the eye "
        "CYCLOP: it is background\n";
    EXPECT_EQ(found("eye [ LEFT RIGHT ]"), background);
    EXPECT_EQ(found("compound { eye [ LEFT ] } compound { eye [ RIGHT ] }"), background);
    EXPECT_EQ(found("task [ CLEAR ]"), background);
    EXPECT_EQ(found("eye [ LEFT CYCLOP ]"), "");
    EXPECT_EQ(found("compound { eye [ LEFT ] } compound { eye [ CYCLOP ] }"), "");
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

TEST(EqcWarnings, SayWherePartsOfTheDataComeWithoutDepth) {
    const auto found = [](const std::string& above, const std::string& part,
                          const std::string& frame) {
        return describe(Read(withCompounds("compound { channel ( segment 0 view 0 ) " + above +
                                           " compound {} compound { channel \"b\" " + part +
                                           "\noutputframe { name \"f\" " + frame +
                                           " } } inputframe { name \"f\" } }"))
                            .findings,
                        "f");
    };
    const std::string noDepth =
        "f:2:1: warning: the outputframe has a part of the data and no DEPTH, so it covers what is "
        "nearer; buffer [ COLOR DEPTH ] compares them\n";
    EXPECT_EQ(found("", "range [ .5 1 ]", ""), noDepth);
    EXPECT_EQ(found("buffer [ COLOR DEPTH ]", "range [ .5 1 ]", "buffer [ COLOR ]"), noDepth);
    EXPECT_EQ(found("load_equalizer { mode DB }", "", ""), noDepth);
    EXPECT_EQ(found("tile_equalizer { size .1 }", "", ""), noDepth);
    EXPECT_EQ(found("buffer [ COLOR DEPTH ] load_equalizer { mode DB }", "", ""), "");
    EXPECT_EQ(found("load_equalizer { mode 2D }", "", ""), "");
    EXPECT_EQ(found("tile_equalizer {}", "", ""), "");
    EXPECT_EQ(found("", "range [ .5 1 ]", "buffer [ COLOR DEPTH ]"), "");
}

TEST(EqcWarnings, SayWhichEqualizersHaveNoPictureToShareOut) {
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

TEST(EqcWarnings, SayWhereAnEqualizerTearsPicturesOfSeveralEyesOrPhases) {
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
                              "children draw for other eyes or in other frames"));
        EXPECT_EQ(found(equalizer, "", ""), "");
        EXPECT_EQ(found(equalizer, "", "task [ CLEAR ] period 2 phase 1"), "");
    }
    EXPECT_EQ(found("framerate_equalizer", "period 2 phase 0", "period 2 phase 1"), "");
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

}  // namespace
}  // namespace eyrie::config
