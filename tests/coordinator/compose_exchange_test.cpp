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
            for (const fabric::ProgramInput& input : stage.inputs) {
                fabric::Image& image = mail.at({p, input.frame});
                EXPECT_TRUE(image.area.isEmpty() || input.area.contains(image.area))
                    << "more comes than was announced";
                run.buffer.put(image, input.area, input.merge);
            }
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

/// Three channels, and a compound on the first's picture with what is written here.
config::Configuration ofThree(const std::string& compounds) {
    config::Findings findings;
    std::string text = "server { config { appNode {";
    for (const char* name : {"a", "b", "c"})
        text += std::string("pipe { window { viewport [ 0 0 41 23 ] channel { name \"") + name +
                "\" } } }\n";
    text +=
        "} observer {} layout { view { observer 0 } }\n"
        "canvas { layout 0 segment { channel \"a\" } }\n"
        "compound { channel ( canvas 0 segment 0 layout 0 view 0 ) buffer [ COLOR DEPTH ]\n"
        "task [ CLEAR ASSEMBLE ]\n" +
        compounds + "} } }";
    config::Configuration configuration = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << config::describe(findings, "the test's");
    return configuration;
}

void expectExchangedLikePutTogetherHere(const config::Configuration& configuration) {
    const LayeredScene scene(3, 41, 23, 30);
    const PlanRequest request = wholeCanvas();
    const auto plan = makePlan(configuration, request);
    ASSERT_TRUE(plan.ok()) << plan.status();
    const auto exchange = exchangeOf(*plan, 0);
    ASSERT_TRUE(exchange.has_value());
    const auto got = picturesByPrograms(*exchange, scene);
    ASSERT_EQ(got.size(), 1U);
    EXPECT_EQ(differingPixels(got[0], pictures(configuration, request, scene)[0]), 0);
}

/// The coordinator compares depths with what the first channel's program has only passed on.
TEST(Compose, DepthStaysWithWhatAProgramHasOnlyTaken) {
    expectExchangedLikePutTogetherHere(ofThree(R"(
        compound { channel "b" range [ 0 .5 ] outputframe { name "x" } }
        compound { task [ CLEAR ASSEMBLE READBACK ] inputframe { name "x" }
                   outputframe { name "t" buffer [ COLOR ] viewport [ 0 0 .1 1 ] } }
        compound { channel "c"
                   compound { range [ .5 1 ] outputframe { name "y" } } inputframe { name "t" }
                   outputframe { name "z" buffer [ COLOR ] viewport [ 0 0 .1 1 ] } }
        inputframe { name "y" } inputframe { name "z" })"));
}

TEST(Compose, EachThatTakesAFrameIsSentWhatItTakes) {
    expectExchangedLikePutTogetherHere(ofThree(R"(
        compound { channel "a" range [ 0 .34 ] outputframe { name "p1" } }
        compound { channel "b" compound { range [ .34 .67 ] outputframe { name "p2" } }
                   inputframe { name "p1" } inputframe { name "p3" }
                   outputframe { name "s2" viewport [ 0 0 1 .5 ] } }
        compound { channel "c" compound { range [ .67 1 ] outputframe { name "p3" } }
                   inputframe { name "p1" } inputframe { name "p2" }
                   outputframe { name "s3" viewport [ 0 .5 1 .5 ] } }
        inputframe { name "s2" } inputframe { name "s3" })"));
}

/// No two inputs of a program are the same frame.
TEST(Compose, AFrameThatIsTakenTwiceIsPutTogetherHere) {
    const auto plan = makePlan(ofThree(R"(
        compound { channel "c" range [ 0 .5 ] outputframe { name "x" } }
        compound { channel "b" compound { range [ .5 1 ] }
                   inputframe { name "x" } inputframe { name "x" } outputframe { name "s" } }
        inputframe { name "s" })"),
                               wholeCanvas());
    ASSERT_TRUE(plan.ok()) << plan.status();
    EXPECT_FALSE(exchangeOf(*plan, 0).has_value());
}

}  // namespace
}  // namespace eyrie::compound
