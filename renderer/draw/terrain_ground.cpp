// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_ground.h"

#include <algorithm>
#include <cstdint>

namespace eyrie::draw {
namespace {

using terrain::Quadtree;

int finestLevel(const Quadtree& quadtree, int maxCells) {
    int level = 0;
    while (level < quadtree.top().level &&
           std::int64_t{quadtree.tilesX(level)} * quadtree.tilesY(level) > maxCells)
        ++level;
    return level;
}

/// World from (tiles along x, tiles along y, metres of height): the lattice's heights are steps.
fabric::Mat4 worldFromTiles(const terrain::EytIndex& index, const fabric::Mat4& worldFromObject,
                            int level) {
    fabric::Mat4 objectFromTiles = index.objectFromLattice;
    objectFromTiles[0] *= Quadtree::side(level);
    objectFromTiles[1] *= Quadtree::side(level);
    objectFromTiles[2] = {0, 0, 1, 0};
    objectFromTiles[3].z = 0;
    return worldFromObject * objectFromTiles;
}

/// Whether some level draws something there: a coarser one may miss narrow ground.
bool hasGround(const terrain::EytIndex& index, const terrain::TileId& tile) {
    if (!index.quadtree.contains(tile))
        return false;
    if (index.tile(tile).triangles != 0)
        return true;
    for (int i = 0; tile.level > 0 && i < 4; ++i)
        if (hasGround(index, Quadtree::child(tile, i)))
            return true;
    return false;
}

}  // namespace

fabric::GroundGrid groundOf(const terrain::EytIndex& index, const fabric::Mat4& worldFromObject,
                            int maxCells) {
    const Quadtree& quadtree = index.quadtree;
    const int level = finestLevel(quadtree, maxCells);
    fabric::GroundGrid grid;
    grid.worldFromGrid = worldFromTiles(index, worldFromObject, level);
    grid.columns = quadtree.tilesX(level);
    grid.rows = quadtree.tilesY(level);
    const terrain::TileRecord& whole = index.tile(quadtree.top());
    for (int y = 0; y < grid.rows; ++y)
        for (int x = 0; x < grid.columns; ++x) {
            const terrain::TileId tile{level, x, y};
            const bool isGround = hasGround(index, tile);
            grid.highest.push_back(isGround ? index.tile(tile).maxHeightMetres
                                            : whole.minHeightMetres);
            grid.lowest.push_back(isGround ? index.tile(tile).minHeightMetres
                                           : whole.maxHeightMetres);
        }
    return grid;
}

}  // namespace eyrie::draw
