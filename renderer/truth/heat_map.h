// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/image.h"

namespace eyrie::truth {

/// Beyond what is promised: magenta, which the ramp does not have.
inline constexpr fabric::Rgba kBeyondColour{255, 0, 170, 255};
/// Where nothing is compared.
inline constexpr fabric::Rgba kNothingColour{24, 24, 28, 255};

/// Displacement per pixel as colours, the same for equal displacements whatever the picture: from 0
/// to `scalePixels` along viridis (S. van der Walt, N. Smith, 2015; even steps look even, in grey
/// too), kBeyondColour above, kNothingColour where there is none (NaN). Rows from the bottom up.
fabric::Image heatMap(std::span<const float> displacements, int width, int height,
                      double scalePixels);

}  // namespace eyrie::truth
