// SPDX-License-Identifier: Apache-2.0
// Configurations of Equalizer, drawn by real renderer processes: each picture must be that of one
// channel.
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/identifier.h"
#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Case {
    const char* file;
    std::vector<std::string> shown = {};
    /// Interleaved pixels are rastered in pictures of their own, whose vertices snap elsewhere: 1
    /// of 57,600 on llvmpipe, 56 on an H100.
    std::size_t mayDiffer = 0;
};

/// Six walls of four pipes around the head, each seen by two eyes.
std::string cave() {
    constexpr std::array<std::array<const char*, 3>, 6> kCorners = {
        {{"-1 -1 -1", "1 -1 -1", "-1 1 -1"},
         {"1 -1 -1", "1 -1 1", "1 1 -1"},
         {"1 -1 1", "-1 -1 1", "1 1 1"},
         {"-1 -1 1", "-1 -1 -1", "-1 1 1"},
         {"-1 -1 1", "1 -1 1", "-1 -1 -1"},
         {"-1 1 -1", "1 1 -1", "-1 1 1"}}};
    std::string pipes;
    for (int pipe = 0; pipe < 4; ++pipe) {
        pipes += "pipe { ";
        for (int wall = pipe; wall < 6; wall += 4)
            pipes +=
                fmt::format("window {{ viewport [ 0 0 96 96 ] channel {{ name \"{}\" }} }} ", wall);
        pipes += "} ";
    }
    std::string canvases;
    for (std::size_t i = 0; i < kCorners.size(); ++i)
        canvases += fmt::format(
            "canvas {{ layout 0 wall {{ bottom_left [ {} ] bottom_right [ {} ] top_left [ {} ] }} "
            "segment {{ channel \"{}\" }} }} ",
            kCorners[i][0], kCorners[i][1], kCorners[i][2], i);
    return "#Equalizer 1.2 ascii\nserver { config { appNode { " + pipes +
           "} observer { eye_base .1 } layout { view { observer 0 mode STEREO } } " + canvases +
           "} }";
}

class ConfigPictures : public testing::TestWithParam<Case> {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(test::succeeded(
            {"synth", "mesh", "--size", "40000", "--seed", "3", "-o", folder_->path("ball.ply")}));
        ASSERT_TRUE(test::succeeded(
            {"import", "mesh", folder_->path("ball.ply"), "-o", folder_->path("ball.eym")}));
        folder_->write("cam.json",
                       R"({"eye":[0,-3.2,0.4],"target":[0,0,0],"up":[0,0,1],"fovyDegrees":45})");
        folder_->write("inside.json",
                       R"({"eye":[0.1,0,0],"target":[1,0,0],"up":[0,0,1],"fovyDegrees":45})");
        folder_->write("cave.eqc", cave());
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static fabric::Image draw(const Case& drawn, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {
            "render",
            folder_->path("ball.eym"),
            "--camera",
            folder_->path("cam.json"),
            "--size",
            "320x180",
            "--config",
            fmt::format("{}/../shared/data/eqc/{}", EYRIE_SOURCE_DIR, drawn.file),
            "--quiet",
            "-o",
            folder_->path("out.png")};
        arguments.insert(arguments.end(), drawn.shown.begin(), drawn.shown.end());
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_TRUE(test::succeeded(arguments)) << drawn.file;
        const auto image = test::readPng(folder_->path("out.png"));
        EXPECT_TRUE(image.ok()) << image.status();
        return image.ok() ? *image : fabric::Image{};
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> ConfigPictures::folder_;

TEST_P(ConfigPictures, AreThoseOfOneChannel) {
    const fabric::Image picture = draw(GetParam(), {"--renderers", "2"});
    const fabric::Image single = draw(GetParam(), {"--renderers", "1", "--one-channel"});
    ASSERT_EQ(picture.area, single.area);
    std::size_t differing = 0;
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < single.colour.size(); ++i) {
        differing += picture.colour[i] == single.colour[i] ? 0 : 1;
        drawn += single.colour[i] == single.colour[0] ? 0 : 1;
    }
    EXPECT_GT(drawn, single.colour.size() / 50) << "the model is not in the picture";
    EXPECT_LE(differing, GetParam().mayDiffer);
}

INSTANTIATE_TEST_SUITE_P(Of, ConfigPictures,
                         testing::Values(Case{"4-node.2D.eqc"}, Case{"4-window.DB.bs.eqc"},
                                         Case{"4-window.DB.stream.eqc"}, Case{"2-pipe.DB.ds.eqc"},
                                         Case{"2-node.tile.eqc"},
                                         Case{"7-window.DB.PIXEL.eqc", {}, 20},
                                         Case{"3-window.EYE.anaglyph.eqc"},
                                         Case{"3-channel.cave.eqc", {"--segment", "1"}},
                                         Case{"8-window.wall.lb.eqc"}),
                         [](const auto& of) { return test::identifier(of.param.file); });

std::size_t differing(const fabric::Image& a, const fabric::Image& b) {
    if (a.area != b.area)
        return a.colour.size();
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) count += a.colour[i] == b.colour[i] ? 0 : 1;
    return count;
}

/// Of a view that is not stereo, too: each is beside the middle by half of the observer's eye base.
TEST_F(ConfigPictures, EveryEyeSeesAPictureOfItsOwn) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--renderers", "1"},
          std::vector<std::string>{"--config", folder_->path("cave.eqc"), "--canvas", "0"}}) {
        std::vector<fabric::Image> seen;
        for (const char* eye : {"left", "cyclop", "right"}) {
            std::vector<std::string> arguments = {"render",
                                                  folder_->path("ball.eym"),
                                                  "--camera",
                                                  folder_->path("cam.json"),
                                                  "--size",
                                                  "320x180",
                                                  "--quiet",
                                                  "--eye",
                                                  eye,
                                                  "-o",
                                                  folder_->path("eye.png")};
            arguments.insert(arguments.end(), more.begin(), more.end());
            ASSERT_TRUE(test::succeeded(arguments));
            const auto image = test::readPng(folder_->path("eye.png"));
            ASSERT_TRUE(image.ok()) << image.status();
            seen.push_back(*image);
        }
        EXPECT_GT(differing(seen[0], seen[1]), 100U);
        EXPECT_GT(differing(seen[2], seen[1]), 100U);
        EXPECT_GT(differing(seen[0], seen[2]), 100U);
    }
}

std::uint64_t pagesLoaded(const std::string& path) {
    std::ifstream in(path);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = text.find("\"pagesLoaded\"");
    return at == std::string::npos ? 0 : std::stoull(text.substr(text.find(':', at) + 1));
}

/// Six walls and two eyes: 12 views in one frame, by four renderers that load once for all that
/// each draws.
TEST_F(ConfigPictures, OfACaveComeTwelveAtOnceAndAreThoseDrawnOneByOne) {
    const auto draw = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render",
                                              folder_->path("ball.eym"),
                                              "--camera",
                                              folder_->path("inside.json"),
                                              "--size",
                                              "96x96",
                                              "--config",
                                              folder_->path("cave.eqc"),
                                              "--quiet",
                                              "--stats",
                                              folder_->path("stats.json")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_TRUE(test::succeeded(arguments));
        return pagesLoaded(folder_->path("stats.json"));
    };
    const std::uint64_t together = draw({"--all", "-o", folder_->path("cave.png")});
    std::uint64_t separately = 0;
    for (int wall = 0; wall < 6; ++wall)
        for (const std::string eye : {"left", "right"}) {
            separately +=
                draw({"--canvas", std::to_string(wall), "--segment", "0", "--eye", eye,
                      "--one-channel", "--renderers", "1", "-o", folder_->path("one.png")});
            const auto of12 =
                test::readPng(folder_->path(fmt::format("cave.{}.0.{}.png", wall, eye)));
            const auto single = test::readPng(folder_->path("one.png"));
            ASSERT_TRUE(of12.ok() && single.ok()) << of12.status() << single.status();
            EXPECT_EQ(differing(*of12, *single), 0U) << wall << eye;
        }
    EXPECT_GT(together, 0U);
    EXPECT_LT(together, separately);
    std::printf("%d pages loaded for 12 views in one frame, %d one by one\n",
                static_cast<int>(together), static_cast<int>(separately));
}

/// Names that are other segments' positions.
TEST_F(ConfigPictures, AllOfSegmentsWithNumbersForNamesAreThoseOfTheirNames) {
    const std::string file = folder_->path("numbers.eqc");
    std::ofstream(file) << R"(config {
        appNode { pipe { window { viewport [ 0 0 64 64 ] channel { name "a" } channel { name "b" } } } }
        layout { view {} } canvas { layout 0 wall {}
        segment { name "1" viewport [ 0 0 .5 1 ] channel "a" }
        segment { name "0" viewport [ .5 0 .5 1 ] channel "b" } } })";
    const auto draw = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render",   folder_->path("ball.eym"),
                                              "--camera", folder_->path("inside.json"),
                                              "--size",   "48x64",
                                              "--config", file,
                                              "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_TRUE(test::succeeded(arguments));
    };
    draw({"--all", "-o", folder_->path("all.png")});
    std::vector<fabric::Image> pictures;
    for (const std::string name : {"0", "1"}) {
        draw({"--segment", name, "-o", folder_->path("one.png")});
        const auto ofAll = test::readPng(folder_->path("all.0." + name + ".png"));
        const auto single = test::readPng(folder_->path("one.png"));
        ASSERT_TRUE(ofAll.ok() && single.ok()) << ofAll.status() << single.status();
        EXPECT_EQ(differing(*ofAll, *single), 0U) << name;
        pictures.push_back(*single);
    }
    EXPECT_GT(differing(pictures[0], pictures[1]), 100U) << "two halves";
}

TEST_F(ConfigPictures, AllOfOneEyeAndOfTwoInOneSegmentHaveTheirDepths) {
    const std::string file = folder_->path("mixed.eqc");
    std::ofstream(file) << R"(config {
        appNode { pipe { window { viewport [ 0 0 96 64 ] channel { name "a" } } } }
        layout { view { viewport [ 0 0 .5 1 ] } view { mode STEREO viewport [ .5 0 .5 1 ] } }
        canvas { layout 0 segment { channel "a" } } })";
    EXPECT_TRUE(
        test::succeeded({"render", folder_->path("ball.eym"), "--camera", folder_->path("cam.json"),
                         "--size", "96x64", "--config", file, "--quiet", "--all", "-o",
                         folder_->path("mixed.png"), "--depth", folder_->path("mixed.pfm")}));
    std::vector<fabric::Image> pictures;
    for (const std::string eye : {"", ".left", ".right"}) {
        EXPECT_TRUE(std::ifstream(folder_->path("mixed.0.0" + eye + ".pfm")).good()) << eye;
        const auto picture = test::readPng(folder_->path("mixed.0.0" + eye + ".png"));
        ASSERT_TRUE(picture.ok()) << picture.status();
        pictures.push_back(*picture);
    }
    EXPECT_GT(differing(pictures[0], pictures[1]), 100U) << "either has its own view";
    EXPECT_GT(differing(pictures[1], pictures[2]), 100U);
}

TEST_F(ConfigPictures, WarningsAreToldThoughThereIsNothingElseToTell) {
    const std::string file = folder_->path("again.eqc");
    std::ofstream(file) << R"(config { latency 1 latency 0
        appNode { pipe { window { viewport [ 0 0 64 64 ] channel { name "a" } } } }
        layout { view {} } canvas { layout 0 wall {} segment { channel "a" } } })";
    const auto told = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"render",   folder_->path("ball.eym"),
                                              "--camera", folder_->path("cam.json"),
                                              "--size",   "64x48",
                                              "--config", file,
                                              "-o",       folder_->path("out.png")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::eyrie(arguments);
    };
    const test::Outcome quiet = told({"--quiet"});
    EXPECT_EQ(quiet.exit, (test::Exit{0, 0})) << quiet.errors;
    EXPECT_THAT(quiet.errors, HasSubstr("'latency' is given again"));
    const test::Outcome eyes = told({"--eye", "left", "--stereo", "anaglyph"});
    EXPECT_EQ(eyes.exit, (test::Exit{2, 0})) << "one eye's picture is none of two";
    EXPECT_THAT(eyes.errors, HasSubstr("--eye"));
}

TEST_F(ConfigPictures, AllOfWhatIsNoConfigurationIsRefused) {
    const test::Outcome outcome =
        test::eyrie({"render", folder_->path("ball.eym"), "--camera", folder_->path("cam.json"),
                     "--all", "-o", folder_->path("out.png")});
    EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << outcome.errors;
    EXPECT_NE(outcome.errors.find("--config"), std::string::npos) << outcome.errors;
}

TEST_F(ConfigPictures, WhatIsStartedWithFewerRenderersIsSaid) {
    const test::Outcome outcome =
        test::eyrie({"check", folder_->path("cave.eqc"), "--renderers", "3"});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    EXPECT_NE(outcome.output.find("renderer 1: pipe 0/0, 0/3"), std::string::npos)
        << outcome.output;
    EXPECT_NE(outcome.output.find("missing: 1 of 4 renderers"), std::string::npos)
        << outcome.output;
}

/// Expected is what the same configuration gives where it names the newest version: a view that its
/// compound's eyes do not make stereo.
TEST(ConvertedConfigurations, ThatNameNoVersionAreOfTheNewest) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("a.eqc"))
        << "#Equalizer 1.2 ascii\nserver { config { appNode { pipe { window { viewport [ 0 0 64 64 "
           "] channel { name \"a\" } } } } layout { view {} } canvas { layout 0 wall {} segment { "
           "channel \"a\" } } compound { channel ( segment 0 view 0 ) eye [ LEFT RIGHT ] } } }";
    const auto convert = [&](const std::string& from, const std::string& to) {
        const test::Outcome outcome =
            test::eyrie({"check", folder.path(from), "--convert", folder.path(to)});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        std::ifstream file(folder.path(to));
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    std::string json = convert("a.eqc", "a.json");
    const std::string version = "\"version\": \"1.2\",";
    ASSERT_THAT(json, HasSubstr(version));
    std::ofstream(folder.path("b.json")) << json.erase(json.find(version), version.size());
    EXPECT_EQ(convert("b.json", "b.eqc"), convert("a.eqc", "again.eqc"));
}

TEST_F(ConfigPictures, WhatIsNotThereIsNamed) {
    const test::Outcome outcome = test::eyrie(
        {"render", folder_->path("ball.eym"), "--camera", folder_->path("cam.json"), "--config",
         fmt::format("{}/../shared/data/eqc/3-channel.cave.eqc", EYRIE_SOURCE_DIR), "--segment",
         "attic", "--renderers", "1", "-o", folder_->path("out.png")});
    EXPECT_NE(outcome.exit, (test::Exit{0, 0}));
    EXPECT_NE(outcome.errors.find("no segment is called \"attic\"; there are"), std::string::npos)
        << outcome.errors;
}

TEST_F(ConfigPictures, AMonitorShowsWhatOthersDraw) {
    const test::Outcome outcome = test::eyrie(
        {"render", folder_->path("ball.eym"), "--camera", folder_->path("cam.json"), "--config",
         fmt::format("{}/../shared/data/eqc/3-window.monitor.eqc", EYRIE_SOURCE_DIR), "--canvas",
         "1", "--size", "64x48", "-o", folder_->path("out.png")});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    EXPECT_THAT(outcome.errors, testing::AllOf(Not(HasSubstr(" 0 triangles")),
                                               Not(HasSubstr("Nothing is seen here"))));
}

TEST_F(ConfigPictures, LayoutsAreSwitchedOnTheCanvasThatIsSeen) {
    const std::string file = folder_->path("canvases.eqc");
    std::ofstream(file) << R"(config {
        appNode { pipe { window { viewport [ 0 0 64 64 ] channel { name "a" } } } }
        layout { name "x" view {} } layout { name "y" view {} }
        canvas { name "first" layout "x" layout "y" segment { channel "a" } }
        canvas { name "0" layout "x" segment { channel "a" } } })";
    const auto rendered = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"render",   folder_->path("ball.eym"),
                                              "--camera", folder_->path("cam.json"),
                                              "--config", file,
                                              "--size",   "64x64",
                                              "-o",       folder_->path("out.png")};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return test::eyrie(arguments).errors;
    };
    EXPECT_THAT(rendered({"--layout", "y"}), Not(HasSubstr("no layout"))) << "of the first";
    EXPECT_THAT(rendered({"--layout", "OFF"}),
                testing::AllOf(HasSubstr(" 0 triangles"), HasSubstr("Nothing is seen here")));
    EXPECT_THAT(rendered({"--layout", "x", "--canvas", "third"}),
                HasSubstr("--canvas: no canvas is called \"third\""));
}

}  // namespace
}  // namespace eyrie
