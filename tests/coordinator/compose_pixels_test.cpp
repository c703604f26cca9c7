// SPDX-License-Identifier: Apache-2.0
// Pictures of pixels that are others' means, or stand for several: subpixels and zooms.
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "composed_pictures.h"
#include "coordinator/composite/mean.h"
#include "coordinator/compound/compose.h"
#include "coordinator/compound/jitter.h"
#include "coordinator/compound/plan.h"
#include "fabric/depth_merge.h"
#include "layered_scene.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

RC_GTEST_PROP(Compose, SubpixelsAreTheMeanOfPicturesAtTheJittersPlaces, (std::uint32_t seed)) {
    const LayeredScene scene(seed);
    const int count = *rc::gen::inRange(2, 8);
    std::vector<config::Compound> children;
    for (int i = 0; i < count; ++i) {
        children.push_back(source(static_cast<std::size_t>(i)));
        children.back().subpixel = {i, count};
    }
    // Put together in any order, and the first perhaps on the destination's own channel.
    if (*rc::gen::arbitrary<bool>())
        children[0].outputFrames.clear();
    if (*rc::gen::arbitrary<bool>())
        std::swap(children[0], children[1]);
    const auto got = pictures(withChildren(children), wholeCanvas(), scene);
    RC_ASSERT(got.size() == 1U);

    const fabric::PixelViewport area{0, 0, kSize.width, kSize.height};
    std::vector<int> sums(static_cast<std::size_t>(area.area()), 0);
    for (int i = 0; i < count; ++i) {
        fabric::ChannelTask task{0, 0, area.width, area.height, area, {}, false};
        task.raster = fabric::Raster{area.width, area.height, jitter(i, count), {1, 1}};
        if (const auto plan = makePlan(withChildren({}), wholeCanvas()); plan.ok())
            task.sight = plan->draws.front().task.sight;
        fabric::Image sample = fabric::makeImage(area, LayeredScene::kBackground, false);
        fabric::paste(scene.draw(task).image, sample);
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += sample.colour[k].r;
    }
    for (std::size_t k = 0; k < sums.size(); ++k)
        RC_ASSERT(got[0].colour[k].r == (2 * sums[k] + count) / (2 * count));
}

constexpr config::Buffers kWithDepth{true, true};

/// On this channel, with depth: of a range, and perhaps one of two subpixels.
config::Compound part(std::size_t channel, const fabric::Range& range,
                      const config::SubPixelShare& subpixel) {
    config::Compound made = source(channel);
    made.outputFrames[0].buffers = kWithDepth;
    made.range = range;
    made.subpixel = subpixel;
    return made;
}

/// The whole picture of a range, at one of two subpixels' places or at pixels' middles.
fabric::Image wholeOf(const LayeredScene& scene, const fabric::Range& range,
                      const config::SubPixelShare& subpixel) {
    const auto plan = makePlan(withChildren({}), wholeCanvas());
    EXPECT_TRUE(plan.ok());
    const fabric::PixelViewport area{0, 0, kSize.width, kSize.height};
    fabric::ChannelTask task{0, 0, area.width, area.height, area, range, true};
    task.raster = fabric::Raster{area.width, area.height, {0, 0}, {1, 1}};
    if (subpixel.count > 1)
        task.raster->origin = jitter(subpixel.index, subpixel.count);
    task.sight = plan->draws.front().task.sight;
    fabric::Image image = fabric::makeImage(area, LayeredScene::kBackground, true);
    fabric::paste(scene.draw(task).image, image);
    return image;
}

/// A range drawn as it is, another as the mean of two subpixels: by depth, the lower one first.
fabric::Image mixed(const LayeredScene& scene, const fabric::Range& drawn,
                    const fabric::Range& sampled) {
    const fabric::Image plain = wholeOf(scene, drawn, {});
    const std::vector<fabric::Image> samples = {wholeOf(scene, sampled, {0, 2}),
                                                wholeOf(scene, sampled, {1, 2})};
    const fabric::Image mean = composite::mean(samples);
    fabric::Image image = drawn.begin < sampled.begin ? plain : mean;
    fabric::mergeDepth(drawn.begin < sampled.begin ? mean : plain, image);
    return image;
}

RC_GTEST_PROP(Compose, SubpixelsOfARangeLeaveTheRestOfTheData, (std::uint32_t seed)) {
    const LayeredScene scene(seed);
    fabric::Range drawn{0, .5};
    fabric::Range sampled{.5, 1};
    if (*rc::gen::arbitrary<bool>())
        std::swap(drawn, sampled);
    config::Compound own;
    own.range = drawn;
    config::Compound mean = part(1, sampled, {});
    mean.buffers = kWithDepth;
    config::Compound first;
    first.subpixel = {0, 2};
    mean.children = {first, part(2, {}, {1, 2})};
    mean.inputFrames = {RandomCompounds::frame("f2")};
    const std::vector<std::vector<config::Compound>> forms = {
        {own, mean}, {own, part(1, sampled, {0, 2}), part(2, sampled, {1, 2})}};
    for (const std::vector<config::Compound>& form : forms) {
        config::Configuration made = withChildren(form);
        made.compounds[0].buffers = kWithDepth;
        const auto got = pictures(made, wholeCanvas(), scene);
        RC_ASSERT(got.size() == 1U);
        RC_ASSERT(differingPixels(got[0], mixed(scene, drawn, sampled)) == 0);
    }
}

TEST(Compose, ZoomedByHalfEachPixelStandsForFour) {
    config::Compound half = source(1);
    half.zoom = {.5, .5};
    PlanRequest request = wholeCanvas();
    request.outputs[0].size = config::PixelSize{40, 24};
    const LayeredScene scene(3);
    const auto plan = makePlan(withChildren({half}), request);
    ASSERT_TRUE(plan.ok());
    ASSERT_EQ(plan->draws.size(), 1U);
    const fabric::ChannelTask& task = plan->draws[0].task;
    EXPECT_EQ(task.raster, (fabric::Raster{20, 12, {0, 0}, {2, 2}}));
    EXPECT_EQ(task.viewWidth, 40);
    fabric::Image small = fabric::makeImage(task.pixelViewport, LayeredScene::kBackground, false);
    fabric::paste(scene.draw(task).image, small);
    const auto got = composePictures(*plan, {small}, LayeredScene::kBackground);
    for (std::size_t y = 0; y < 24; ++y)
        for (std::size_t x = 0; x < 40; ++x)
            ASSERT_EQ(got[0].colour[y * 40 + x], small.colour[y / 2 * 20 + x / 2]);
}

/// Halves of a picture zoomed by .7 meet as if it were one: but for the columns beside the seam,
/// which know nothing of their neighbours on the other side.
TEST(Compose, PartsOfAZoomedPictureMeet) {
    const LayeredScene scene(3);
    config::Compound whole = source(1);
    whole.zoom = {.7, .7};
    config::Compound left = source(1);
    left.viewport = {0, 0, .5, 1};
    config::Compound right = source(2);
    right.viewport = {.5, 0, .5, 1};
    config::Compound group;
    group.zoom = {.7, .7};
    group.children = {left, right};
    config::Configuration halves = withChildren({group});
    for (const config::Compound& child : {left, right})
        halves.compounds[0].inputFrames.push_back(
            RandomCompounds::frame(child.outputFrames.at(0).name));
    const auto expected = pictures(withChildren({whole}), wholeCanvas(), scene);
    const auto got = pictures(halves, wholeCanvas(), scene);
    ASSERT_EQ(expected.size(), 1U);
    ASSERT_EQ(got.size(), 1U);
    const auto isBackground = [](const fabric::Rgba& pixel) {
        return pixel == LayeredScene::kBackground;
    };
    EXPECT_LT(differingPixels(expected[0], got[0]), 4 * kSize.height);
    for (std::size_t i = 0; i < expected[0].colour.size(); ++i)
        EXPECT_TRUE(isBackground(expected[0].colour[i]) || !isBackground(got[0].colour[i])) << i;
}

TEST(Compose, ZoomedByTwoEachPixelIsTheMeanOfFour) {
    config::Compound twice = source(1);
    twice.zoom = {2, 2};
    const LayeredScene scene(3);
    const auto plan = makePlan(withChildren({twice}), wholeCanvas());
    ASSERT_TRUE(plan.ok());
    const fabric::ChannelTask& task = plan->draws[0].task;
    fabric::Image large = fabric::makeImage(task.pixelViewport, LayeredScene::kBackground, false);
    fabric::paste(scene.draw(task).image, large);
    ASSERT_EQ(large.area.width, 82);
    const auto got = composePictures(*plan, {large}, LayeredScene::kBackground);
    for (std::size_t y = 0; y < 23; ++y)
        for (std::size_t x = 0; x < 41; ++x) {
            const std::size_t at = 2 * y * 82 + 2 * x;
            const int sum = large.colour[at].r + large.colour[at + 1].r + large.colour[at + 82].r +
                            large.colour[at + 83].r;
            ASSERT_EQ(got[0].colour[y * 41 + x].r, (sum + 2) / 4) << x << " " << y;
        }
}

}  // namespace
}  // namespace eyrie::compound
