// SPDX-License-Identifier: Apache-2.0
// Where in a picture, and how large, frames of others come.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "composed_pictures.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/eqc_reader.h"
#include "layered_scene.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

constexpr int kWidth = 40;
constexpr int kHeight = 24;

PlanRequest ofEvenSize() {
    PlanRequest request = wholeCanvas();
    request.outputs[0].size = config::PixelSize{kWidth, kHeight};
    return request;
}

/// What is made of a child's picture, whose frames are taken as `input` says, and that picture.
struct Taken {
    fabric::Image made;
    fabric::Image drawn;
    fabric::Rgba at(int x, int y) const {
        return made.colour[static_cast<std::size_t>(y * kWidth + x)];
    }
    fabric::Rgba child(int x, int y) const {
        return drawn.colour[static_cast<std::size_t>(y * kWidth + x)];
    }
    /// Of a square of four of the child's.
    fabric::Rgba meanOfFour(int x, int y) const {
        const auto mean = [&](std::uint8_t fabric::Rgba::*of) {
            return static_cast<std::uint8_t>((child(x, y).*of + child(x + 1, y).*of +
                                              child(x, y + 1).*of + child(x + 1, y + 1).*of + 2) /
                                             4);
        };
        return {mean(&fabric::Rgba::r), mean(&fabric::Rgba::g), mean(&fabric::Rgba::b),
                mean(&fabric::Rgba::a)};
    }
};

Taken taken(std::vector<config::Compound> children, const config::Frame& input) {
    const LayeredScene scene(3);
    config::Configuration placed = withChildren(std::move(children));
    for (config::Frame& frame : placed.compounds[0].inputFrames) {
        frame.viewport = input.viewport;
        frame.zoom = input.zoom;
    }
    const auto whole = pictures(withChildren({source(1)}), ofEvenSize(), scene);
    const auto made = pictures(placed, ofEvenSize(), scene);
    EXPECT_EQ(whole.size() + made.size(), 2U);
    return {made.at(0), whole.at(0)};
}

config::Frame placed(const config::Viewport& viewport, std::optional<fabric::Vec2> zoom = {}) {
    config::Frame input;
    input.viewport = viewport;
    input.zoom = zoom;
    return input;
}

TEST(Compose, AnInputFrameBeginsAndEndsWhereItsViewportDoes) {
    const Taken got = taken({source(1)}, placed({.25, .5, .5, .25}));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool isWithin = x >= 10 && x < 30 && y >= 12 && y < 18;
            ASSERT_EQ(got.at(x, y),
                      isWithin ? got.child(x - 10, y - 12) : LayeredScene::kBackground)
                << x << " " << y;
        }
}

/// A picture in the corner, of one frame and of two that are its halves.
TEST(Compose, AnInputFramesZoomIsPixelsForEachOfItsOwn) {
    config::Compound left = source(1);
    left.viewport = {0, 0, .5, 1};
    config::Compound right = source(2);
    right.viewport = {.5, 0, .5, 1};
    for (const std::vector<config::Compound>& children :
         {std::vector{source(1)}, std::vector{left, right}}) {
        const Taken got = taken(children, placed({.5, .5, .5, .5}, fabric::Vec2(.5, .5)));
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const bool isWithin = x >= 20 && y >= 12;
                ASSERT_EQ(got.at(x, y), isWithin ? got.meanOfFour(2 * (x - 20), 2 * (y - 12))
                                                 : LayeredScene::kBackground)
                    << children.size() << ": " << x << " " << y;
            }
    }
}

TEST(Compose, WhatIsReadBackSmallerFitsUnlessTheInputFrameSaysOtherwise) {
    config::Compound half = source(1);
    half.outputFrames[0].zoom = fabric::Vec2(.5, .5);
    const Taken fits = taken({half}, placed({}));
    const Taken twice = taken({half}, placed({}, fabric::Vec2(2, 2)));
    const Taken small = taken({half}, placed({}, fabric::Vec2(1, 1)));
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            ASSERT_EQ(fits.at(x, y), fits.meanOfFour(x / 2 * 2, y / 2 * 2)) << x << " " << y;
            ASSERT_EQ(twice.at(x, y), fits.at(x, y)) << x << " " << y;
            const bool isWithin = x < kWidth / 2 && y < kHeight / 2;
            ASSERT_EQ(small.at(x, y),
                      isWithin ? small.meanOfFour(2 * x, 2 * y) : LayeredScene::kBackground)
                << x << " " << y;
        }
}

/// Two whole pictures side by side, each shrunk to half the width: both keep their depth.
TEST(Compose, PlacedFramesOfSharesOfTheDataMeetByDepth) {
    config::Compound low = source(1);
    low.range = {0, .5};
    config::Compound high = source(2);
    high.range = {.5, 1};
    for (config::Compound* const each : {&low, &high})
        each->outputFrames[0].buffers = config::Buffers{true, true};
    const Taken whole = taken({source(1)}, placed({.5, 0, .5, 1}));
    const Taken shared = taken({low, high}, placed({.5, 0, .5, 1}));
    EXPECT_EQ(differingPixels(shared.made, whole.made), 0);
    EXPECT_GT(differingPixels(whole.made,
                              fabric::makeImage(whole.made.area, LayeredScene::kBackground, false)),
              0);
}

/// One channel's picture of all that "a", "b" and "c" draw, and what of "b" and "c" is taken.
void expectAllIsShown(const std::string& others) {
    config::Findings findings;
    const config::Configuration configuration = config::readEqc(
        "server { config { appNode { pipe {\n"
        "window { viewport [ 0 0 40 24 ] channel { name \"a\" } }\n"
        "window { viewport [ 0 0 40 24 ] channel { name \"b\" } }\n"
        "window { viewport [ 0 0 40 24 ] channel { name \"c\" } } } }\n"
        "layout { view { } } canvas { layout 0 segment { channel \"a\" } }\n"
        "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ]\n"
        "compound { channel \"a\" range [ 0 .34 ] }\n" +
            others + " inputframe { name \"f\" } } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
    const LayeredScene scene(3);
    const auto made = pictures(configuration, ofEvenSize(), scene);
    ASSERT_EQ(made.size(), 1U);
    EXPECT_EQ(differingPixels(made[0], scene.whole(kWidth, kHeight)), 0) << others;
}

/// As the configuration's reader warns; parents stand before their children, and end after them.
TEST(Compose, OfOutputFramesWithOneNameTheFirstIsTaken) {
    expectAllIsShown(
        "compound { channel \"b\" outputframe { name \"f\" }\n"
        "compound { range [ .34 .67 ] outputframe { name \"f\" } }\n"
        "compound { channel \"c\" range [ .67 1 ] outputframe { name \"g\" } }\n"
        "inputframe { name \"g\" } }");
    expectAllIsShown(
        "compound { channel \"b\" range [ .34 1 ] outputframe { name \"f\" }\n"
        "outputframe { name \"f\" buffer [ COLOR ] viewport [ 0 0 .5 1 ] } }");
    expectAllIsShown(
        "compound { channel \"c\" task [ CLEAR DRAW ] outputframe { name \"f\" } }\n"
        "compound { channel \"b\" range [ .34 1 ] outputframe { name \"f\" } }");
}

/// Onto another canvas, where the input frame says where to, and where nothing does.
TEST(Compose, AFrameOfAnotherViewsChannelComesWhereItsViewportIs) {
    const auto made = [](const std::string& input) {
        config::Findings findings;
        const config::Configuration configuration = config::readEqc(
            "server { config { appNode { pipe {\n"
            "window { viewport [ 0 0 40 24 ] channel { name \"a\" } }\n"
            "window { viewport [ 0 0 80 48 ] channel { name \"b\" } } } }\n"
            "layout { view { } }\n"
            "canvas { layout 0 segment { channel \"a\" } }\n"
            "canvas { layout 0 segment { channel \"b\" } }\n"
            "compound {\n"
            "compound { channel ( canvas 0 segment 0 layout 0 view 0 ) outputframe { name \"f\" } "
            "}\n"
            "compound { channel ( canvas 1 segment 0 layout 0 view 0 ) task [ CLEAR ASSEMBLE ]\n"
            "inputframe { name \"f\" " +
                input + " } } } } }",
            findings);
        EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "f");
        PlanRequest request;
        request.outputs.resize(2);
        request.outputs[0].canvas = 1;
        request.outputs[0].size = config::PixelSize{2 * kWidth, 2 * kHeight};
        request.outputs[1].size = config::PixelSize{kWidth, kHeight};
        return pictures(configuration, request, LayeredScene(3));
    };
    const auto corner = made("viewport [ .5 .5 .5 .5 ] zoom [ 1 1 ]");
    const auto moved = made("viewport [ .5 0 .5 1 ]");
    const auto fits = made("");
    ASSERT_EQ(corner.size(), 2U);
    const fabric::Image& shown = corner[1];
    const auto at = [](const fabric::Image& image, int x, int y) {
        return image.colour[static_cast<std::size_t>(y * image.area.width + x)];
    };
    for (int y = 0; y < 2 * kHeight; ++y)
        for (int x = 0; x < 2 * kWidth; ++x) {
            const bool isInCorner = x >= kWidth && y >= kHeight;
            ASSERT_EQ(at(corner[0], x, y),
                      isInCorner ? at(shown, x - kWidth, y - kHeight) : LayeredScene::kBackground);
            ASSERT_EQ(at(moved[0], x, y),
                      x >= kWidth ? at(shown, (x - kWidth) / 2, y / 2) : LayeredScene::kBackground);
            ASSERT_EQ(at(fits[0], x, y), at(shown, x / 2, y / 2));
        }
}

}  // namespace
}  // namespace eyrie::compound
