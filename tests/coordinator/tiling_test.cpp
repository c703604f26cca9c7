// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/tiling.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/config/default_config.h"
#include "layered_scene.h"
#include "random_compounds.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

constexpr int kWidth = 41;
constexpr int kHeight = 23;

PlanRequest wholeCanvas() {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = config::PixelSize{kWidth, kHeight};
    return request;
}

std::vector<fabric::Image> drawn(const Plan& plan, const LayeredScene& scene) {
    std::vector<fabric::Image> images;
    for (const PlannedDraw& draw : plan.draws) images.push_back(scene.draw(draw.task).image);
    return images;
}

/// The tiles beside each other, as a browser shows them.
fabric::Image laidOut(const Plan& plan, const std::vector<Tile>& tiles, const LayeredScene& scene) {
    const std::vector<fabric::Image> images = drawn(plan, scene);
    fabric::Image picture =
        fabric::makeImage(plan.pictures.front().area, LayeredScene::kBackground, false);
    for (const Tile& tile : tiles) {
        fabric::Image image = images[tile.draw];
        const fabric::PixelViewport& task = plan.draws[tile.draw].task.pixelViewport;
        EXPECT_EQ(tile.area.width, task.width);
        EXPECT_EQ(tile.area.height, task.height);
        image.area.x += tile.area.x - task.x;
        image.area.y += tile.area.y - task.y;
        fabric::paste(image, picture);
    }
    return picture;
}

/// Of all of the canvas or a part.
PlanRequest anyRequest() {
    PlanRequest request = wholeCanvas();
    if (*rc::gen::arbitrary<bool>())
        request.outputs[0].part = fabric::PixelViewport{3, 5, 30, 11};
    return request;
}

fabric::Image composited(const Plan& plan, const LayeredScene& scene) {
    std::vector<fabric::Image> images = drawn(plan, scene);
    return composePictures(plan, {images.begin(), images.end()}, LayeredScene::kBackground).front();
}

RC_GTEST_PROP(Tiling, TreesOf2DCompoundsAreMadeOfTiles, (std::uint32_t seed)) {
    const LayeredScene scene(seed, kWidth, kHeight, *rc::gen::element(0, 1, 2, 30));
    const auto plan =
        makePlan(RandomCompounds(seed).sideBySide(*rc::gen::inRange(1, 4)), anyRequest());
    RC_ASSERT(plan.ok());
    const auto tiles = tilesOf(*plan);
    RC_ASSERT(tiles.has_value());
    RC_CLASSIFY(tiles->size() > 1, "several");
    RC_ASSERT(laidOut(*plan, *tiles, scene) == composited(*plan, scene));
}

RC_GTEST_PROP(Tiling, WhatIsMadeOfTilesOfAnyTreeIsThePicture, (std::uint32_t seed)) {
    const LayeredScene scene(seed, kWidth, kHeight, *rc::gen::element(0, 1, 2, 30));
    const auto plan =
        makePlan(RandomCompounds(seed).configuration(*rc::gen::inRange(1, 4)), anyRequest());
    RC_ASSERT(plan.ok());
    const auto tiles = tilesOf(*plan);
    RC_CLASSIFY(tiles.has_value(), "tiles");
    if (tiles)
        RC_ASSERT(laidOut(*plan, *tiles, scene) == composited(*plan, scene));
}

/// Of the layouts that are made of four renderers.
Plan planOf(const std::string& layout, bool wantsDepth = false) {
    std::vector<config::RendererFacts> renderers(4);
    for (std::size_t i = 0; i < renderers.size(); ++i) renderers[i].id = std::to_string(i);
    const config::Configuration made = config::defaultConfiguration(renderers);
    const auto names = config::layoutNames(made);
    PlanRequest request = wholeCanvas();
    request.display.canvases.resize(1);
    request.display.canvases[0].layout =
        static_cast<std::size_t>(std::ranges::find(names, layout) - names.begin());
    request.outputs[0].wantsDepth = wantsDepth;
    return makePlan(made, request).value();
}

TEST(Tiling, OnlyWhatIsLaidOutSideBySideIsMadeOfTiles) {
    EXPECT_EQ(tilesOf(planOf("2D")).value().size(), 4U);
    EXPECT_EQ(tilesOf(planOf("Simple")).value().size(), 1U);
    EXPECT_FALSE(tilesOf(planOf("2D", true)));
    for (const char* const layout : {"DB static", "DB dynamic", "direct-send", "DB-2D"})
        EXPECT_FALSE(tilesOf(planOf(layout))) << layout;
}

TEST(Tiling, TwoPicturesAreNoTiles) {
    Plan plan = planOf("2D");
    plan.pictures.push_back(plan.pictures.front());
    EXPECT_FALSE(tilesOf(plan));
}

TEST(Tiling, APictureWithAHoleIsNotMadeOfTiles) {
    Plan plan = planOf("2D");
    plan.pictures.front().parts.pop_back();
    EXPECT_FALSE(tilesOf(plan));
}

}  // namespace
}  // namespace eyrie::compound
