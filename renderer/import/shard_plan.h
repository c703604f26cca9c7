// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/terrain/quadtree.h"

namespace eyrie::import {

/// One share of an import that is spread over machines: number `index` of `count`, from 0.
struct Shard {
    std::uint32_t index = 0;
    std::uint32_t count = 1;

    bool operator==(const Shard&) const = default;
};

/// Parts are all open while they are merged.
inline constexpr std::uint32_t kMaxShards = 512;

/// Which shard makes what. The grid is cut into squares of 512 cells, a page of level 2 each with
/// the pages of the finer levels under it, and each shard has a run of them, row by row, as many as
/// any other but for one; with more shards than squares some have none. So it is with the texture
/// tiles of level 0 that imagery has. What is coarser than level 2 is nobody's: it is made when the
/// parts are merged. Immutable.
class ShardPlan {
public:
    /// Precondition: 1 <= shards. `textures` is the number of texture tiles of level 0.
    ShardPlan(const terrain::Quadtree& quadtree, std::uint32_t shards, std::uint32_t textures = 0);

    static constexpr int kLevels = terrain::kFullResolutionLevels;  ///< from 0 on, that have owners

    /// Of a tile of 128 cells of a raster over the grid.
    std::uint32_t ownerOfTile(std::int32_t x, std::int32_t y) const;
    /// Whether what a shard makes may depend on the tile: it is its own, or beside one.
    bool isNear(std::uint32_t shard, std::int32_t x, std::int32_t y) const;
    bool hasOwner(std::uint32_t page) const { return page < ownedPages_; }
    /// Precondition: hasOwner(page).
    std::uint32_t ownerOfPage(std::uint32_t page) const;

    /// Precondition: texture is less than their number.
    std::uint32_t ownerOfTexture(std::uint32_t texture) const;

    std::int32_t tilesX() const { return tilesX_; }
    std::int32_t tilesY() const { return tilesY_; }
    /// Ascending: y * tilesX() + x, and numbers of pages.
    std::vector<std::uint32_t> tilesOf(std::uint32_t shard) const;
    std::vector<std::uint32_t> pagesOf(std::uint32_t shard) const;
    std::vector<std::uint32_t> texturesOf(std::uint32_t shard) const;

private:
    std::uint32_t ownerOfSquare(std::int32_t x, std::int32_t y) const;

    terrain::Quadtree quadtree_;
    std::uint32_t shards_;
    std::uint32_t textures_;
    std::uint32_t ownedPages_ = 0;
    std::int32_t tilesX_;
    std::int32_t tilesY_;
    std::int32_t squaresX_;
    std::int32_t squaresY_;
};

}  // namespace eyrie::import
