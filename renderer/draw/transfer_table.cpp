// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/transfer_table.h"

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

std::uint8_t byte(double share) { return static_cast<std::uint8_t>(std::lround(share * 255)); }

}  // namespace

std::vector<std::uint8_t> transferTable(const fabric::TransferFunction& function,
                                        double lowestMetres, double reliefMetres) {
    std::vector<fabric::Tint> tints;
    for (int i = 0; i < kTransferTexels; ++i) {
        const double share = static_cast<double>(i) / (kTransferTexels - 1);
        tints.push_back(fabric::evaluate(function, function.unit == fabric::HeightUnit::Relative
                                                       ? share
                                                       : lowestMetres + share * reliefMetres));
    }
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
