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
/// Looking it up costs the same for any function; on llvmpipe evaluating six primitives in every
/// pixel costs half as much again (docs/benchmarks.md). The table is off by half of 1/255 a channel
/// by rounding, and spreads each edge of a box over a 2047th of the relief; narrower primitives are
/// that wide, and so never lost. Where nothing is coloured texels have their neighbours' colour, so
/// that filtering does not darken what fades out.
std::vector<std::uint8_t> transferTable(const fabric::TransferFunction& function,
                                        double lowestMetres, double reliefMetres);

}  // namespace eyrie::draw
