// SPDX-License-Identifier: Apache-2.0
// Configurations of Equalizer, drawn by real renderer processes: each picture must be that of one
// channel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/identifier.h"
#include "tests/support/image_files.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

struct Case {
    const char* file;
    std::vector<std::string> shown = {};
    /// Interleaved pixels are rastered in pictures of their own, whose vertices snap elsewhere.
    std::size_t mayDiffer = 0;
};

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

TEST_F(ConfigPictures, WhatIsNotThereIsNamed) {
    const test::Outcome outcome = test::eyrie(
        {"render", folder_->path("ball.eym"), "--camera", folder_->path("cam.json"), "--config",
         fmt::format("{}/../shared/data/eqc/3-channel.cave.eqc", EYRIE_SOURCE_DIR), "--segment",
         "attic", "--renderers", "1", "-o", folder_->path("out.png")});
    EXPECT_NE(outcome.exit, (test::Exit{0, 0}));
    EXPECT_NE(outcome.errors.find("no segment is called \"attic\"; there are"), std::string::npos)
        << outcome.errors;
}

}  // namespace
}  // namespace eyrie
