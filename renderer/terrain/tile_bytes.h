// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "renderer/terrain/eyt_format.h"

/// What tiles take in memory, known and foretold.
namespace eyrie::terrain {

/// On the device.
inline std::uint64_t tileBytes(const TileGeometry& geometry) {
    return geometry.wordBytes() + (geometry.indexBytes() + 3) / 4 * 4 +
           geometry.normals.size_bytes();
}

/// What a tile will take, judged by its record: usually a little too much. The same on every
/// machine. 0 for a tile without triangles or normals.
std::uint64_t estimatedTileBytes(const EytIndex& index, const TileId& tile);

/// What a tile, or a page with its tables, takes at most.
std::uint64_t greatestTileBytes(const EytIndex& index, const TileId& tile);
std::uint64_t greatestPageBytes(const EytIndex& index, std::uint32_t page);

}  // namespace eyrie::terrain
