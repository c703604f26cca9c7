// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/compose.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "coordinator/compound/exchange.h"
#include "coordinator/compound/jitter.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/default_config.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/one_channel.h"
#include "fabric/channel_buffer.h"
#include "layered_scene.h"
#include "random_compounds.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

config::Configuration sample(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    config::Findings findings;
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return config::readEqc(text, findings);
}

std::vector<fabric::LentImage> drawn(const Plan& plan, const LayeredScene& scene) {
    std::vector<fabric::LentImage> images;
    for (const PlannedDraw& draw : plan.draws) images.push_back(scene.draw(draw.task).image);
    return images;
}

std::vector<fabric::Image> pictures(const config::Configuration& configuration,
                                    const PlanRequest& request, const LayeredScene& scene) {
    const auto plan = makePlan(configuration, request);
    EXPECT_TRUE(plan.ok()) << plan.status();
    if (!plan.ok())
        return {};
    return composePictures(*plan, drawn(*plan, scene), LayeredScene::kBackground);
}

int differingPixels(const fabric::Image& a, const fabric::Image& b) {
    if (a.area != b.area)
        return -1;
    int count = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) count += a.colour[i] == b.colour[i] ? 0 : 1;
    return count;
}

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

constexpr config::PixelSize kSize{41, 23};

PlanRequest wholeCanvas() {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = kSize;
    return request;
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

/// A room of one view on channel 0 whose compound has these children, and takes all their frames.
config::Configuration withChildren(std::vector<config::Compound> children) {
    config::Configuration made = RandomCompounds(0).configuration(0);
    made.layouts[0].views[0].isStereo = false;
    made.canvases[0].segments.resize(1);
    made.canvases[0].segments[0].viewport = {};
    config::Compound root;
    root.channel = config::DestinationIndex{0, 0, 0, 0};
    for (const config::Compound& child : children)
        for (const config::Frame& frame : child.outputFrames)
            root.inputFrames.push_back(RandomCompounds::frame(frame.name));
    root.children = std::move(children);
    made.compounds = {root};
    return made;
}

config::Compound source(std::size_t channel) {
    config::Compound made;
    made.channel = RandomCompounds::at(channel);
    made.outputFrames.push_back(RandomCompounds::frame("f" + std::to_string(channel)));
    return made;
}

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
