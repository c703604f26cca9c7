// SPDX-License-Identifier: Apache-2.0
// Plans of Equalizer's configurations in which anything may have been overwritten.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/eqc_reader.h"
#include "layered_scene.h"
#include "planned_room.h"

namespace eyrie::compound {
namespace {

using coordinator::LayeredScene;

constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

/// What may stand anywhere, sensible or not.
double anyNumber(std::mt19937& random) {
    static constexpr double kOdd[] = {0,
                                      1,
                                      .5,
                                      .25,
                                      -1,
                                      2,
                                      1e-12,
                                      1e300,
                                      -1e300,
                                      std::numeric_limits<double>::quiet_NaN(),
                                      std::numeric_limits<double>::infinity()};
    return random() % 2 == 0 ? static_cast<double>(random() % 1001) / 1000
                             : kOdd[random() % std::size(kOdd)];
}

config::Compound& anyCompound(std::vector<config::Compound>& among, std::mt19937& random) {
    config::Compound& found = among[random() % among.size()];
    return found.children.empty() || random() % 3 == 0 ? found
                                                       : anyCompound(found.children, random);
}

void editNumbers(config::Compound& compound, std::mt19937& random) {
    const auto small = [&] { return static_cast<std::int64_t>(random() % 5) - 1; };
    switch (random() % 6) {
        case 0:
            compound.viewport = {anyNumber(random), anyNumber(random), anyNumber(random),
                                 anyNumber(random)};
            break;
        case 1:
            compound.range = {anyNumber(random), anyNumber(random)};
            break;
        case 2:
            compound.pixel = {small(), small(), small() + 1, small() + 1};
            break;
        case 3:
            compound.subpixel = {small(), small()};
            break;
        case 4:
            compound.zoom = {anyNumber(random), anyNumber(random)};
            break;
        default:
            compound.period = small() + 1;
            compound.phase = small();
    }
}

void editShape(config::Configuration& configuration, config::Compound& compound,
               std::mt19937& random) {
    config::Compound& other = anyCompound(configuration.compounds, random);
    switch (random() % 6) {
        case 0:
            compound.channel = other.channel;
            break;
        case 1:
            compound.children.clear();
            break;
        case 2:
            std::swap(compound.inputFrames, other.inputFrames);
            break;
        case 3:
            std::swap(compound.outputFrames, other.outputFrames);
            break;
        case 4:
            compound.tasks = config::Tasks{random() % 2 == 0, random() % 2 == 0, random() % 2 == 0,
                                           random() % 2 == 0};
            break;
        default:
            for (config::Frame& frame : compound.outputFrames) {
                frame.viewport.height = anyNumber(random);
                frame.zoom = fabric::Vec2(anyNumber(random), 1);
            }
            for (config::Frame& frame : compound.inputFrames) {
                frame.viewport.x = anyNumber(random);
                frame.zoom = fabric::Vec2(1, anyNumber(random));
            }
    }
}

void edit(config::Configuration& configuration, std::mt19937& random) {
    if (configuration.compounds.empty())
        return;
    for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
        config::Compound& compound = anyCompound(configuration.compounds, random);
        if (random() % 2 == 0)
            editNumbers(compound, random);
        else
            editShape(configuration, compound, random);
    }
}

TEST(Plan, CopesWithWhateverABalancerOrAnEditorWrites) {
    std::mt19937 random(11);
    const LayeredScene scene(1);
    int refused = 0;
    int composed = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        config::Findings findings;
        const config::Configuration whole = config::readEqc(text, findings);
        for (int i = 0; i < 20; ++i) {
            config::Configuration edited = whole;
            edit(edited, random);
            PlanRequest request = canvasOf(48, 32);
            request.frameNumber = random();
            request.outputs[0].stereo = static_cast<Stereo>(random() % 5);
            const auto plan = makePlan(edited, request);
            if (!plan.ok()) {
                ++refused;
                EXPECT_EQ(plan.status().code(), absl::StatusCode::kInvalidArgument);
                continue;
            }
            ++composed;
            std::vector<fabric::LentImage> drawn;
            std::int64_t pixels = 0;
            for (const PlannedDraw& draw : plan->draws) pixels += draw.task.pixelViewport.area();
            if (pixels > 200'000)
                continue;
            for (const PlannedDraw& draw : plan->draws)
                drawn.push_back(scene.draw(draw.task).image);
            EXPECT_EQ(composePictures(*plan, std::move(drawn), {}).size(), plan->pictures.size());
        }
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(composed, 100);
}

}  // namespace
}  // namespace eyrie::compound
