// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/terrain/quadtree.h"

namespace eyrie::terrain {

/// Which tiles of a quadtree are split into their children. The leaves below the split tiles (the
/// top tile where nothing is split) are a cut: they cover the terrain once.
///
/// A refinement is restricted when leaves that share an edge differ by one level at most: where a
/// tile is split its neighbours at least exist, so their parents, and its own, are split too.
class Refinement {
public:
    explicit Refinement(const Quadtree& quadtree)
        : quadtree_(&quadtree),
          finestTiles_(static_cast<std::size_t>(quadtree.tilesX(0)) *
                       static_cast<std::size_t>(quadtree.tilesY(0))),
          isSplit_(quadtree.tileCount() - finestTiles_),
          split_(static_cast<std::size_t>(quadtree.levels())) {}

    const Quadtree& quadtree() const { return *quadtree_; }
    bool isSplit(const TileId& tile) const { return tile.level > 0 && isSplit_[bitOf(tile)]; }
    /// Precondition: `tile` is above level 0.
    void split(const TileId& tile);

    /// Splits what else must be for the refinement to be restricted.
    void restrict();

    /// Takes back splits until each leaf below a split tile satisfies `isDrawable` and the
    /// refinement is restricted again. What remains is the largest such part of it. Where even the
    /// top tile's children are not drawable that is the top tile alone, drawable or not.
    ///
    /// Each condition says that a split needs another split, or a tile that is drawable or split.
    /// The union of two refinements that satisfy such conditions satisfies them too, so there is a
    /// largest one, and taking back whatever contradicts one of them leads to it in any order.
    void coarsen(const std::function<bool(const TileId&)>& isDrawable);

    template <typename Visit>
    void forEachChild(const TileId& tile, Visit visit) const {
        for (int i = 0; i < 4; ++i)
            if (const TileId child = Quadtree::child(tile, i); quadtree_->contains(child))
                visit(child);
    }

    /// Leaves depth first: a parent's children by ascending Quadtree::child.
    template <typename Visit>
    void forEachLeaf(Visit visit) const {
        visitLeaves(quadtree_->top(), visit);
    }

private:
    template <typename Visit>
    void visitLeaves(const TileId& tile, Visit& visit) const {
        if (isSplit(tile))
            forEachChild(tile, [&](const TileId& child) { visitLeaves(child, visit); });
        else
            visit(tile);
    }

    void unite(const TileId& tile, const std::function<bool(const TileId&)>& isDrawable,
               std::vector<TileId>& pending);

    std::size_t bitOf(const TileId& tile) const {
        return quadtree_->tileIndex(tile) - finestTiles_;
    }

    const Quadtree* quadtree_;
    std::size_t finestTiles_;
    /// By tile index from level 1 on. A view makes and copies several of these: of the largest grid
    /// a bit a tile is 0.7 MB, where a byte for each, those of level 0 too, was 22.
    std::vector<bool> isSplit_;
    std::vector<std::vector<TileId>> split_;  // by level; may name tiles that are whole again
};

}  // namespace eyrie::terrain
