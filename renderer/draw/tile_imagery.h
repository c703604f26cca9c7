// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "effects/terrain_effect.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/terrain_paging.h"
#include "renderer/terrain/imagery/imagery_parts.h"
#include "renderer/terrain/terrain_cut.h"

namespace eyrie::draw {

/// What pictures the tiles of one terrain are drawn with; without imagery, each whole with none. GL
/// thread.
class TileImagery {
public:
    /// Keeps references.
    TileImagery(const terrain::EytIndex& index, TerrainPaging& paging)
        : index_(index), paging_(paging) {}

    /// The texture tiles that `tiles` are to be drawn with, each once, less the top one.
    std::vector<terrain::TextureId> texturesOf(std::span<const terrain::TileId> tiles,
                                               const lod::ObjectView& view,
                                               double texelPixels) const;
    /// Those with all above them, less the top one.
    std::vector<TerrainItem> itemsOf(std::span<const terrain::TileId> tiles,
                                     const lod::ObjectView& view, double texelPixels) const;

    /// Finds what each piece, which names one of `choices`, is drawn with now.
    void choose(std::span<const terrain::TileChoice> choices, std::span<const Piece> pieces,
                const lod::ObjectView& view, double texelPixels, terrain::Unseen unseen);
    /// Of a tile of the last choose(). Empty: the view sees none of it.
    const std::vector<terrain::ImageryPart>& partsOf(const terrain::TileId& tile) const {
        return index_.imagery ? parts_.at(index_.quadtree.tileIndex(tile)) : bare_;
    }
    /// Sets what the program's variant has of uniforms for `part`.
    void use(const effects::TerrainEffect& program, const terrain::TileId& tile,
             const terrain::ImageryPart& part) const;

private:
    const terrain::EytIndex& index_;
    TerrainPaging& paging_;
    DeviceTexture hole_;  ///< where there is no picture
    const std::vector<terrain::ImageryPart> bare_{{}};
    std::unordered_map<std::uint32_t, std::vector<terrain::ImageryPart>> parts_;  // by tile index
};

}  // namespace eyrie::draw
