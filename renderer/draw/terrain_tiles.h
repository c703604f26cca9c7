// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "renderer/gl/object.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// A tile on the device: words and indices in one buffer, and its normal map. GL thread.
struct DeviceTile {
    /// Copies `geometry`, which must not be empty.
    explicit DeviceTile(const terrain::TileGeometry& geometry);

    gl::Buffer buffer;
    gl::Texture2D normalMap;
    GLintptr indexOffset = 0;
    GLsizei vertexStride = 4;
    std::array<terrain::IndexRange, terrain::kTileParts> parts;
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 1;
};

/// What DeviceTile takes of the device.
std::uint64_t deviceBytes(const terrain::TileGeometry& geometry);

/// What a tile of so many triangles and cells takes, judged before it is read: usually a little
/// more than it turns out to be. The same on every machine.
std::uint64_t estimatedTileBytes(std::uint32_t triangles, std::int32_t cells);

/// What it takes at most. Of an empty tile: 0.
std::uint64_t greatestTileBytes(std::uint32_t triangles, std::int32_t cells);

}  // namespace eyrie::draw
