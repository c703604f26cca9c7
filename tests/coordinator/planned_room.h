// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/compound/plan.h"
#include "coordinator/config/eqc_reader.h"

namespace eyrie::compound {

/// Channels "a" to "d" of 640 x 480, and these canvases, layouts and compounds.
inline config::Configuration room(const std::string& rest) {
    std::string windows;
    for (const char name : {'a', 'b', 'c', 'd'})
        windows += std::string("pipe { window { viewport [ 0 0 640 480 ] channel { name \"") +
                   name + "\" } } } ";
    config::Findings findings;
    config::Configuration configuration =
        config::readEqc("config { appNode { " + windows + " } " + rest + " }", findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

inline constexpr const char* kWall =
    "wall { bottom_left [ -2 -1 -2 ] bottom_right [ 2 -1 -2 ] top_left [ -2 1 -2 ] }";

/// Two segments beside each other on one wall.
inline config::Configuration powerWall(const std::string& compounds = {}) {
    std::string text = "observer { eye_base .1 } layout { view { observer 0 } } canvas { layout 0 ";
    text += kWall;
    text +=
        " segment { channel \"a\" viewport [ 0 0 .5 1 ] }"
        " segment { channel \"b\" viewport [ .5 0 .5 1 ] } } ";
    return room(text + compounds);
}

/// All of the first canvas, at this size.
inline PlanRequest canvasOf(std::int32_t width, std::int32_t height) {
    PlanRequest request;
    request.outputs.resize(1);
    request.outputs[0].size = config::PixelSize{width, height};
    return request;
}

/// The plan; fails the test where there is none.
inline Plan planned(const config::Configuration& configuration, const PlanRequest& request) {
    const auto plan = makePlan(configuration, request);
    EXPECT_TRUE(plan.ok()) << plan.status();
    return plan.ok() ? *plan : Plan{};
}

}  // namespace eyrie::compound
