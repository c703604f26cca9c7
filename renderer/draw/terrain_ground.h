// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/ground.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// How high and low a terrain reaches, from its index alone: a cell is a tile of the finest level
/// of which at most `maxCells` (1 or more) cover the terrain. `worldFromObject` is not exaggerated.
fabric::GroundGrid groundOf(const terrain::EytIndex& index, const fabric::Mat4& worldFromObject,
                            int maxCells);

}  // namespace eyrie::draw
