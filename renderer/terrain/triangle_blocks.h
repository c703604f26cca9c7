// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "fabric/box.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {

/// Triangles that follow each other in a tile's index list, and between what they lie. The list
/// goes through the tile as its triangulation does, by halves of halves, so that is a small part.
struct TriangleBlock {
    std::uint32_t first = 0;  ///< in the index list
    std::uint32_t count = 0;
    TileVertex low;
    TileVertex high;
};

/// All of a tile's triangles, none across the end of a part. Nothing for a tile without indices:
/// read as an outline, or empty.
std::vector<TriangleBlock> triangleBlocks(const TileGeometry& geometry);

/// What a block of the tile holds; object space, metres.
fabric::Box bounds(const EytIndex& index, const TileId& tile, const TriangleBlock& block);

}  // namespace eyrie::terrain
