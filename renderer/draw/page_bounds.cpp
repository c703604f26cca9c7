// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/page_bounds.h"

#include <unordered_set>

namespace eyrie::draw {
namespace {

constexpr double kStandOff = 2e-3;  ///< of the box's size, on each side

fabric::Box boundsOf(const terrain::EytIndex& index, std::uint32_t page) {
    const terrain::TileId first = index.quadtree.firstTileOfPage(page);
    fabric::Box box;
    for (int y = 0; y < terrain::kPageTiles; ++y)
        for (int x = 0; x < terrain::kPageTiles; ++x)
            if (const terrain::TileId tile{first.level, first.x + x, first.y + y};
                index.quadtree.contains(tile) && index.tile(tile).triangles != 0)
                box.grow(index.bounds(tile));
    const fabric::Vec3 standOff = box.size() * kStandOff + index.heightStepMetres();
    return {box.min - standOff, box.max + standOff};
}

}  // namespace

std::vector<Piece> pagePieces(const terrain::EytIndex& index, const terrain::TerrainCut& cut) {
    double total = 0;
    for (const terrain::TileChoice& choice : cut.tiles)
        total += choice.isVisible ? index.tile(choice.id).triangles : 0;
    std::vector<Piece> pieces;
    std::unordered_set<std::uint32_t> known;
    double before = 0;
    for (const terrain::TileChoice& choice : cut.tiles) {
        if (!choice.isVisible)
            continue;
        const std::uint32_t page = index.quadtree.pageIndex(choice.id);
        if (known.insert(page).second)
            pieces.push_back({page, before / total, boundsOf(index, page), false});
        before += index.tile(choice.id).triangles;
    }
    return pieces;
}

}  // namespace eyrie::draw
