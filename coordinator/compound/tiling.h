// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "coordinator/compound/plan.h"
#include "fabric/viewport.h"

namespace eyrie::compound {

/// What a draw makes, as a part of a picture.
struct Tile {
    std::size_t draw = 0;        ///< in Plan::draws
    fabric::PixelViewport area;  ///< in the pixels of Picture::area, as large as the draw's

    bool operator==(const Tile&) const = default;
};

/// The draws that the only picture of a plan is laid out of, side by side: pure 2D, where nothing
/// is composited, scaled or mixed, and no depth is wanted. Together they are all of the picture.
/// Nothing for every other plan.
std::optional<std::vector<Tile>> tilesOf(const Plan& plan);

}  // namespace eyrie::compound
