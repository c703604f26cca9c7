// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "renderer/gl/object.h"
#include "renderer/terrain/eyt_format.h"

namespace eyrie::draw {

/// A tile on the device, where it takes terrain::tileBytes: words and indices in one buffer, and
/// its normal map. GL thread.
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

}  // namespace eyrie::draw
