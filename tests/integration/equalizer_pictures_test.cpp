// SPDX-License-Identifier: Apache-2.0
// Equalizers at work on real renderer processes: what they change may cost time, but every picture
// is the one that its configuration stands for.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_reader.h"
#include "coordinator/frame/active_configuration.h"
#include "coordinator/frame/configuration_access.h"
#include "tests/support/different_pixels.h"
#include "tests/support/local_pictures.h"
#include "tests/support/program.h"
#include "tests/support/renderer_farm.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::ActiveConfiguration;
using coordinator::FrameRequest;
using fabric::Image;
using std::chrono::seconds;

class EqualizerPictures : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "60000", "--seed", "3", "-o", folder_->path("ball.ply")}));
        ASSERT_TRUE(test::succeeded(
            {"import", "mesh", folder_->path("ball.ply"), "-o", folder_->path("ball.eym")}));
        scene_.objects.push_back({.name = "ball", .path = folder_->path("ball.eym")});
        here_ = test::LocalPictures::open(scene_).value();
    }
    static void TearDownTestSuite() {
        here_.reset();
        folder_.reset();
        scene_ = {};
    }

    /// Two renderers that draw by the configuration of this text.
    void draw(const std::string& configuration) {
        config::Findings findings;
        const config::Configuration read = config::readEqc(configuration, findings);
        ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "test");
        farm_ = test::RendererFarm::start(EYRIE_BINARY, 2, {.configuration = read, .scene = scene_})
                    .value();
        ASSERT_TRUE(farm_->awaitAllReady(seconds(60))) << farm_->renderer(0).errors();
    }

    /// The ball from the front, somewhat to the left of the middle.
    static FrameRequest view(int width, int height) {
        FrameRequest view;
        view.camera.eye = {0.3, -4, 0.4};
        view.camera.target = {0.3, 0, 0};
        view.width = width;
        view.height = height;
        return view;
    }

    Image drawn(const FrameRequest& view) {
        const auto frame = farm_->frames().renderFrame(view);
        EXPECT_TRUE(frame.ok()) << frame.status();
        return frame.ok() ? frame->image : Image{};
    }

    coordinator::ConfigurationAccess& configuration() {
        return dynamic_cast<coordinator::ConfigurationAccess&>(farm_->frames());
    }
    equalizer::Report reportOf(std::size_t equalizer) {
        equalizer::Report report;
        EXPECT_TRUE(configuration()
                        .withConfiguration([&](ActiveConfiguration& active) {
                            report = active.equalizers().at(equalizer).report;
                            return absl::OkStatus();
                        })
                        .ok());
        return report;
    }

    /// What one renderer shows of a view that is `view.width` x `view.height`.
    static Image drawnHere(const FrameRequest& view) {
        fabric::ChannelTask task;
        task.pixelViewport = {0, 0, view.width, view.height};
        return here_->draw(view, task).value();
    }

    static inline std::unique_ptr<test::TemporaryFolder> folder_;
    static inline std::unique_ptr<test::LocalPictures> here_;
    static inline fabric::Scene scene_;
    std::unique_ptr<test::RendererFarm> farm_;
};

/// Two pipes with these windows, a layout of one view, and what stands after it.
std::string twoPipes(const std::string& first, const std::string& second, const std::string& rest) {
    return fmt::format(
        "server {{ config {{ appNode {{ pipe {{ {} }} pipe {{ {} }} }}\n"
        "layout {{ name \"one\" view {{ }} }}\n{} }} }}",
        first, second, rest);
}

std::string window(const std::string& channel, int width, int height) {
    return fmt::format("window {{ viewport [ 0 0 {} {} ] channel {{ name \"{}\" }} }} ", width,
                       height, channel);
}

fabric::Rgba at(const Image& image, int x, int y) {
    return image.colour[static_cast<std::size_t>(y * image.area.width + x)];
}

fabric::Rgba meanOfFour(const Image& image, int x, int y) {
    const auto of = [&](std::uint8_t fabric::Rgba::*channel) {
        return static_cast<std::uint8_t>((at(image, x, y).*channel + at(image, x + 1, y).*channel +
                                          at(image, x, y + 1).*channel +
                                          at(image, x + 1, y + 1).*channel + 2) /
                                         4);
    };
    return {of(&fabric::Rgba::r), of(&fabric::Rgba::g), of(&fabric::Rgba::b), of(&fabric::Rgba::a)};
}

/// No machine draws a million a second: as few pixels as it may, which here is a half each way.
TEST_F(EqualizerPictures, OfDynamicResolutionAreDrawnSmallerAndEnlarged) {
    draw(twoPipes(window("shown", 256, 256), window("drawn", 256, 256),
                  "canvas { layout 0 segment { channel \"shown\" } }\n"
                  "compound { channel ( segment 0 view 0 )\n"
                  "compound { channel \"drawn\" DFR_equalizer { framerate 1000000 }\n"
                  "outputframe { name \"f\" } } inputframe { name \"f\" } }"));
    const FrameRequest seen = view(256, 256);
    EXPECT_EQ(test::differentPixels(drawn(seen), drawnHere(seen)), 0U) << "before it has learned";
    FrameRequest moving = seen;
    moving.completeness = fabric::Completeness::Interactive;
    for (int frame = 0; frame < 50 && reportOf(0).zoom != .5; ++frame) drawn(moving);
    ASSERT_EQ(reportOf(0).zoom, .5);
    const Image enlarged = drawn(moving);
    const Image small = here_->draw(seen, fabric::Raster{128, 128, {0, 0}, {2, 2}}).value();
    ASSERT_EQ(enlarged.area, (fabric::PixelViewport{0, 0, 256, 256}));
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            ASSERT_EQ(at(enlarged, x, y), at(small, x / 2, y / 2)) << x << " " << y;
    EXPECT_GT(test::differentPixels(enlarged, drawnHere(seen)), 1000U);
    EXPECT_EQ(test::differentPixels(drawn(seen), drawnHere(seen)), 0U) << "what is to be complete";
}

/// The first monitor has half the wall's pixels each way, the second a quarter: whichever is asked
/// for gets what it shows.
TEST_F(EqualizerPictures, OfAMonitorAreThoseOfTheWallReducedWhereTheyBelong) {
    draw(
        twoPipes(window("left", 160, 120) + window("monitor", 160, 60) + window("small", 80, 30),
                 window("right", 160, 120),
                 "canvas { layout 0 segment { channel \"left\" viewport [ 0 0 .5 1 ] }\n"
                 "segment { channel \"right\" viewport [ .5 0 .5 1 ] } }\n"
                 "canvas { layout 0 segment { channel \"monitor\" } }\n"
                 "canvas { layout 0 segment { channel \"small\" } }\n"
                 "compound {\n"
                 "compound { channel ( canvas 0 segment 0 layout 0 view 0 ) outputframe { } }\n"
                 "compound { channel ( canvas 0 segment 1 layout 0 view 0 ) outputframe { } }\n"
                 "compound { channel ( canvas 1 segment 0 layout 0 view 0 ) monitor_equalizer { }\n"
                 "task [ CLEAR ASSEMBLE ] inputframe { name \"frame.left\" }\n"
                 "inputframe { name \"frame.right\" } }\n"
                 "compound { channel ( canvas 2 segment 0 layout 0 view 0 ) monitor_equalizer { }\n"
                 "task [ CLEAR ASSEMBLE ] inputframe { name \"frame.left\" }\n"
                 "inputframe { name \"frame.right\" } } }"));
    FrameRequest seen = view(160, 60);
    seen.shown = {coordinator::Shown{"1", "", {}, {}}};
    const Image wall = drawnHere(view(320, 120));
    const Image shown = drawn(seen);
    ASSERT_EQ(shown.area, (fabric::PixelViewport{0, 0, 160, 60}));
    std::size_t covered = 0;
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 160; ++x) {
            ASSERT_EQ(at(shown, x, y), meanOfFour(wall, 2 * x, 2 * y)) << x << " " << y;
            covered += at(shown, x, y) == at(shown, 0, 0) ? 0 : 1;
        }
    EXPECT_GT(covered, 100U) << "the ball is not in the picture";
    seen.width = 2 * 160;  // as large as the wall now: pixel by pixel
    seen.height = 2 * 60;
    EXPECT_EQ(test::differentPixels(drawn(seen), wall), 0U);
    seen.shown = {coordinator::Shown{"2", "", {}, {}}};
    EXPECT_EQ(test::differentPixels(drawn(seen), wall), 0U);
}

/// All of the ball is in the left one.
TEST_F(EqualizerPictures, OfAViewThatCostsMoreComeFromMorePipes) {
    draw(twoPipes(window("left", 160, 120) + window("first", 160, 120),
                  window("right", 160, 120) + window("second", 160, 120),
                  "canvas { layout 0 segment { channel \"left\" viewport [ 0 0 .5 1 ] }\n"
                  "segment { channel \"right\" viewport [ .5 0 .5 1 ] } }\n"
                  "compound { view_equalizer { }\n"
                  "compound { channel ( segment 0 view 0 ) load_equalizer { } compound { }\n"
                  "compound { channel \"second\" outputframe { name \"l\" } }\n"
                  "inputframe { name \"l\" } }\n"
                  "compound { channel ( segment 1 view 0 ) load_equalizer { } compound { }\n"
                  "compound { channel \"first\" outputframe { name \"r\" } }\n"
                  "inputframe { name \"r\" } } }"));
    FrameRequest seen = view(320, 120);
    seen.camera.eye.x = seen.camera.target.x = 1.5;
    seen.tauPixels = .25;
    const Image expected = drawnHere(seen);
    std::uint64_t planned = 1'000'000;
    // Compounds as written: 1 and its children 2 and 3 are the left segment's, 6 is the right's
    // share of the left one's pipe.
    const auto drawnBy = [&](std::size_t position) {
        std::int64_t pixels = 0;
        EXPECT_TRUE(configuration()
                        .withConfiguration([&](ActiveConfiguration& active) {
                            const auto plan = active.plan(seen, ++planned, {});
                            if (plan.ok())
                                for (const compound::PlannedDraw& each : plan->draws)
                                    if (each.compound == position)
                                        pixels += each.task.pixelViewport.area();
                            return plan.status();
                        })
                        .ok());
        return pixels;
    };
    bool isShared = false;
    for (int frame = 0; frame < 200 && !isShared; ++frame) {
        ASSERT_EQ(test::differentPixels(drawn(seen), expected), 0U) << "frame " << frame;
        isShared = drawnBy(3) > 0 && drawnBy(6) == 0;
    }
    EXPECT_TRUE(isShared) << "the right one's pipe never drew for the left one";
    EXPECT_EQ(test::differentPixels(drawn(seen), expected), 0U);
}

TEST_F(EqualizerPictures, OfATreeAreThoseOfOneChannelWhereverItCuts) {
    for (const char* mode : {"2D", "DB"}) {
        draw(
            twoPipes(window("shown", 160, 90), window("helper", 160, 90),
                     fmt::format("canvas {{ layout 0 segment {{ channel \"shown\" }} }}\n"
                                 "compound {{ channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ]\n"
                                 "tree_equalizer {{ mode {} }} compound {{ }}\n"
                                 "compound {{ channel \"helper\" outputframe {{ name \"f\" }} }}\n"
                                 "inputframe {{ name \"f\" }} }}",
                                 mode)));
        FrameRequest seen = view(160, 90);
        seen.camera.eye.x = seen.camera.target.x = 1;
        const Image expected = drawnHere(seen);
        for (int frame = 0; frame < 12; ++frame)
            EXPECT_EQ(test::differentPixels(drawn(seen), expected), 0U) << mode << frame;
    }
}

TEST_F(EqualizerPictures, OfPipesThatTakeTurnsAreInOrderWhileTheRateIsMeasured) {
    draw(twoPipes(window("shown", 160, 90) + window("first", 160, 90), window("second", 160, 90),
                  "canvas { layout 0 segment { channel \"shown\" } }\n"
                  "compound { channel ( segment 0 view 0 ) framerate_equalizer { }\n"
                  "compound { channel \"first\" period 2 phase 0 outputframe { name \"f\" } }\n"
                  "compound { channel \"second\" period 2 phase 1 outputframe { name \"f\" } }\n"
                  "inputframe { name \"f\" } }"));
    for (int frame = 0; frame < 12; ++frame) {
        FrameRequest seen = view(160, 90);
        seen.camera.eye.x += .2 * frame;
        EXPECT_EQ(test::differentPixels(drawn(seen), drawnHere(seen)), 0U) << frame;
    }
    EXPECT_GT(reportOf(0).framesPerSecond, 0);
}

}  // namespace
}  // namespace eyrie
