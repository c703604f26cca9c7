// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/refinement.h"

namespace eyrie::terrain {

void Refinement::split(const TileId& tile) {
    const std::size_t bit = bitOf(tile);
    if (isSplit_[bit])
        return;
    isSplit_[bit] = true;
    split_[static_cast<std::size_t>(tile.level)].push_back(tile);
}

/// From the finest level up each level only adds to the one above it, so one pass does, in any
/// order.
void Refinement::restrict() {
    for (std::size_t level = 0; level + 1 < split_.size(); ++level)
        for (const TileId& tile : split_[level]) {
            split(Quadtree::parent(tile));
            for (int edge = 0; edge < kEdges; ++edge)
                if (const TileId next = Quadtree::neighbour(tile, edge); quadtree_->contains(next))
                    split(Quadtree::parent(next));
        }
}

void Refinement::coarsen(const std::function<bool(const TileId&)>& isDrawable) {
    std::vector<TileId> pending;
    for (const std::vector<TileId>& level : split_)
        for (const TileId& tile : level) {
            bool isComplete = true;
            forEachChild(tile, [&](const TileId& child) {
                isComplete = isComplete && (isSplit(child) || isDrawable(child));
            });
            if (!isComplete)
                pending.push_back(tile);
        }
    while (!pending.empty()) {
        const TileId tile = pending.back();
        pending.pop_back();
        if (isSplit(tile))
            unite(tile, isDrawable, pending);
    }
}

/// Whatever needs that `tile` is split becomes pending: what is split below it and beside its
/// children, and its parent when the tile cannot stand for itself.
void Refinement::unite(const TileId& tile, const std::function<bool(const TileId&)>& isDrawable,
                       std::vector<TileId>& pending) {
    isSplit_[bitOf(tile)] = false;
    forEachChild(tile, [&](const TileId& child) {
        pending.push_back(child);
        for (int edge = 0; edge < kEdges; ++edge)
            if (const TileId next = Quadtree::neighbour(child, edge); quadtree_->contains(next))
                pending.push_back(next);
    });
    if (tile != quadtree_->top() && isSplit(Quadtree::parent(tile)) && !isDrawable(tile))
        pending.push_back(Quadtree::parent(tile));
}

}  // namespace eyrie::terrain
