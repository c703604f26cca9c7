// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/compound/compose.h"
#include "coordinator/compound/plan.h"
#include "coordinator/config/eqc_reader.h"
#include "layered_scene.h"
#include "random_compounds.h"

namespace eyrie::compound {

/// Equalizer's files.
inline constexpr const char* kFolder = EYRIE_SOURCE_DIR "/../shared/data/eqc";

inline config::Configuration sample(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path << " is missing";
    config::Findings findings;
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return config::readEqc(text, findings);
}

/// What renderers answer.
inline std::vector<fabric::LentImage> drawn(const Plan& plan,
                                            const coordinator::LayeredScene& scene) {
    std::vector<fabric::LentImage> images;
    for (const PlannedDraw& draw : plan.draws) images.push_back(scene.draw(draw.task).image);
    return images;
}

/// Planned, drawn and composed. Fails the test where there is no plan.
inline std::vector<fabric::Image> pictures(const config::Configuration& configuration,
                                           const PlanRequest& request,
                                           const coordinator::LayeredScene& scene) {
    const auto plan = makePlan(configuration, request);
    EXPECT_TRUE(plan.ok()) << plan.status();
    if (!plan.ok())
        return {};
    return composePictures(*plan, drawn(*plan, scene), coordinator::LayeredScene::kBackground);
}

/// In colour; -1 where the areas differ.
inline int differingPixels(const fabric::Image& a, const fabric::Image& b) {
    if (a.area != b.area)
        return -1;
    int count = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) count += a.colour[i] == b.colour[i] ? 0 : 1;
    return count;
}

inline constexpr config::PixelSize kSize{41, 23};

inline PlanRequest wholeCanvas() {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = kSize;
    return request;
}

/// A room of one view on channel 0 whose compound has these children, and takes all their frames.
inline config::Configuration withChildren(std::vector<config::Compound> children) {
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

/// A compound that draws on this channel and hands its picture on, as a frame named for it.
inline config::Compound source(std::size_t channel) {
    config::Compound made;
    made.channel = RandomCompounds::at(channel);
    made.outputFrames.push_back(RandomCompounds::frame("f" + std::to_string(channel)));
    return made;
}

}  // namespace eyrie::compound
