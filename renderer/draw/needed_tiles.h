// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/draw/drawable.h"
#include "renderer/terrain/terrain_cut.h"

namespace eyrie::draw {

/// The part of a view's wanted cut that falls to one channel, and all tiles above it, any of which
/// may have to stand in.
class NeededTiles {
public:
    explicit NeededTiles(const terrain::EytIndex& index)
        : index_(index), positions_(index.quadtree.tileCount(), kNotNeeded) {}

    /// `wanted` is the cut of `request.view`. The range is a share of its visible tiles, by
    /// triangles: every channel of a frame wants the same cut, so their shares meet exactly.
    void assign(const terrain::TerrainCut& wanted, const CutRequest& request);

    bool contains(const terrain::TileId& tile) const { return position(tile) != kNotNeeded; }
    /// Where its first needed leaf starts in the range [0, 1), or kNotNeeded.
    double position(const terrain::TileId& tile) const {
        return positions_[index_.quadtree.tileIndex(tile)];
    }

    /// Those of the wanted cut, depth first.
    const std::vector<terrain::TileId>& leaves() const { return leaves_; }
    /// Those above, with triangles.
    const std::vector<terrain::TileId>& inner() const { return inner_; }

    static constexpr double kNotNeeded = -1;

private:
    void add(const terrain::TileId& leaf, double position);

    const terrain::EytIndex& index_;
    std::vector<double> positions_;  // by tile index
    std::vector<terrain::TileId> leaves_;
    std::vector<terrain::TileId> inner_;
};

}  // namespace eyrie::draw
