// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/shard_plan.h"

#include <algorithm>

#include "renderer/terrain/tiled_raster.h"

namespace eyrie::import {
namespace {

constexpr std::int32_t kSquareTiles = terrain::kPageTiles;
/// A vertex of a spacing of up to 64 posts depends on others less than 128 posts away, each of
/// which was measured in all tiles that it lies in.
constexpr std::int32_t kHaloTiles = 1;

/// Shard k has items k * all / shards to (k + 1) * all / shards.
std::uint32_t ownerOf(std::uint64_t item, std::uint64_t all, std::uint32_t shards) {
    return static_cast<std::uint32_t>(((item + 1) * shards - 1) / all);
}

std::int32_t over(std::int32_t size, std::int32_t piece) { return (size + piece - 1) / piece; }

}  // namespace

ShardPlan::ShardPlan(const terrain::Quadtree& quadtree, std::uint32_t shards,
                     std::uint32_t textures)
    : quadtree_(quadtree),
      shards_(shards),
      textures_(textures),
      tilesX_(over(quadtree.columns() - 1, terrain::kRasterTileCells)),
      tilesY_(over(quadtree.rows() - 1, terrain::kRasterTileCells)),
      squaresX_(over(tilesX_, kSquareTiles)),
      squaresY_(over(tilesY_, kSquareTiles)) {
    for (int level = 0; level < std::min(kLevels, quadtree.levels()); ++level)
        ownedPages_ += static_cast<std::uint32_t>(quadtree.pagesX(level) * quadtree.pagesY(level));
}

std::uint32_t ShardPlan::ownerOfSquare(std::int32_t x, std::int32_t y) const {
    return ownerOf(static_cast<std::uint64_t>(y * squaresX_ + x),
                   static_cast<std::uint64_t>(squaresX_ * squaresY_), shards_);
}

std::uint32_t ShardPlan::ownerOfTexture(std::uint32_t texture) const {
    return ownerOf(texture, textures_, shards_);
}

std::uint32_t ShardPlan::ownerOfTile(std::int32_t x, std::int32_t y) const {
    return ownerOfSquare(x / kSquareTiles, y / kSquareTiles);
}

bool ShardPlan::isNear(std::uint32_t shard, std::int32_t x, std::int32_t y) const {
    // A square is wider than the halo: the four corners reach all that are near.
    for (const std::int32_t dy : {-kHaloTiles, kHaloTiles})
        for (const std::int32_t dx : {-kHaloTiles, kHaloTiles})
            if (ownerOfTile(std::clamp(x + dx, 0, tilesX_ - 1),
                            std::clamp(y + dy, 0, tilesY_ - 1)) == shard)
                return true;
    return ownerOfTile(x, y) == shard;
}

std::uint32_t ShardPlan::ownerOfPage(std::uint32_t page) const {
    const terrain::TileId first = quadtree_.firstTileOfPage(page);
    const std::int32_t perSquare = kSquareTiles << (kLevels - 1 - first.level);
    return ownerOfSquare(first.x / perSquare, first.y / perSquare);
}

std::vector<std::uint32_t> ShardPlan::tilesOf(std::uint32_t shard) const {
    std::vector<std::uint32_t> tiles;
    for (std::int32_t y = 0; y < tilesY_; ++y)
        for (std::int32_t x = 0; x < tilesX_; ++x)
            if (ownerOfTile(x, y) == shard)
                tiles.push_back(static_cast<std::uint32_t>(y * tilesX_ + x));
    return tiles;
}

std::vector<std::uint32_t> ShardPlan::texturesOf(std::uint32_t shard) const {
    std::vector<std::uint32_t> textures;
    for (std::uint32_t texture = 0; texture < textures_; ++texture)
        if (ownerOfTexture(texture) == shard)
            textures.push_back(texture);
    return textures;
}

std::vector<std::uint32_t> ShardPlan::pagesOf(std::uint32_t shard) const {
    std::vector<std::uint32_t> pages;
    for (std::uint32_t page = 0; page < ownedPages_; ++page)
        if (ownerOfPage(page) == shard)
            pages.push_back(page);
    return pages;
}

}  // namespace eyrie::import
