// SPDX-License-Identifier: Apache-2.0
// Views and canvases beside each other, whose compounds share frames.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "composed_pictures.h"
#include "coordinator/compound/equalizer/equalizers.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/one_channel.h"
#include "layered_scene.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

/// Three channels of 40 x 24 pixels, "a" on canvas 0 and "c" on canvas 1.
config::Configuration twoCanvases(const std::string& compounds) {
    std::string windows;
    for (const char name : {'a', 'b', 'c'})
        windows +=
            fmt::format("window {{ viewport [ 0 0 40 24 ] channel {{ name \"{}\" }} }} ", name);
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { " + windows +
            "} } layout { view {} } canvas { layout 0 wall {} segment { channel \"a\" } } "
            "canvas { layout 0 wall {} segment { channel \"c\" } } " +
            compounds + " }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
    return configuration;
}

PlanRequest bothCanvases() {
    PlanRequest request;
    request.outputs.resize(2);
    request.outputs[1].canvas = 1;
    for (Output& output : request.outputs) output.size = config::PixelSize{40, 24};
    return request;
}

fabric::Rgba pixel(const fabric::Image& image, int x, int y) {
    return image.colour[static_cast<std::size_t>(y * image.area.width + x)];
}

fabric::Rgba meanOfFour(const fabric::Image& image, int x, int y) {
    const auto mean = [&](std::uint8_t fabric::Rgba::*of) {
        const int sum = pixel(image, x, y).*of + pixel(image, x + 1, y).*of +
                        pixel(image, x, y + 1).*of + pixel(image, x + 1, y + 1).*of;
        return static_cast<std::uint8_t>((sum + 2) / 4);
    };
    return {mean(&fabric::Rgba::r), mean(&fabric::Rgba::g), mean(&fabric::Rgba::b),
            mean(&fabric::Rgba::a)};
}

TEST(Compose, WhoTakesAFrameWithoutItsDepthLeavesItToOthers) {
    const config::Configuration configuration = twoCanvases(
        "compound { compound { channel ( canvas 0 segment 0 layout 0 view 0 ) buffer [ COLOR DEPTH "
        "] compound { range [ 0 .5 ] } compound { channel \"b\" range [ .5 1 ] outputframe { name "
        "\"f\" } } inputframe { name \"f\" } } compound { channel ( canvas 1 segment 0 layout 0 "
        "view 0 ) task [ CLEAR ASSEMBLE ] inputframe { name \"f\" buffer [ COLOR ] } } }");
    const LayeredScene scene(3, 40, 24);
    const auto made = pictures(configuration, bothCanvases(), scene);
    const auto plain = pictures(config::oneChannel(configuration), bothCanvases(), scene);
    ASSERT_TRUE(made.size() == 2 && plain.size() == 2);
    EXPECT_EQ(differingPixels(made[0], plain[0]), 0);
    EXPECT_GT(differingPixels(made[1], made[0]), 0) << "half of the data";
}

TEST(Compose, WhatIsDrawnInOtherPixelsIsShownThoughOthersTakeIt) {
    const auto made = [](const std::string& frame) {
        return pictures(
            twoCanvases("compound { compound { channel ( canvas 0 segment 0 layout 0 view 0 ) zoom "
                        "[ .5 .5 ] " +
                        frame +
                        " } compound { channel ( canvas 1 segment 0 layout 0 view 0 ) task [ CLEAR "
                        "ASSEMBLE ] inputframe { name \"f\" } } }"),
            bothCanvases(), LayeredScene(3, 40, 24));
    };
    const auto taken = made("outputframe { name \"f\" }");
    const auto alone = made("");
    ASSERT_TRUE(taken.size() == 2 && alone.size() == 2);
    EXPECT_EQ(differingPixels(taken[0], alone[0]), 0);
    const auto background = fabric::makeImage({0, 0, 40, 24}, LayeredScene::kBackground, false);
    EXPECT_GT(differingPixels(taken[0], background), 0);
    EXPECT_GT(differingPixels(taken[1], background), 0);
}

/// A wall and two monitors of the same frame, one with half its pixels each way, one with a
/// quarter: the larger's pixels are there for both.
TEST(Compose, MonitorsOfOneFrameShowItAsLargeAsTheyAre) {
    std::string windows;
    std::string canvases;
    std::string monitors;
    int canvas = 0;
    PlanRequest request;
    for (const int width : {40, 20, 10}) {
        const int height = width * 3 / 5;
        windows += fmt::format("window {{ viewport [ 0 0 {} {} ] channel {{ name \"{}\" }} }} ",
                               width, height, canvas);
        canvases += fmt::format("canvas {{ layout 0 segment {{ channel \"{}\" }} }} ", canvas);
        if (canvas > 0) {
            monitors += fmt::format(
                "compound {{ channel ( canvas {} segment 0 layout 0 view 0 ) "
                "monitor_equalizer {{ }} task [ CLEAR ASSEMBLE ] inputframe {{ "
                "name \"f\" }} }} ",
                canvas);
        }
        request.outputs.emplace_back().canvas = static_cast<std::size_t>(canvas++);
        request.outputs.back().size = config::PixelSize{width, height};
    }
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { " + windows + "} } layout { view {} } " + canvases +
            "compound { compound { channel ( canvas 0 segment 0 layout 0 view 0 ) outputframe { "
            "name \"f\" } } " +
            monitors + "} }",
        findings);
    const config::Configuration written = configuration;
    const config::ResolvedConfiguration resolved = config::resolve(written, findings);
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
    equalizer::Equalizers(written).apply(configuration, {.resolved = resolved});
    const auto made = pictures(configuration, request, LayeredScene(3, 40, 24));
    ASSERT_EQ(made.size(), 3U);
    for (std::size_t i = 1; i < 3; ++i) {
        const fabric::Image& small = made[i];
        const fabric::Image& large = made[i - 1];
        ASSERT_EQ(large.area.width, 2 * small.area.width);
        for (int y = 0; y < small.area.height; ++y)
            for (int x = 0; x < small.area.width; ++x)
                ASSERT_EQ(pixel(small, x, y), meanOfFour(large, 2 * x, 2 * y))
                    << i << ": " << x << " " << y;
    }
}

TEST(Compose, BothGlassesSeeTheSameOfAViewWithoutStereo) {
    config::Findings findings;
    const config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { window { viewport [ 0 0 40 24 ] channel { name \"a\" } } } } "
        "observer { eye_base .2 } layout { view { mode STEREO viewport [ 0 0 .5 1 ] observer 0 } "
        "view { mode MONO viewport [ .5 0 .5 1 ] observer 0 } } canvas { layout 0 wall {} segment "
        "{ channel \"a\" } } }",
        findings);
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
    PlanRequest request;
    request.outputs.resize(1);
    const auto eyesOf = [&] {
        const auto plan = makePlan(configuration, request);
        EXPECT_TRUE(plan.ok()) << plan.status();
        std::vector<Eye> eyes;
        for (const PlannedDraw& draw : plan->draws)
            eyes.push_back(plan->framebuffers[draw.framebuffer].eye);
        return eyes;
    };
    EXPECT_THAT(eyesOf(), testing::UnorderedElementsAre(Eye::Left, Eye::Right, Eye::Cyclop));
    request.outputs[0].stereo = Stereo::SideBySide;
    EXPECT_THAT(eyesOf(),
                testing::UnorderedElementsAre(Eye::Left, Eye::Left, Eye::Right, Eye::Right))
        << "whoever asks for two eyes gets two pictures";
}

/// A part of a window of which no pixel is left is shown as large as it is asked for.
TEST(Compose, AChannelWithoutPixelsIsSeenInAPictureOfItsOwn) {
    config::Findings findings;
    const config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { window { viewport [ 0 0 100 100 ] channel { name \"a\" viewport "
        "[ 0 0 .004 1 ] } } } } layout { view {} } canvas { layout 0 wall {} segment { channel "
        "\"a\" } } }",
        findings);
    ASSERT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].segment = 0;
    request.outputs[0].size = config::PixelSize{64, 64};
    const auto plan = makePlan(configuration, request);
    ASSERT_TRUE(plan.ok()) << plan.status();
    EXPECT_EQ(plan->draws.size(), 1U);
    EXPECT_EQ(plan->blind, 0U);
}

TEST(Compose, AZoomLeavesAPixel) {
    const auto made = [](const std::string& parts) {
        return pictures(
            twoCanvases("compound { channel ( canvas 0 segment 0 layout 0 view 0 ) " + parts + "}"),
            bothCanvases(), LayeredScene(3, 40, 24));
    };
    const auto column = made(
        "compound { channel \"b\" viewport [ 0 0 .025 1 ] zoom [ .25 1 ] outputframe {} } "
        "compound { viewport [ .025 0 .975 1 ] } inputframe { name \"frame.b\" }");
    const auto whole = made("");
    ASSERT_EQ(column.size(), 2U);
    EXPECT_EQ(differingPixels(column[0], whole[0]), 0) << "of one pixel's width a quarter is one";
}

}  // namespace
}  // namespace eyrie::compound
