// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "renderer/gl/object.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// A tile on the device, where it takes terrain::tileBytes: words and indices in one buffer, and
/// its normal map. Either may be empty: without triangles there is nothing in the buffer, and tiles
/// below Quadtree::normalLevel() are drawn with an ancestor's map. GL thread.
struct DeviceTile {
    /// Copies `geometry`.
    explicit DeviceTile(const terrain::TileGeometry& geometry);

    gl::Buffer buffer;
    std::optional<gl::Texture2D> normalMap;
    GLintptr indexOffset = 0;
    GLsizei vertexStride = 4;
    std::array<terrain::IndexRange, terrain::kTileParts> parts;
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 1;
};

}  // namespace eyrie::draw
