// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/terrain_cut.h"

#include <algorithm>

namespace eyrie::terrain {
namespace {

double screenSpaceErrorPixels(const EytIndex& index, const lod::ObjectView& view,
                              const TileId& tile) {
    return view.screenSpaceErrorPixels(index.tile(tile).errorMetres, index.bounds(tile));
}

void refine(const EytIndex& index, const lod::ObjectView& view, double tauPixels,
            const TileId& tile, Refinement& refinement) {
    if (tile.level == 0 || index.tile(tile).errorMetres == 0 ||
        !view.isVisible(index.bounds(tile)) ||
        screenSpaceErrorPixels(index, view, tile) <= tauPixels)
        return;
    refinement.split(tile);
    refinement.forEachChild(
        tile, [&](const TileId& child) { refine(index, view, tauPixels, child, refinement); });
}

std::uint8_t finerEdges(const Refinement& refinement, const TileId& tile) {
    int edges = 0;
    for (int edge = 0; edge < kEdges; ++edge)
        if (const TileId next = Quadtree::neighbour(tile, edge);
            refinement.quadtree().contains(next) && refinement.isSplit(next))
            edges |= 1 << edge;
    return static_cast<std::uint8_t>(edges);
}

}  // namespace

Refinement refineForError(const EytIndex& index, const lod::ObjectView& view, double tauPixels) {
    Refinement refinement(index.quadtree);
    refine(index, view, tauPixels, index.quadtree.top(), refinement);
    refinement.restrict();
    return refinement;
}

TerrainCut cutOf(const EytIndex& index, const lod::ObjectView& view, const Refinement& refinement) {
    TerrainCut cut;
    refinement.forEachLeaf([&](const TileId& tile) {
        TileChoice choice{.id = tile, .isVisible = view.isVisible(index.bounds(tile))};
        if (choice.isVisible)
            choice.screenSpaceErrorPixels = screenSpaceErrorPixels(index, view, tile);
        cut.tauAchievedPixels = std::max(cut.tauAchievedPixels, choice.screenSpaceErrorPixels);
        if (index.tile(tile).triangles == 0)
            return;
        choice.finerEdges = finerEdges(refinement, tile);
        cut.tiles.push_back(choice);
    });
    return cut;
}

TerrainCut selectCut(const EytIndex& index, const lod::ObjectView& view, double tauPixels) {
    return cutOf(index, view, refineForError(index, view, tauPixels));
}

}  // namespace eyrie::terrain
