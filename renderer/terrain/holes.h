// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "fabric/box.h"
#include "fabric/vec.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::terrain {

/// Whether data and nodata may meet where one who looks from `eye` at what lies in `target` looks
/// across: seen from above, on a line from the one to the other, nearer to the eye than all of
/// `target`, and than `reach` metres. Object space; heights do not count. As fine as the index
/// tells, which is 8 x 8 cells; in the tiles of `blurred` (places in index.tiles, ascending), which
/// are drawn with outlines that may be off, as fine as their parts: what is drawn in one need not
/// be above or below ground that is as near as its error says.
bool hasHoleBefore(const EytIndex& index, const fabric::Vec2& eye, const fabric::Box& target,
                   std::span<const std::uint32_t> blurred = {},
                   double reach = std::numeric_limits<double>::infinity());

}  // namespace eyrie::terrain
