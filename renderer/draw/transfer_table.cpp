// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/transfer_table.h"

#include <algorithm>
#include <cmath>

#include <glm/exponential.hpp>

namespace eyrie::draw {
namespace {

/// Gives what has no colour that of the nearest with one on the side where `at` comes from.
template <typename Index>
void spread(std::vector<fabric::Tint>& tints, Index at) {
    const fabric::Tint* last = nullptr;
    for (std::size_t i = 0; i < tints.size(); ++i) {
        fabric::Tint& tint = tints[at(i)];
        const bool isBare = tint.opacity == 0 && tint.colour == fabric::Vec3(0);
        if (!isBare)
            last = &tint;
        else if (last != nullptr)
            tint.colour = last->colour;
    }
}

/// None between two texels, where nobody would see it.
fabric::TransferFunction atLeastATexelWide(fabric::TransferFunction function, double relief) {
    for (fabric::TransferPrimitive& primitive : function.primitives)
        primitive.width = std::max(primitive.width, relief / (kTransferTexels - 1));
    return function;
}

std::uint8_t byte(double share) { return static_cast<std::uint8_t>(std::lround(share * 255)); }

}  // namespace

std::vector<std::uint8_t> transferTable(const fabric::TransferFunction& function,
                                        double lowestMetres, double reliefMetres) {
    const bool isRelative = function.unit == fabric::HeightUnit::Relative;
    const double lowest = isRelative ? 0 : lowestMetres;
    const double relief = isRelative ? 1 : reliefMetres;
    const fabric::TransferFunction drawn = atLeastATexelWide(function, relief);
    std::vector<fabric::Tint> tints;
    for (int i = 0; i < kTransferTexels; ++i)
        tints.push_back(fabric::evaluate(
            drawn, lowest + static_cast<double>(i) / (kTransferTexels - 1) * relief));
    spread(tints, [&](std::size_t i) { return i; });
    spread(tints, [&](std::size_t i) { return tints.size() - 1 - i; });
    std::vector<std::uint8_t> texels;
    for (const fabric::Tint& tint : tints) {
        const fabric::Vec3 displayed = glm::sqrt(tint.colour);
        for (int channel = 0; channel < 3; ++channel) texels.push_back(byte(displayed[channel]));
        texels.push_back(byte(tint.opacity));
    }
    return texels;
}

}  // namespace eyrie::draw
