// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "fabric/vec.h"

namespace eyrie::compound {

/// Where in a pixel sample `index` of `count` lies, from the pixel's centre, in pixels: within half
/// a pixel, each in a column and a row of its own, so that edges near either axis show as many
/// steps as there are samples. One sample is the centre.
///
/// The row of each column is by a table for 2, 3, 4, 8 and 16 samples. Otherwise rows follow the
/// columns' numbers with their bits reversed: the order of the set of J. M. Hammersley, "Monte
/// Carlo Methods for Solving Multivariable Problems" (1960), on a grid that is centred for any
/// count.
fabric::Vec2 jitter(std::int64_t index, std::int64_t count);

}  // namespace eyrie::compound
