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
          isSplit_(quadtree.tileCount()),
          split_(static_cast<std::size_t>(quadtree.levels())) {}

    const Quadtree& quadtree() const { return *quadtree_; }
    bool isSplit(const TileId& tile) const { return isSplit_[quadtree_->tileIndex(tile)] != 0; }
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

    const Quadtree* quadtree_;
    std::vector<std::uint8_t> isSplit_;       // by tile index
    std::vector<std::vector<TileId>> split_;  // by level; may name tiles that are whole again
};

}  // namespace eyrie::terrain
