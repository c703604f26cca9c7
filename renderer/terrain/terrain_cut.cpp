// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/terrain_cut.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace eyrie::terrain {
namespace {

class CutSelector {
public:
    CutSelector(const EytIndex& index, const lod::ObjectView& view, double tauPixels)
        : index_(index),
          quadtree_(index.quadtree),
          view_(view),
          tauPixels_(tauPixels),
          isRefined_(quadtree_.tileCount()) {}

    TerrainCut select() {
        refineForError(quadtree_.top());
        for (int level = 0; level < quadtree_.levels(); ++level) refineForNeighbours(level);
        gather(quadtree_.top());
        return std::move(cut_);
    }

private:
    bool isRefined(const TileId& tile) const { return isRefined_[quadtree_.tileIndex(tile)] != 0; }
    void setRefined(const TileId& tile) { isRefined_[quadtree_.tileIndex(tile)] = 1; }

    template <typename Visit>
    void forEachChild(const TileId& tile, Visit visit) const {
        for (int i = 0; i < 4; ++i)
            if (const TileId child = Quadtree::child(tile, i); quadtree_.contains(child))
                visit(child);
    }

    double screenSpaceErrorPixels(const TileId& tile) const {
        return view_.screenSpaceErrorPixels(index_.tile(tile).errorMetres, index_.bounds(tile));
    }

    void refineForError(const TileId& tile) {
        if (tile.level == 0 || index_.tile(tile).errorMetres == 0 ||
            !view_.isVisible(index_.bounds(tile)) || screenSpaceErrorPixels(tile) <= tauPixels_)
            return;
        setRefined(tile);
        forEachChild(tile, [&](const TileId& child) { refineForError(child); });
    }

    /// Makes room beside refined tiles: where a tile is refined its neighbours must at least exist,
    /// so their parents, and its own parent, are refined too. From the finest level up each level
    /// only adds to the one above it, so one pass does, in any order.
    void refineForNeighbours(int level) {
        TileId tile{level, 0, 0};
        for (tile.y = 0; tile.y < quadtree_.tilesY(level); ++tile.y)
            for (tile.x = 0; tile.x < quadtree_.tilesX(level); ++tile.x) {
                if (!isRefined(tile) || tile == quadtree_.top())
                    continue;
                setRefined(Quadtree::parent(tile));
                for (int edge = 0; edge < kEdges; ++edge)
                    if (const TileId next = Quadtree::neighbour(tile, edge);
                        quadtree_.contains(next))
                        setRefined(Quadtree::parent(next));
            }
    }

    void gather(const TileId& tile) {
        if (isRefined(tile)) {
            forEachChild(tile, [&](const TileId& child) { gather(child); });
            return;
        }
        TileChoice choice{tile, 0, 0};
        if (view_.isVisible(index_.bounds(tile)))
            choice.screenSpaceErrorPixels = screenSpaceErrorPixels(tile);
        cut_.tauAchievedPixels = std::max(cut_.tauAchievedPixels, choice.screenSpaceErrorPixels);
        if (index_.tile(tile).triangles == 0)
            return;
        for (int edge = 0; edge < kEdges; ++edge)
            if (const TileId next = Quadtree::neighbour(tile, edge);
                quadtree_.contains(next) && isRefined(next))
                choice.finerEdges = static_cast<std::uint8_t>(choice.finerEdges | 1 << edge);
        cut_.tiles.push_back(choice);
    }

    const EytIndex& index_;
    const Quadtree& quadtree_;
    const lod::ObjectView& view_;
    double tauPixels_;
    std::vector<std::uint8_t> isRefined_;  // by tile index
    TerrainCut cut_;
};

}  // namespace

TerrainCut selectCut(const EytIndex& index, const lod::ObjectView& view, double tauPixels) {
    return CutSelector(index, view, tauPixels).select();
}

}  // namespace eyrie::terrain
