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

    /// `wanted` is the cut of `request.view`, and `asked` the one for the tau that was asked for,
    /// which may be finer where memory binds. The range is a share of the visible tiles of `asked`,
    /// by triangles: that is the same for every channel of a frame, whatever memory its share of
    /// the view needs, so shares meet exactly. A coarser tile falls to each channel that one of the
    /// tiles it stands for falls to.
    void assign(const terrain::TerrainCut& wanted, const terrain::TerrainCut& asked,
                const CutRequest& request);

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
    void clear(std::vector<terrain::TileId>& tiles);
    void mark(terrain::TileId tile, double position, std::vector<terrain::TileId>& marked);
    void add(const terrain::TileId& leaf, double position);

    const terrain::EytIndex& index_;
    std::vector<double> positions_;  // by tile index
    std::vector<terrain::TileId> leaves_;
    std::vector<terrain::TileId> inner_;
};

}  // namespace eyrie::draw
