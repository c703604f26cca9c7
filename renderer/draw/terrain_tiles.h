// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/draw/tile_decoder.h"
#include "renderer/gl/object.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/terrain_cut.h"
#include "renderer/terrain/triangle_blocks.h"

namespace eyrie::draw {

/// A tile on the device, where it takes terrain::tileBytes: words and indices in one buffer, and
/// its normal map. Either may be empty: without triangles there is nothing in the buffer, and tiles
/// below Quadtree::normalLevel() are drawn with an ancestor's map. GL thread.
struct DeviceTile {
    /// Copies `geometry`, or has `decoder` make it from its outline, to be there when that
    /// publishes. Precondition: one of the two.
    explicit DeviceTile(const terrain::TileGeometry& geometry, TileDecoder* decoder = nullptr);

    gl::Buffer buffer;
    std::optional<gl::Texture2D> normalMap;
    GLintptr indexOffset = 0;
    GLsizei vertexStride = 4;
    std::array<terrain::IndexRange, terrain::kTileParts> parts;
    std::vector<terrain::TriangleBlock> blocks;  ///< none of one that `decoder` made
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 1;
};

/// The parts of a tile's index list that are drawn: the interior and one form of each edge.
std::array<int, 1 + terrain::kEdges> drawnParts(const terrain::TileChoice& choice);

/// The triangles that are drawn of a tile, three corners each in object space, by the error in
/// fifteenths of the tile's (terrain::TileRecord) of the parts that they lie in.
using CornersByError = std::array<std::vector<fabric::Vec3>, 1 + terrain::kFullPartError>;

/// Read back from the device: some tens of microseconds.
CornersByError drawnCorners(const terrain::EytIndex& index, const terrain::TileChoice& choice,
                            const DeviceTile& tile);

}  // namespace eyrie::draw
