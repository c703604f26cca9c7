// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/quadtree.h"

#include <cassert>

namespace eyrie::terrain {
namespace {

std::int32_t tilesAcross(std::int32_t posts, int level) {
    const std::int32_t side = Quadtree::side(level);
    return (posts - 1 + side - 1) / side;
}

}  // namespace

Quadtree::Quadtree(std::uint32_t columns, std::uint32_t rows)
    : columns_(static_cast<std::int32_t>(columns)), rows_(static_cast<std::int32_t>(rows)) {
    assert(columns >= 2 && rows >= 2 && columns <= kMaxPosts && rows <= kMaxPosts &&
           std::uint64_t{columns} * rows <= kMaxGridPosts);
    do {
        const int level = levels();
        levels_.push_back(
            {tilesAcross(columns_, level), tilesAcross(rows_, level), tileCount_, pageCount_});
        tileCount_ += static_cast<std::uint32_t>(levels_.back().x * levels_.back().y);
        pageCount_ += static_cast<std::uint32_t>(pagesX(level) * pagesY(level));
    } while (levels_.back().x > 1 || levels_.back().y > 1);
}

TileId Quadtree::tileOf(std::uint32_t index) const {
    assert(index < tileCount_);
    int level = levels() - 1;
    while (levels_[static_cast<std::size_t>(level)].firstTile > index) --level;
    const auto place =
        static_cast<std::int32_t>(index - levels_[static_cast<std::size_t>(level)].firstTile);
    return {level, place % tilesX(level), place / tilesX(level)};
}

std::uint32_t Quadtree::pageIndex(const TileId& tile) const {
    const Level& level = levels_[static_cast<std::size_t>(tile.level)];
    const std::int32_t row = tile.y / kPageTiles;
    return level.firstPage +
           static_cast<std::uint32_t>(row * pagesX(tile.level) + tile.x / kPageTiles);
}

TileId Quadtree::firstTileOfPage(std::uint32_t page) const {
    assert(page < pageCount_);
    int level = levels() - 1;
    while (levels_[static_cast<std::size_t>(level)].firstPage > page) --level;
    const auto place =
        static_cast<std::int32_t>(page - levels_[static_cast<std::size_t>(level)].firstPage);
    const std::int32_t across = pagesX(level);
    return {level, place % across * kPageTiles, place / across * kPageTiles};
}

}  // namespace eyrie::terrain
