// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/draw/drawable.h"
#include "renderer/draw/needed_tiles.h"
#include "renderer/draw/terrain_paging.h"
#include "renderer/terrain/terrain_cut.h"

namespace eyrie::draw {

/// What a drawn picture promises of one terrain: the greatest error of what is seen of a cut.
///
/// Beyond what the index tells, it looks at the triangles that are drawn of a few tiles, read back
/// from the device, and at the picture itself for what hills hide. One object a picture; GL thread.
class TerrainError {
public:
    /// All are referred to; the tiles of the cut that are `needed` are on the device. `hidden` may
    /// be null: then nothing counts as hidden.
    TerrainError(const terrain::EytIndex& index, TerrainPaging& paging, const NeededTiles& needed,
                 const CutRequest& request, occlusion::HiddenGround* hidden)
        : index_(index), paging_(paging), needed_(needed), request_(request), hidden_(hidden) {}

    double pixels(const terrain::TerrainCut& cut);

private:
    double ofTriangles(const terrain::TileChoice& tile, double pixels, double enough);
    template <typename CoverOf>
    bool isHidden(const fabric::Box& bounds, CoverOf coverOf);
    fabric::Vec3 eyePost() const;
    bool isEyeOverGround() const;
    bool isEyeAboveGround();
    bool findEyeAboveGround();

    const terrain::EytIndex& index_;
    TerrainPaging& paging_;
    const NeededTiles& needed_;
    const CutRequest& request_;
    occlusion::HiddenGround* hidden_;
    /// Tiles of the cut whose outlines may be off, by their places in the index.
    std::vector<std::uint32_t> blurred_;
    int lookedAt_ = 0;  ///< tiles that keep tau whose triangles were
    std::optional<bool> isEyeAboveGround_;
};

}  // namespace eyrie::draw
