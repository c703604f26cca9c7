// SPDX-License-Identifier: Apache-2.0
// Pictures that renderers compose among themselves, by the programs they are handed.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "composed_pictures.h"
#include "coordinator/compound/compose.h"
#include "coordinator/compound/exchange.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/default_config.h"
#include "coordinator/config/one_channel.h"
#include "fabric/channel_buffer.h"
#include "layered_scene.h"
#include "random_compounds.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

/// Programs as renderers carry them out, each as far as it can get.
std::vector<fabric::Image> answersOf(const Exchange& exchange, const LayeredScene& scene) {
    struct Run {
        fabric::ChannelBuffer buffer;
        std::size_t stage = 0;
        std::size_t output = 0;
        std::vector<fabric::Image> answers = {};
    };
    std::vector<Run> runs;
    for (const PlannedProgram& each : exchange.programs)
        runs.push_back({{each.program.area, LayeredScene::kBackground, each.program.hasDepth}});
    std::map<std::pair<std::size_t, std::uint32_t>, fabric::Image> mail;
    bool isMoving = true;
    while (std::exchange(isMoving, false))
        for (std::size_t p = 0; p < runs.size(); ++p) {
            const fabric::ChannelProgram& program = exchange.programs[p].program;
            Run& run = runs[p];
            if (run.stage == program.stages.size())
                continue;
            const fabric::ProgramStage& stage = program.stages[run.stage];
            if (!std::ranges::all_of(stage.inputs, [&](const fabric::ProgramInput& input) {
                    return mail.contains({p, input.frame});
                }))
                continue;
            if (stage.draw)
                run.buffer.put(scene.draw(*stage.draw).image, stage.draw->pixelViewport,
                               program.hasDepth && stage.draw->wantsDepth
                                   ? fabric::Merge::DepthBehind
                                   : fabric::Merge::Paste);
            for (const fabric::ProgramInput& input : stage.inputs)
                run.buffer.put(mail.at({p, input.frame}), input.area, input.merge);
            for (const fabric::ProgramOutput& output : stage.outputs) {
                fabric::Image part = run.buffer.part(output.area, output.withDepth);
                const auto& taker = exchange.programs[p].takers.at(run.output++);
                if (taker)
                    mail[{*taker, output.frame}] = std::move(part);
                else
                    run.answers.push_back(std::move(part));
            }
            ++run.stage;
            isMoving = true;
        }
    std::vector<fabric::Image> answers;
    for (std::size_t p = 0; p < runs.size(); ++p) {
        EXPECT_EQ(runs[p].stage, exchange.programs[p].program.stages.size()) << "it waits for ever";
        std::ranges::move(runs[p].answers, std::back_inserter(answers));
    }
    return answers;
}

std::vector<fabric::Image> picturesByPrograms(const Exchange& exchange, const LayeredScene& scene) {
    std::vector<fabric::LentImage> images;
    for (std::size_t i = 0; i < exchange.draws.size(); ++i)
        images.push_back(scene.draw(exchange.rest.draws[i].task).image);
    std::ranges::move(answersOf(exchange, scene), std::back_inserter(images));
    return composePictures(exchange.rest, std::move(images), LayeredScene::kBackground);
}

RC_GTEST_PROP(Compose, RenderersAmongThemselvesMakeThePicturesOfOneChannel, (std::uint32_t seed)) {
    const LayeredScene scene(seed, 41, 23, *rc::gen::element(0, 1, 2, 30));
    const config::Configuration configuration = RandomCompounds(seed).configuration(4);
    PlanRequest request = wholeCanvas();
    request.outputs[0].wantsDepth = *rc::gen::arbitrary<bool>();
    const auto plan = makePlan(configuration, request);
    RC_ASSERT(plan.ok());
    const auto exchange = exchangeOf(*plan, request.frameNumber);
    RC_CLASSIFY(exchange.has_value(), "exchanged");
    if (exchange)
        RC_ASSERT(picturesByPrograms(*exchange, scene) ==
                  pictures(config::oneChannel(configuration), request, scene));
}

/// Of five renderers, what they exchange in a layout that is made of them.
config::Configuration madeOfFive() {
    std::vector<config::RendererFacts> renderers(5);
    for (std::size_t i = 0; i < renderers.size(); ++i) renderers[i].id = std::to_string(i);
    return config::defaultConfiguration(renderers);
}

TEST(Compose, DirectSendAndBinarySwapAreExchanged) {
    const LayeredScene scene(5, 41, 23, 30, true);
    const std::filesystem::path folder = kFolder;
    const config::Configuration made = madeOfFive();
    const auto names = config::layoutNames(made);
    const auto directSend = std::ranges::find(names, "direct-send") - names.begin();
    for (const auto& [configuration, layout] :
         {std::pair(made, static_cast<std::size_t>(directSend)),
          {sample(folder / "4-window.DB.bs.eqc"), 0},
          {sample(folder / "2-pipe.DB.ds.eqc"), 0}}) {
        PlanRequest request = wholeCanvas();
        request.display.canvases.resize(1);
        request.display.canvases[0].layout = layout;
        const auto plan = makePlan(configuration, request);
        ASSERT_TRUE(plan.ok()) << plan.status();
        const auto exchange = exchangeOf(*plan, 0);
        ASSERT_TRUE(exchange.has_value());
        const auto got = picturesByPrograms(*exchange, scene);
        ASSERT_EQ(got.size(), 1U);
        EXPECT_EQ(
            differingPixels(got[0], pictures(config::oneChannel(configuration), request, scene)[0]),
            0);
    }
}

}  // namespace
}  // namespace eyrie::compound
