// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/default_config.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/pixels.h"
#include "coordinator/config/resolved.h"
#include "coordinator/config/state.h"

namespace eyrie::config {
namespace {

using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;

std::vector<RendererFacts> renderers(std::size_t count) {
    std::vector<RendererFacts> facts;
    for (std::size_t i = 0; i < count; ++i)
        facts.push_back({"renderer", "host", "a \"device\"", static_cast<int>(1 + i % 7)});
    return facts;
}

std::string messageOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// Of the layout, its resolved compounds.
std::vector<ResolvedCompound> of(const ResolvedConfiguration& resolved, std::size_t layout) {
    std::vector<ResolvedCompound> found;
    for (const ResolvedCompound& compound : resolved.compounds)
        if (resolved.destinations[*compound.destination].index.layout == layout)
            found.push_back(compound);
    return found;
}

std::size_t layoutNamed(const Configuration& configuration, const std::string& name) {
    const auto found = std::ranges::find(configuration.layouts, name, &Layout::name);
    return static_cast<std::size_t>(found - configuration.layouts.begin());
}

TEST(DefaultConfiguration, IsWithoutFindingsOfAnyNumberOfRenderers) {
    for (const std::size_t count : {1, 2, 3, 4, 5, 7, 9, 16, 17, 24, 60, 255, 256}) {
        const Configuration made = defaultConfiguration(renderers(count));
        Findings findings;
        const Configuration read = readEqc(writeEqc(made), findings);
        EXPECT_EQ(read, made) << count;
        resolve(read, findings);
        EXPECT_EQ(describe(findings, "default"), "") << count;
        EXPECT_EQ(made.nodes.size(), count);
    }
    EXPECT_EQ(defaultConfiguration({}), Configuration{});
}

TEST(DefaultConfiguration, HasTheLayoutsThatItsRenderersAllow) {
    const auto names = [](std::size_t count) {
        return layoutNames(defaultConfiguration(renderers(count)));
    };
    EXPECT_THAT(names(1), ElementsAre("Simple"));
    EXPECT_THAT(names(3), ElementsAre("2D", "Simple", "DB static", "DB dynamic", "direct-send"));
    EXPECT_THAT(names(4),
                ElementsAre("2D", "Simple", "DB static", "DB dynamic", "direct-send", "DB-2D"));
    EXPECT_THAT(names(256), ElementsAre("2D", "Simple", "DB static", "DB dynamic", "DB-2D"));
}

TEST(DefaultConfiguration, DrawsEveryPixelOfEveryRangeOnceInEachLayout) {
    for (const std::size_t count : {1, 2, 3, 5, 8, 16, 61, 256}) {
        const Configuration made = defaultConfiguration(renderers(count));
        Findings findings;
        const ResolvedConfiguration resolved = resolve(made, findings);
        for (std::size_t layout = 0; layout < made.layouts.size(); ++layout) {
            double drawn = 0;
            std::vector<bool> works(count, false);
            for (const ResolvedCompound& compound : of(resolved, layout)) {
                if (!compound.tasks.draw)
                    continue;
                drawn += compound.pixelViewport.width * compound.pixelViewport.height *
                         (compound.range.end - compound.range.begin);
                works[compound.channel->node] = true;
            }
            const std::string name = made.layouts[layout].name;
            EXPECT_NEAR(drawn, 1920 * 1080, 1e-6) << name << " of " << count;
            EXPECT_TRUE(name == "Simple" || std::ranges::all_of(works, std::identity{}))
                << name << " of " << count;
        }
    }
}

TEST(DefaultConfiguration, CutsThePictureIntoPartsThatMeetWithoutOverlap) {
    const Configuration made = defaultConfiguration(renderers(61));
    for (const fabric::PixelViewport whole :
         {fabric::PixelViewport{0, 0, 1921, 1083}, fabric::PixelViewport{0, 0, 641, 367}}) {
        std::vector<int> times(static_cast<std::size_t>(whole.width * whole.height), 0);
        for (const Compound& child : made.compounds[0].children) {
            const fabric::PixelViewport area = part(whole, child.viewport);
            for (int y = area.y; y < area.y + area.height; ++y)
                for (int x = area.x; x < area.x + area.width; ++x)
                    ++times[static_cast<std::size_t>(y * whole.width + x)];
        }
        EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(times.size()));
    }
}

TEST(DefaultConfiguration, MergesEachStripOfDirectSendFromAllRanges) {
    const std::size_t count = 5;
    const Configuration made = defaultConfiguration(renderers(count));
    Findings findings;
    const ResolvedConfiguration resolved = resolve(made, findings);
    std::size_t strips = 0;
    std::size_t results = 0;
    for (const ResolvedCompound& compound : of(resolved, layoutNamed(made, "direct-send")))
        for (const ResolvedFrame& frame : compound.outputFrames) {
            EXPECT_TRUE(frame.isMatched);
            (frame.name.starts_with("strip") ? strips : results) += 1;
        }
    EXPECT_EQ(strips, count * (count - 1));
    EXPECT_EQ(results, count - 1);
}

TEST(ConfigurationState, ShowsTheLayoutThatIsSwitchedTo) {
    const Configuration made = defaultConfiguration(renderers(4));
    ConfigurationState state = initialState(made);
    EXPECT_EQ(state.layouts.at(0), 0U);
    EXPECT_TRUE(switchLayout(made, state, "0", "DB-2D").ok());
    EXPECT_EQ(state.layouts.at(0), 5U);
    EXPECT_TRUE(switchLayout(made, state, "0", "1").ok());
    EXPECT_EQ(state.layouts.at(0), 1U);
    EXPECT_TRUE(switchLayout(made, state, "0", "OFF").ok());
    EXPECT_EQ(state.layouts.at(0), std::nullopt);
    const ConfigurationState before = state;
    EXPECT_EQ(messageOf(switchLayout(made, state, "0", "3D")),
              "canvas \"0\" has no layout called \"3D\"; there are \"2D\", \"Simple\", \"DB "
              "static\", \"DB dynamic\", \"direct-send\", \"DB-2D\", OFF");
    EXPECT_EQ(messageOf(switchLayout(made, state, "wall", "2D")),
              "no canvas is called \"wall\"; there are \"0\"");
    EXPECT_EQ(state, before);
}

TEST(ConfigurationState, TunesEqualizersAsFarAsAFileMay) {
    const Configuration made = defaultConfiguration(renderers(2));
    ConfigurationState state = initialState(made);
    ASSERT_EQ(state.equalizers.size(), 2U);
    EqualizerTuning settings;
    settings.damping = .25;
    settings.boundaryPixels = fabric::Vec2(8, 8);
    EXPECT_TRUE(tuneEqualizer(made, state, 1, settings).ok());
    const Configuration tuned = applied(made, state);
    EXPECT_EQ(equalizersOf(tuned)[0].equalizer->damping, .5);
    EXPECT_EQ(equalizersOf(tuned)[1].equalizer->damping, .25);
    EXPECT_EQ(equalizersOf(tuned)[1].equalizer->boundaryPixels, fabric::Vec2(8, 8));
    EqualizerTuning second;
    second.damping = .75;
    EXPECT_TRUE(tuneEqualizer(made, state, 1, second).ok());
    EXPECT_EQ(state.equalizers[1].damping, .75);
    EXPECT_EQ(state.equalizers[1].boundaryPixels, fabric::Vec2(8, 8)) << "what is absent stays";
    const ConfigurationState before = state;
    settings.damping = 2;
    EXPECT_THAT(messageOf(tuneEqualizer(made, state, 1, settings)), HasSubstr("from 0 to 1"));
    EqualizerTuning foreign;
    foreign.framerate = 30;
    EXPECT_THAT(messageOf(tuneEqualizer(made, state, 1, foreign)),
                Eq("equalizer 1: framerate is a setting of a DFR_equalizer, and this is a "
                   "load_equalizer; leave it out"));
    foreign = {};
    foreign.tileSize = fabric::Vec2(8, 8);
    EXPECT_THAT(messageOf(tuneEqualizer(made, state, 0, foreign)),
                HasSubstr("equalizer 0: tileSize is a setting of a tile_equalizer"));
    EXPECT_THAT(messageOf(tuneEqualizer(made, state, 2, {})), HasSubstr("there are 2"));
    EXPECT_EQ(state, before);
}

TEST(ConfigurationState, MovesHeadsRigidlyOnly) {
    const Configuration made = defaultConfiguration(renderers(1));
    ConfigurationState state = initialState(made);
    const fabric::Mat4 turned =
        glm::rotate(glm::translate(fabric::Mat4(1), {.1, 1.7, 0}), .3, fabric::Vec3(0, 1, 0));
    EXPECT_TRUE(setHead(made, state, "0", turned).ok());
    EXPECT_EQ(state.heads.at(0), turned);
    for (const fabric::Mat4& wrong :
         {fabric::Mat4(0), glm::scale(turned, {2, 1, 1}), glm::scale(turned, {-1, 1, 1}),
          fabric::Mat4(std::nan("")), glm::translate(turned, {1e9, 0, 0})})
        EXPECT_THAT(messageOf(setHead(made, state, "0", wrong)), HasSubstr("rotation and place"));
    EXPECT_THAT(messageOf(setHead(made, state, "me", turned)), HasSubstr("there are \"0\""));
    EXPECT_EQ(state.heads.at(0), turned);
}

TEST(ConfigurationState, ShowsViewsAsTheyAreSet) {
    const Configuration made = defaultConfiguration(renderers(2));
    ConfigurationState state = initialState(made);
    ViewState settings;
    settings.isStereo = true;
    settings.stereoMode = StereoMode::Anaglyph;
    settings.surface = Wall{};
    EXPECT_TRUE(setView(made, state, "Simple", "0", settings).ok());
    const Configuration shown = applied(made, state);
    EXPECT_TRUE(shown.layouts[1].views[0].isStereo);
    EXPECT_FALSE(shown.layouts[0].views[0].isStereo);
    EXPECT_EQ(shown.layouts[1].views[0].stereoMode, StereoMode::Anaglyph);
    Findings findings;
    EXPECT_EQ(of(resolve(shown, findings), 1).front().sights.size(), 2U);
    settings.surface = Wall{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, false};
    EXPECT_THAT(messageOf(setView(made, state, "Simple", "0", settings)), HasSubstr("corners"));
    EXPECT_THAT(messageOf(setView(made, state, "None", "0", {})), HasSubstr("\"DB static\""));
}

}  // namespace
}  // namespace eyrie::config
