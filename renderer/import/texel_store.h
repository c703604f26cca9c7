// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fabric/image.h"
#include "renderer/terrain/imagery/texture_pyramid.h"
#include "renderer/terrain/scratch.h"

namespace eyrie::import {

/// The coarser levels of a texture pyramid while it is made, on a Scratch: in pieces of 256 x 256
/// texels, what one tile of the level below becomes. Any thread may use it.
class TexelStore {
public:
    /// Reserves its room; keeps references.
    TexelStore(const terrain::TexturePyramid& pyramid, terrain::Scratch& scratch);

    /// Stores what `tile` becomes one level up: half as many texels each way, rounded up;
    /// none where all of them are holes.
    /// Precondition: `tile` is below the top.
    void write(const terrain::TextureId& tile, std::span<const fabric::Rgba> texels);

    /// Texels of a level above 0, row by row; those outside of the level are its nearest.
    /// Precondition: what `window` covers was written.
    void read(int level, const terrain::TexelRect& window, std::span<fabric::Rgba> out) const;

private:
    static constexpr std::int32_t kPieceSide = terrain::kTextureSide / 2;
    static constexpr std::size_t kPieceBytes =
        sizeof(fabric::Rgba) * static_cast<std::size_t>(kPieceSide) * kPieceSide;

    std::uint64_t placeOf(int level, std::int64_t pieceX, std::int64_t pieceY) const;

    const terrain::TexturePyramid& pyramid_;
    terrain::Scratch& scratch_;
    std::vector<std::uint64_t> levels_;  ///< place of the first piece, by level - 1
};

}  // namespace eyrie::import
