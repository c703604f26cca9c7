// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/queues.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/config/eqc_reader.h"
#include "layered_scene.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

constexpr int kWidth = 41;
constexpr int kHeight = 23;

/// Channels "a" to "c", one view on "a", and what its compound has.
config::Configuration shared(const std::string& compound) {
    std::string windows;
    for (const char name : {'a', 'b', 'c'})
        windows += fmt::format(
            "pipe {{ window {{ viewport [ 0 0 640 480 ] channel {{ name \"{}\" }} }} }} ", name);
    config::Findings findings;
    config::Configuration configuration =
        config::readEqc("config { appNode { " + windows +
                            " } layout { view {} } canvas { layout 0 segment { "
                            "channel \"a\" } } compound { channel ( segment 0 view 0 ) " +
                            compound + " } }",
                        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

std::string takers(const std::string& queue) {
    return fmt::format(
        "compound {{ inputtiles {{ name \"{0}\" }} }} "
        "compound {{ channel \"b\" inputtiles {{ name \"{0}\" }} outputframe {{ }} }} "
        "compound {{ channel \"c\" inputtiles {{ name \"{0}\" }} outputframe {{ }} }} "
        "inputframe {{ name \"frame.b\" }} inputframe {{ name \"frame.c\" }}",
        queue);
}

Plan planned(const config::Configuration& configuration, bool wantsDepth = false) {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = config::PixelSize{kWidth, kHeight};
    request.outputs[0].wantsDepth = wantsDepth;
    auto plan = makePlan(configuration, request);
    EXPECT_TRUE(plan.ok()) << plan.status();
    return plan.ok() ? *std::move(plan) : Plan{};
}

fabric::Image pictureOf(const Plan& plan) {
    const LayeredScene scene(4711, kWidth, kHeight);
    std::vector<fabric::LentImage> drawn;
    for (const PlannedDraw& draw : plan.draws) drawn.push_back(scene.draw(draw.task).image);
    return composePictures(plan, std::move(drawn), LayeredScene::kBackground).at(0);
}

fabric::Image whole(bool hasDepth) {
    fabric::Image image = LayeredScene(4711, kWidth, kHeight).whole(kWidth, kHeight);
    if (!hasDepth)
        image.depth.clear();
    return image;
}

std::int64_t pixelsOf(const Plan& plan) {
    std::int64_t pixels = 0;
    for (const PlannedDraw& draw : plan.draws) pixels += draw.task.pixelViewport.area();
    return pixels;
}

TEST(Queues, HaveEveryTileDrawnOnceByAnyOfTheirTakers) {
    const Plan plan = planned(shared("outputtiles { name \"q\" size [ 9 7 ] } " + takers("q")));
    EXPECT_EQ(plan.draws.size(), 20U) << "5 columns, 4 rows";
    EXPECT_EQ(pixelsOf(plan), kWidth * kHeight);
    ASSERT_EQ(plan.queues.size(), 1U);
    EXPECT_EQ(plan.queues[0].size(), 3U);
    for (const PlannedDraw& draw : plan.draws) EXPECT_EQ(draw.queue, 0U);
}

TEST(Queues, OfTilesMakeThePictureOfOneChannel) {
    for (const char* size : {"9 7", "1 23", "41 1", "64 64", "40 22", "3 3"})
        for (const bool wantsDepth : {false, true}) {
            const Plan plan =
                planned(shared(fmt::format("outputtiles {{ name \"q\" size [ {} ] }} ", size) +
                               takers("q")),
                        wantsDepth);
            EXPECT_TRUE(pictureOf(plan) == whole(wantsDepth)) << size << ", depth " << wantsDepth;
        }
}

TEST(Queues, OfChunksMakeThePictureOfOneChannel) {
    for (const double size : {.5, .13, .07, 1., .33})
        for (const bool wantsDepth : {false, true}) {
            const Plan plan = planned(
                shared(fmt::format("buffer [ COLOR DEPTH ] outputtiles {{ name \"q\" size {} }} ",
                                   size) +
                       takers("q")),
                wantsDepth);
            EXPECT_EQ(plan.draws.size(), static_cast<std::size_t>(std::ceil(1 / size - 1e-9)));
            EXPECT_TRUE(pictureOf(plan) == whole(wantsDepth)) << size << ", depth " << wantsDepth;
        }
}

TEST(Queues, OfAShareOfTheDataOrThePictureAreOfThatShare) {
    const std::string two =
        "compound { range [ 0 .4 ] outputtiles { name \"p\" size [ 10 10 ] } "
        "  compound { inputtiles { name \"p\" } } "
        "  compound { channel \"b\" inputtiles { name \"p\" } outputframe { } } "
        "  inputframe { name \"frame.b\" } } "
        "compound { channel \"c\" range [ .4 1 ] outputframe { name \"rest\" } } "
        "inputframe { name \"rest\" }";
    EXPECT_TRUE(pictureOf(planned(shared("buffer [ COLOR DEPTH ] " + two))) == whole(false));
    const std::string half =
        "compound { viewport [ 0 0 .5 1 ] outputtiles { name \"p\" size [ 8 8 ] } "
        "  compound { inputtiles { name \"p\" } } "
        "  compound { channel \"b\" inputtiles { name \"p\" } outputframe { } } "
        "  inputframe { name \"frame.b\" } } "
        "compound { viewport [ .5 0 .5 1 ] channel \"c\" outputframe { name \"rest\" } } "
        "inputframe { name \"rest\" }";
    EXPECT_TRUE(pictureOf(planned(shared(half))) == whole(false));
}

TEST(Queues, ReplaceWhatTheirTakersHaveOfThePicture) {
    const std::string halves =
        "compound { viewport [ 0 0 .5 1 ] inputtiles { name \"q\" } } "
        "compound { viewport [ .5 0 .5 1 ] channel \"b\" inputtiles { name \"q\" } outputframe { } "
        "} inputframe { name \"frame.b\" }";
    EXPECT_TRUE(pictureOf(planned(shared("outputtiles { name \"q\" size [ 9 7 ] } " + halves))) ==
                whole(false));
}

TEST(Queues, ThatNobodyMakesAreNone) {
    const Plan plan = planned(shared("outputtiles { name \"q\" size [ 9 7 ] } " + takers("other")));
    EXPECT_TRUE(plan.queues.empty());
    EXPECT_TRUE(pictureOf(plan) == whole(false));
}

TEST(Queues, HaveABoundedNumberOfTiles) {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = config::PixelSize{8192, 4096};
    const auto plan =
        makePlan(shared("outputtiles { name \"q\" size [ 1 1 ] } " + takers("q")), request);
    ASSERT_TRUE(plan.ok()) << plan.status();
    EXPECT_EQ(plan->draws.size(), 512U) << "of 256 x 256";
    EXPECT_EQ(planned(shared("buffer [ COLOR DEPTH ] outputtiles { name \"q\" size .00001 } " +
                             takers("q")))
                  .draws.size(),
              static_cast<std::size_t>(kMostTiles));
}

}  // namespace
}  // namespace eyrie::compound
