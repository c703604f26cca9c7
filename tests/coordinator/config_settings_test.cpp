// SPDX-License-Identifier: Apache-2.0
// What is said of settings that have no effect here, or are spelt otherwise.
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eqc_samples.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

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
    EXPECT_EQ(
        found("EQ_CONFIG_FATTR_EYE 1", ""),
        "f:1:10: warning: 'EQ_CONFIG_FATTR_EYE' is no global setting and is left out, did you "
        "mean 'EQ_CONFIG_FATTR_EYE_BASE'?\n");
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
          "hint_stereo OFF", "hint_stereo ON", "hint_opengl_major 3", "hint_core_profile ON",
          "hint_statistics ON"})
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

TEST(EqcText, TakesAnaglyphInSmallLetters) {
    const auto modeOf = [](const std::string& word) {
        return Read(withCompounds(
                        "compound { channel ( segment 0 view 0 ) attributes { stereo_mode " + word +
                        " } }"))
            .configuration.compounds.at(0)
            .stereoMode;
    };
    EXPECT_EQ(modeOf("anaglyph"), StereoMode::Anaglyph);
    EXPECT_EQ(modeOf("ANAGLYPH"), StereoMode::Anaglyph);
    const Read global("global { EQ_COMPOUND_IATTR_STEREO_MODE anaglyph } " + withCompounds(""));
    EXPECT_EQ(describe(global.findings, "f"), "");
    EXPECT_THAT(firstError(withCompounds("compound { attributes { stereo_mode quad } }")),
                HasSubstr("'stereo_mode' is quad; expected"));
}

}  // namespace
}  // namespace eyrie::config
