// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace eyrie::truth {
namespace {

using fabric::Rgba;

/// Of viridis, every eighth of the way; linear between these.
constexpr std::array<Rgba, 9> kRamp = {{{68, 1, 84},
                                        {71, 44, 122},
                                        {59, 81, 139},
                                        {44, 113, 142},
                                        {33, 144, 141},
                                        {39, 173, 129},
                                        {92, 200, 99},
                                        {170, 220, 50},
                                        {253, 231, 37}}};

std::uint8_t between(std::uint8_t a, std::uint8_t b, double share) {
    return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
}

Rgba rampColour(double share) {
    const double place = share * static_cast<double>(kRamp.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
    const double rest = place - static_cast<double>(below);
    const Rgba& a = kRamp[below];
    const Rgba& b = kRamp[below + 1];
    return {between(a.r, b.r, rest), between(a.g, b.g, rest), between(a.b, b.b, rest)};
}

}  // namespace

fabric::Image heatMap(std::span<const float> displacements, int width, int height,
                      double scalePixels) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, kNothingColour, false);
    for (std::size_t i = 0; i < displacements.size(); ++i) {
        const double share = displacements[i] / scalePixels;
        if (share > 1)
            image.colour[i] = kBeyondColour;
        else if (!std::isnan(share))
            image.colour[i] = rampColour(share);
    }
    return image;
}

}  // namespace eyrie::truth
