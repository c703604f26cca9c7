// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "fabric/box.h"
#include "fabric/vec.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::terrain {

/// Whether data and nodata may meet where one who looks from `eye` at what lies in `target` looks
/// across: seen from above, on a line from the one to the other, nearer to the eye than all of
/// `target`, and than `reach` metres. Object space; heights do not count. As fine as the index
/// tells, which is 8 x 8 cells.
bool hasHoleBefore(const EytIndex& index, const fabric::Vec2& eye, const fabric::Box& target,
                   double reach = std::numeric_limits<double>::infinity());

}  // namespace eyrie::terrain
