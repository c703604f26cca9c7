// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/resolved.h"
#include "coordinator/config/state_message.h"
#include "coordinator/config/upgrade.h"
#include "eyrie/v1/configuration.pb.h"
#include "tests/coordinator/random_configuration.h"

namespace eyrie::config {
namespace {

using testing::HasSubstr;

constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    return {std::istreambuf_iterator<char>(in), {}};
}

/// What is found in this JSON, one after another.
std::string foundIn(const std::string& json) {
    Findings findings;
    const Configuration read = readJson(json, findings);
    if (!findings.hasErrors())
        resolve(read, findings);
    return describe(findings, "f");
}

/// Compounds within each other.
Configuration nested(std::size_t depth) {
    Configuration configuration;
    configuration.observers.emplace_back();  // a text without gets one
    std::vector<Compound>* children = &configuration.compounds;
    for (std::size_t i = 0; i < depth; ++i) children = &children->emplace_back().children;
    return configuration;
}

RC_GTEST_PROP(ConfigurationForms, LoseNothingOfAnyConfigurationAsMessageJsonAndText,
              (std::uint32_t seed)) {
    const Configuration configuration = RandomConfiguration(seed).make();
    Findings findings;
    const Configuration read = fromMessage(toMessage(configuration), findings);
    RC_LOG() << "as text:\n" << writeEqc(configuration) << "read:\n" << writeEqc(read);
    RC_ASSERT(read == configuration);
    RC_ASSERT(readStatements(parseEqc(writeEqc(configuration), findings), findings) ==
              configuration);
    Configuration newest = configuration;
    newest.version = kNewestVersion;
    upgrade(newest);
    const std::string json = writeJson(newest);
    RC_ASSERT(readJson(json, findings) == newest);
    RC_ASSERT(writeJson(readJson(json, findings)) == json);
    RC_ASSERT(readEqc(writeEqc(newest), findings) == newest);
    RC_ASSERT(!findings.hasErrors());
}

/// As conversions of files have them that were of 1.0, and were edited since.
TEST(ConfigurationForms, OfJsonMeanWhatTheirTextMeans) {
    for (
        const char* const json :
        {R"({"version": "1.0", "nodes": [{"pipes": [{"windows": [{"channels": [{"name": "a"}]}]}]}],
              "layouts": [{"views": [{"mode": "VIEW_MODE_MONO"}]}],
              "canvases": [{"layouts": [{"index": 0}], "segments": [{"channel": {"name": "a"}}]}],
              "compounds": [{"channel": {"destination": {}}, "eye": {"left": true, "right": true}}]})",
         R"({"nodes": [{"pipes": [{"windows": [{"channels": [{"name": "a"}]}]}]}],
              "compounds": [{"channel": {"name": "a"}}]})"}) {
        Findings findings;
        Configuration read = readJson(json, findings);
        ASSERT_FALSE(findings.hasErrors()) << describe(findings, "f");
        EXPECT_EQ(read.observers.size(), 1U);
        EXPECT_EQ(read.canvases.size(), 1U);
        EXPECT_FALSE(read.layouts.at(0).views.at(0).isStereo);
        read.version = kNewestVersion;
        EXPECT_EQ(readEqc(writeEqc(read), findings), read);
    }
}

TEST(ConfigurationForms, OfEveryFileOfEqualizersAreReadAsTheFile) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.path().extension() != ".eqc")
            continue;
        Findings findings;
        const Configuration read = readEqc(contents(entry.path()), findings);
        EXPECT_EQ(readJson(writeJson(read), findings), read) << entry.path();
        EXPECT_EQ(readEqc(writeEqc(read), findings), read) << entry.path();
        EXPECT_FALSE(findings.hasErrors()) << describe(findings, entry.path().string());
        ++files;
    }
    EXPECT_EQ(files, 51U);
}

TEST(ConfigurationForms, HoldCompoundsAsDeepAsTextMayBe) {
    for (const std::size_t depth : {kMostNesting - 2, kMostNesting - 1}) {
        const Configuration deep = nested(depth);
        const bool isFine = depth == kMostNesting - 2;
        Findings ofText;
        Findings ofJson;
        EXPECT_TRUE(readEqc(writeEqc(deep), ofText) == deep || !isFine);
        EXPECT_TRUE(readJson(writeJson(deep), ofJson) == deep || !isFine);
        EXPECT_EQ(describe(ofText, "f").find("more than 40 blocks") == std::string::npos, isFine);
        EXPECT_EQ(describe(ofJson, "f").find("more than 40 blocks") == std::string::npos, isFine);
    }
}

TEST(ConfigurationJson, IsWrittenAsPeopleWouldWriteIt) {
    Findings findings;
    EXPECT_EQ(writeJson(readStatements(
                  parseEqc("config { node { name \"n\" pipe { device 0 window {"
                           " attributes { planes_depth 24 hint_drawable FBO }"
                           " channel { name \"c [ 1, 2 ]\" viewport [ 0 0 .5 1 ] } } } }"
                           " compound { channel \"c [ 1, 2 ]\" load_equalizer { mode DB } } }",
                           findings),
                  findings)),
              R"({
 "nodes": [
  {
   "name": "n",
   "pipes": [
    {
     "device": 0,
     "windows": [
      {
       "attributes": [
        {
         "name": "planes_depth",
         "number": 24
        },
        {
         "name": "hint_drawable",
         "words": {
          "words": [
           "FBO"
          ]
         }
        }
       ],
       "channels": [
        {
         "name": "c [ 1, 2 ]",
         "viewport": [0, 0, 0.5, 1]
        }
       ]
      }
     ]
    }
   ]
  }
 ],
 "compounds": [
  {
   "channel": {
    "name": "c [ 1, 2 ]"
   },
   "equalizers": [
    {
     "load": {
      "mode": "SPLIT_MODE_DB"
     }
    }
   ]
  }
 ]
}
)");
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "f");
}

TEST(ConfigurationJson, IsRefusedByFieldAsTextIsByLine) {
    EXPECT_EQ(
        foundIn(
            R"({"version": "2.0", "latency": -1, "nodes": [{"pipes": [{"device": -1}, {"windows":
                    [{"viewport": [0, 0, 1]}]}]}], "observers": [{"eyeLeft": [1, "NaN", 0]}],
                    "layouts": [{"views": [{"observer": {"name": "x"}, "mode": 7}]}],
                    "canvases": [{"segments": [{"channel": {"position": {"node": 3}}}]}]})"),
        "f:version: error: the file is of version 2.0; 1.0, 1.1 and 1.2 are read\n"
        "f:latency: error: 'latency' is -1; expected a whole number from 0 to 1000\n"
        "f:nodes[0].pipes[0].device: error: 'device' is -1; expected a whole number from 0 to "
        "1000000000\n"
        "f:nodes[0].pipes[1].windows[0].viewport: error: 'viewport' is [ 0 0 1 ]; expected "
        "[ x y width height ]\n"
        "f:observers[0].eyeLeft: error: 'eye_left' is [ 1 nan 0 ]; expected 3 numbers in [ ]\n"
        "f:layouts[0].views[0].mode: error: 'mode' is 7; expected MONO or STEREO\n"
        "f:layouts[0].views[0].observer: error: no observer named \"x\" is defined before this\n"
        "f:canvases[0].segments[0].channel.node: error: no node 3: 1 are defined before this\n");
}

TEST(ConfigurationJson, IsRefusedWhereItContradictsItself) {
    const auto compound = [](const std::string& fields) {
        return foundIn(R"({"nodes": [{"pipes": [{"windows": [{"channels": [{"name": "a"}]}]}]}],
                           "layouts": [{"views": [{}]}], "canvases": [{"layouts": [{"index": 0}],
                           "segments": [{"channel": {"name": "a"}}]}], "compounds": [{)" +
                       fields + "}]}");
    };
    EXPECT_EQ(compound(R"("channel": {"destination": {}})"), "");
    EXPECT_THAT(compound(R"("range": [0.5, 0.2])"), HasSubstr("compounds[0].range: error"));
    EXPECT_THAT(compound(R"("channel": {})"),
                HasSubstr("compounds[0].channel: error: it has no value"));
    EXPECT_THAT(compound(R"("equalizers": [{}])"),
                HasSubstr("equalizers[0]: error: it has no value"));
    EXPECT_THAT(compound(R"("period": 2, "phase": 2)"), HasSubstr("compounds[0]: error: phase 2"));
    EXPECT_THAT(compound(R"("name": "\"")"), HasSubstr("compounds[0].name: error"));
    EXPECT_THAT(compound(R"("wall": {"bottomLeft": [0, 0, 0], "topLeft": [0, 0, 0]})"),
                HasSubstr("compounds[0].wall: error: the wall's corners"));
    EXPECT_THAT(compound(R"("rnage": [0, 1])"), HasSubstr("no JSON of a configuration"));
    EXPECT_THAT(compound(R"("rnage": [0, 1])"), HasSubstr("rnage"));
    EXPECT_THAT(compound(R"("period": "x")"), HasSubstr("compounds[0]"));
    EXPECT_THAT(foundIn("{"), HasSubstr("no JSON of a configuration"));
}

TEST(ConfigurationJson, IsRefusedWhereItIsHuge) {
    EXPECT_THAT(foundIn(std::string(kLongestText + 1, ' ')), HasSubstr("at most"));
    std::string nodes = R"({"nodes": [{})";
    for (std::size_t i = 0; i < kMostStatements; ++i) nodes += ",{}";
    EXPECT_THAT(foundIn(nodes + "]}"), HasSubstr("more than 200000 statements"));
    std::string deep;
    for (int i = 0; i < 10'000; ++i) deep += R"({"compounds":[)";
    EXPECT_THAT(foundIn(deep), HasSubstr("error"));
}

TEST(ConfigurationJson, CutOffOrChangedAnywhereCrashesNothing) {
    Findings findings;
    const std::string whole =
        writeJson(readEqc(contents(std::filesystem::path(kFolder) / "test.eqc"), findings));
    std::mt19937 random(11);
    for (int i = 0; i < 200; ++i) {
        std::string text = whole.substr(0, i % 4 == 0 ? random() % whole.size() : whole.size());
        for (int flips = 0; flips < 3 && !text.empty(); ++flips)
            text[random() % text.size()] = static_cast<char>(' ' + random() % 95);
        foundIn(text);
    }
    SUCCEED();
}

TEST(ConfigurationStateMessage, BringsBackTheStateThatItIsOf) {
    Findings findings;
    const Configuration configuration =
        readEqc(contents(std::filesystem::path(kFolder) / "4-window.all.eqc"), findings);
    const ConfigurationState initial = initialState(configuration);
    ConfigurationState state = initial;
    state.layouts[0] = std::nullopt;
    state.equalizers[0].isOn = false;
    state.equalizers[1].isFrozen = true;
    state.equalizers[0].damping = .25;
    state.heads[0][3] = fabric::Vec4(1, 2, 3, 1);
    state.observers[0] = {.07, 2.5, FocusMode::RelativeToObserver};
    state.views[1][0] = {true, StereoMode::Passive, 2, Wall{}};
    state.views[2][0].surface = Surface{};
    state.views[3][0].surface = Projection{};
    ConfigurationState changed = initial;
    const absl::Status status = change(toMessage(configuration, state), configuration, changed);
    EXPECT_TRUE(status.ok()) << status.ToString();
    EXPECT_EQ(changed, state);

    EqualizerTuning settings;
    settings.mode = SplitMode::Vertical;
    settings.boundaryPixels = fabric::Vec2(2, 3);
    settings.boundaryRange = .5;
    settings.resistancePixels = fabric::Vec2(4, 5);
    settings.resistanceRange = .125;
    settings.assembleOnlyLimit = 2;
    const Configuration balanced = readEqc("config { compound { load_equalizer {} } }", findings);
    state = changed = initialState(balanced);
    state.equalizers[0] = settings;
    EXPECT_TRUE(change(toMessage(balanced, state), balanced, changed).ok());
    EXPECT_EQ(changed, state);
}

TEST(ConfigurationStateMessage, NamesTheEqualizerOfWhatIsWrong) {
    Findings findings;
    const Configuration balanced =
        readEqc("config { compound { load_equalizer {} load_equalizer {} } }", findings);
    const auto wrong = [&](const auto& setIn) {
        v1::ConfigurationState message;
        message.add_equalizers()->set_equalizer(1);
        setIn(*message.mutable_equalizers(0));
        ConfigurationState state = initialState(balanced);
        return std::string(change(message, balanced, state).message());
    };
    EXPECT_EQ(wrong([](v1::EqualizerTuning& tuning) { tuning.add_boundary(3); }),
              "equalizers[0]: equalizer 1: boundary has 1 numbers; it must have 2");
    EXPECT_EQ(wrong([](v1::EqualizerTuning& tuning) { tuning.set_damping(3); }),
              "equalizers[0]: equalizer 1: damping is 3; it must be from 0 to 1");
}

TEST(ConfigurationStateMessage, WithAnErrorChangesNothing) {
    Findings findings;
    const Configuration configuration = readEqc(
        "config { observer { name \"me\" } layout { name \"x\" view {} } layout { name \"y\" }"
        " canvas { name \"c\" layout \"x\" layout \"y\" } }",
        findings);
    const ConfigurationState state = initialState(configuration);
    ConfigurationState changed = state;
    v1::ConfigurationState wrong = toMessage(configuration, state);
    wrong.mutable_layouts(0)->set_layout("y");
    EXPECT_TRUE(change(wrong, configuration, changed).ok());
    EXPECT_EQ(changed.layouts[0], 1U);
    changed = state;
    wrong.mutable_heads(0)->add_room_from_head(0);
    EXPECT_FALSE(change(wrong, configuration, changed).ok());
    EXPECT_EQ(changed, state);
    v1::ConfigurationState unseen = toMessage(configuration, state);
    unseen.mutable_views(0)->set_model_unit(1e10);
    EXPECT_THAT(
        std::string(change(unseen, configuration, changed).message()),
        testing::StartsWith("views[0]: the model unit is 10000000000; it must be from 1e-09"));
    for (const char* const setting : {"base", "distance", "far", "mode"}) {
        v1::ConfigurationState blind = toMessage(configuration, state);
        v1::ObserverSetting& observer = *blind.mutable_observers(0);
        if (setting == std::string("base"))
            observer.set_eye_base(-.1);
        else if (setting == std::string("distance"))
            observer.set_focus_distance(0);
        else if (setting == std::string("far"))
            observer.set_focus_distance(1e300);
        else
            observer.set_focus_mode(static_cast<v1::FocusMode>(4));
        EXPECT_FALSE(change(blind, configuration, changed).ok()) << setting;
        EXPECT_EQ(changed, state);
    }
}

}  // namespace
}  // namespace eyrie::config
