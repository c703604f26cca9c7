// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fabric/box.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::terrain {

/// Boxes that together hold all that any form of a tile draws; object space, metres. Together they
/// are much smaller than EytIndex::bounds: one for each of the tile's 4 x 4 parts (fewer at the two
/// finest levels), as high as the source there and the part's error more; as the tile where the
/// outline of a hole may be off, since what is drawn over a hole may be as high as any of it.
std::vector<fabric::Box> partBounds(const EytIndex& index, const TileId& tile);

}  // namespace eyrie::terrain
