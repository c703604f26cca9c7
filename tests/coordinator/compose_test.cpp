// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/compose.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "composed_pictures.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/one_channel.h"
#include "layered_scene.h"
#include "random_compounds.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

/// What is asked of one layout on one canvas: the whole of it and each of its segments.
std::vector<Output> outputsOf(const config::Configuration& configuration, std::size_t canvas) {
    std::vector<Output> outputs(1);
    outputs[0].canvas = canvas;
    for (std::size_t i = 0; i < configuration.canvases[canvas].segments.size(); ++i) {
        outputs.push_back(outputs[0]);
        outputs.back().segment = i;
        outputs.back().size = config::PixelSize{60, 48};
    }
    outputs[0].size = config::PixelSize{120, 64};
    return outputs;
}

/// Whether pixels are means or resampled: such pictures have definitions of their own.
bool hasMixedPixels(const Plan& plan) {
    for (const Step& step : plan.steps) {
        if (std::holds_alternative<Average>(step))
            return true;
        if (const auto* const assembled = std::get_if<Assemble>(&step))
            for (const fabric::Regridding& each : assembled->regriddings)
                if (each.kind == fabric::Regridding::Kind::Zoom)
                    return true;
    }
    return false;
}

/// Every canvas and segment in every layout of a file.
std::vector<PlanRequest> everythingOf(const config::Configuration& configuration) {
    std::vector<PlanRequest> requests;
    for (std::size_t canvas = 0; canvas < configuration.canvases.size(); ++canvas)
        for (std::size_t layout = 0; layout < configuration.canvases[canvas].layouts.size();
             ++layout)
            for (const Output& output : outputsOf(configuration, canvas)) {
                PlanRequest request;
                request.outputs = {output};
                // Monitors show other canvases, whichever those show.
                request.display.canvases.resize(configuration.canvases.size());
                request.display.canvases[canvas].layout = layout;
                requests.push_back(request);
            }
    return requests;
}

TEST(Compose, EveryFileOfEqualizersMakesThePicturesOfOneChannel) {
    const LayeredScene scene(5, 41, 23, 30, true);
    int compared = 0;
    int mixed = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.path().extension() != ".eqc")
            continue;
        const config::Configuration configuration = sample(entry.path());
        const config::Configuration plain = config::oneChannel(configuration);
        for (const PlanRequest& request : everythingOf(configuration)) {
            const auto plan = makePlan(configuration, request);
            ASSERT_TRUE(plan.ok()) << entry.path() << plan.status();
            if (hasMixedPixels(*plan)) {
                ++mixed;
                continue;
            }
            const auto got = composePictures(*plan, drawn(*plan, scene), LayeredScene::kBackground);
            const auto expected = pictures(plain, request, scene);
            ASSERT_EQ(got.size(), expected.size());
            const Output& output = request.outputs.front();
            for (std::size_t i = 0; i < got.size(); ++i, ++compared)
                EXPECT_EQ(differingPixels(got[i], expected[i]), 0)
                    << entry.path().filename() << " canvas " << output.canvas << " layout "
                    << *request.display.canvases[output.canvas].layout << " segment "
                    << (output.segment ? static_cast<int>(*output.segment) : -1);
        }
    }
    EXPECT_GT(compared, 200);
    EXPECT_GT(mixed, 0);
}

/// Of few rectangles most ranges have none: renderers answer with nothing.
RC_GTEST_PROP(Compose, AnyTreeOfCompoundsMakesThePicturesOfOneChannel, (std::uint32_t seed)) {
    const LayeredScene scene(seed, 41, 23, *rc::gen::element(0, 1, 2, 30));
    const config::Configuration configuration = RandomCompounds(seed).configuration(4);
    PlanRequest request = wholeCanvas();
    request.outputs[0].stereo = *rc::gen::element(Stereo::Configured, Stereo::Separate,
                                                  Stereo::SideBySide, Stereo::TopBottom);
    request.outputs[0].wantsDepth = *rc::gen::arbitrary<bool>();
    if (*rc::gen::arbitrary<bool>())
        request.outputs[0].part = fabric::PixelViewport{3, 5, 30, 11};
    const auto got = pictures(configuration, request, scene);
    RC_ASSERT(!got.empty());
    RC_ASSERT(got == pictures(config::oneChannel(configuration), request, scene));
}

/// Whoever lends them has them back, and finds them as they were.
RC_GTEST_PROP(Compose, PicturesThatAreLentAreReadWhereTheyLie, (std::uint32_t seed)) {
    const LayeredScene scene(seed, 41, 23, *rc::gen::element(0, 1, 2, 30));
    PlanRequest request = wholeCanvas();
    request.outputs[0].wantsDepth = *rc::gen::arbitrary<bool>();
    const auto plan = makePlan(RandomCompounds(seed).configuration(4), request);
    RC_ASSERT(plan.ok());
    std::vector<std::shared_ptr<const fabric::Image>> kept;
    std::vector<fabric::LentImage> lent;
    for (const PlannedDraw& draw : plan->draws) {
        kept.push_back(std::make_shared<const fabric::Image>(scene.draw(draw.task).image));
        lent.emplace_back(*kept.back(), kept.back());
    }
    const auto got = composePictures(*plan, std::move(lent), LayeredScene::kBackground);
    RC_ASSERT(got == composePictures(*plan, drawn(*plan, scene), LayeredScene::kBackground));
    for (std::size_t i = 0; i < kept.size(); ++i) {
        RC_ASSERT(kept[i].use_count() == 1);
        RC_ASSERT(*kept[i] == scene.draw(plan->draws[i].task).image);
    }
}

RC_GTEST_PROP(Compose, ChannelsThatTakeTurnsMakeEveryFrame, (std::uint32_t seed)) {
    const LayeredScene scene(seed);
    const int period = *rc::gen::inRange(2, 6);
    const config::Configuration configuration = RandomCompounds(seed).timeMultiplexed(period);
    PlanRequest request = wholeCanvas();
    for (int frame = 0; frame < period + 1; ++frame) {
        request.frameNumber = static_cast<std::uint64_t>(frame);
        const auto plan = makePlan(configuration, request);
        RC_ASSERT(plan.ok());
        for (const PlannedDraw& draw : plan->draws)
            RC_ASSERT(draw.task.frameNumber == request.frameNumber);
        RC_ASSERT(pictures(configuration, request, scene) ==
                  pictures(config::oneChannel(configuration), request, scene));
    }
}

}  // namespace
}  // namespace eyrie::compound
