// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fabric/transfer_function.h"

namespace eyrie::draw {

/// Texels of a transfer function's table; effects/terrain.effect knows it too.
inline constexpr int kTransferTexels = 2048;

/// A transfer function for one terrain's range of heights as texels to be filtered between: r, g, b
/// as displayed and opacity, 8 bits each, the first at `lowestMetres`, the last `reliefMetres`
/// above.
///
/// A shader that evaluated every primitive in every pixel takes longer, on llvmpipe, than it takes
/// to draw all else (docs/benchmarks.md). The table costs a 510th of the range of each channel by
/// rounding, and spreads each edge of a box over a 2047th of the relief. Where nothing is coloured
/// texels have their neighbours' colour, so that filtering does not darken what fades out.
std::vector<std::uint8_t> transferTable(const fabric::TransferFunction& function,
                                        double lowestMetres, double reliefMetres);

}  // namespace eyrie::draw
