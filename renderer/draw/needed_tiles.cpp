// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/needed_tiles.h"

namespace eyrie::draw {

using terrain::TileId;

void NeededTiles::assign(const terrain::TerrainCut& wanted, const CutRequest& request) {
    for (const auto* tiles : {&leaves_, &inner_})
        for (const TileId& tile : *tiles) positions_[index_.quadtree.tileIndex(tile)] = kNotNeeded;
    leaves_.clear();
    inner_.clear();
    double total = 0;
    for (const terrain::TileChoice& choice : wanted.tiles)
        total += choice.isVisible ? index_.tile(choice.id).triangles : 0;
    double before = 0;
    for (const terrain::TileChoice& choice : wanted.tiles) {
        if (!choice.isVisible)
            continue;
        const double position = before / total;
        before += index_.tile(choice.id).triangles;
        if (request.range.contains(position) &&
            request.view.isVisible(index_.bounds(choice.id), request.channel))
            add(choice.id, position);
    }
}

/// Leaves come in ascending order, so the first below a tile gives it its position.
void NeededTiles::add(const TileId& leaf, double position) {
    positions_[index_.quadtree.tileIndex(leaf)] = position;
    leaves_.push_back(leaf);
    for (TileId tile = leaf; tile != index_.quadtree.top();) {
        tile = terrain::Quadtree::parent(tile);
        double& known = positions_[index_.quadtree.tileIndex(tile)];
        if (known != kNotNeeded)
            return;
        known = position;
        inner_.push_back(tile);
    }
}

}  // namespace eyrie::draw
