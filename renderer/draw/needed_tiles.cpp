// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/needed_tiles.h"

#include <utility>

namespace eyrie::draw {

using terrain::TileChoice;
using terrain::TileId;

namespace {

/// Of tiles at or below which something is asked for, but not by this channel.
constexpr double kOthers = -2;

}  // namespace

void NeededTiles::assign(const terrain::TerrainCut& wanted, const terrain::TerrainCut& asked,
                         const CutRequest& request) {
    clear(leaves_);
    clear(inner_);
    double total = 0;
    for (const TileChoice& choice : asked.tiles)
        total += choice.isVisible ? index_.tile(choice.id).triangles : 0;
    std::vector<TileId> marked;
    double before = 0;
    for (const TileChoice& choice : asked.tiles) {
        if (!choice.isVisible)
            continue;
        const double position = before / total;
        before += index_.tile(choice.id).triangles;
        mark(choice.id, request.range.contains(position) ? position : kOthers, marked);
    }
    std::vector<std::pair<TileId, double>> leaves;
    double last = 0;
    for (const TileChoice& choice : wanted.tiles) {
        if (!choice.isVisible)
            continue;
        const double known = position(choice.id);
        if (known == kOthers)
            continue;
        // Where nothing is seen of what it stands for it falls to whom the last one does.
        last = known == kNotNeeded ? last : known;
        if (request.range.contains(last) &&
            request.view.isVisible(index_.bounds(choice.id), request.channel))
            leaves.emplace_back(choice.id, last);
    }
    clear(marked);
    for (const auto& [leaf, at] : leaves) add(leaf, at);
}

void NeededTiles::clear(std::vector<TileId>& tiles) {
    for (const TileId& tile : tiles) positions_[index_.quadtree.tileIndex(tile)] = kNotNeeded;
    tiles.clear();
}

/// The tile and all above, but those that have a position already.
void NeededTiles::mark(TileId tile, double position, std::vector<TileId>& marked) {
    for (;; tile = terrain::Quadtree::parent(tile)) {
        double& known = positions_[index_.quadtree.tileIndex(tile)];
        if (known >= 0 || known == position)
            return;
        known = position;
        marked.push_back(tile);
        if (tile == index_.quadtree.top())
            return;
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
