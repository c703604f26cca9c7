// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/tint.h"

#include <cmath>
#include <numbers>

namespace eyrie::draw {
namespace {

/// Three cosines a third of the circle apart; squared for linear light.
glm::vec3 ofHue(float radians) {
    constexpr float kThird = 2.0943951F;
    const auto channel = [&](float phase) {
        const float displayed = 0.55F + 0.4F * std::cos(radians + phase);
        return displayed * displayed;
    };
    return {channel(0), channel(kThird), channel(2 * kThird)};
}

}  // namespace

glm::vec3 levelColour(int level) {
    constexpr float kGolden = 2.39996323F;  // a golden section of the circle
    return ofHue(kGolden * static_cast<float>(level));
}

glm::vec3 rangeColour(const fabric::Range& range) {
    return ofHue(std::numbers::pi_v<float> * static_cast<float>(range.begin + range.end));
}

}  // namespace eyrie::draw
