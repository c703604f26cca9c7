// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace eyrie::terrain {

/// Cells a side of a tile of level 0, and of the levels that leave out posts. Tiles near the eye
/// must be small: a tile's nearest point decides for all of it.
inline constexpr std::int32_t kFinestTileCells = 32;
inline constexpr std::int32_t kMaxTileCells = 128;
inline constexpr int kFullResolutionLevels = 3;  ///< levels 0 to 2 may use every post
static_assert(kFinestTileCells << (kFullResolutionLevels - 1) == kMaxTileCells);
/// A page holds 4 x 4 tiles of one level.
inline constexpr std::int32_t kPageTiles = 4;
/// Posts a side: what keeps a lattice point minus the camera's exact in float32. And of the grid.
inline constexpr std::uint32_t kMaxPosts = 1U << 22;
inline constexpr std::uint64_t kMaxGridPosts = std::uint64_t{1} << 34;

/// A tile's edges, as index and as bit of a mask.
enum Edge : int { kEdgeMinX = 0, kEdgeMaxX = 1, kEdgeMinY = 2, kEdgeMaxY = 3 };
inline constexpr int kEdges = 4;

/// Level 0 is the finest; x and y count tiles of that level from post (0, 0).
struct TileId {
    std::int32_t level = 0;
    std::int32_t x = 0;
    std::int32_t y = 0;

    bool operator==(const TileId&) const = default;
};

/// The shape of the quadtree over a grid of posts: a tile of level L spans 32 * 2^L posts a side,
/// and the only tile of the last level covers the grid. Neighbours share their border posts. Tiles
/// without a cell of the grid do not exist.
///
/// Levels differ in the error they allow. Up to a side of 128 they may all use every post; from
/// there on each level leaves out every second post of the one before. Immutable.
class Quadtree {
public:
    Quadtree() : Quadtree(2, 2) {}
    /// Precondition: both from 2 to kMaxPosts, columns * rows at most kMaxGridPosts.
    Quadtree(std::uint32_t columns, std::uint32_t rows);

    std::int32_t columns() const { return columns_; }
    std::int32_t rows() const { return rows_; }
    int levels() const { return static_cast<int>(levels_.size()); }
    std::int32_t tilesX(int level) const { return levels_[static_cast<std::size_t>(level)].x; }
    std::int32_t tilesY(int level) const { return levels_[static_cast<std::size_t>(level)].y; }
    std::int32_t pagesX(int level) const { return (tilesX(level) + kPageTiles - 1) / kPageTiles; }
    std::int32_t pagesY(int level) const { return (tilesY(level) + kPageTiles - 1) / kPageTiles; }

    /// Posts from a tile's first to its last, before clamping to the grid.
    static std::int32_t side(int level) { return kFinestTileCells << level; }
    /// Samples of a level are 2^spacingShift posts apart; a tile has cells + 1 of them a side.
    static int spacingShift(int level) { return std::max(0, level - kFullResolutionLevels + 1); }
    static std::int32_t cells(int level) { return side(level) >> spacingShift(level); }
    TileId top() const { return {levels() - 1, 0, 0}; }
    /// The coarsest level whose samples are all posts. It has the normals of the finer levels, too,
    /// whose tiles would only repeat them.
    int normalLevel() const { return std::min(kFullResolutionLevels, levels()) - 1; }
    /// The tile whose normals `tile` is drawn with: its ancestor at normalLevel(), or itself.
    TileId normalTile(const TileId& tile) const {
        const int up = std::max(0, normalLevel() - tile.level);
        return {tile.level + up, tile.x >> up, tile.y >> up};
    }
    bool contains(const TileId& tile) const {
        return tile.level >= 0 && tile.level < levels() && tile.x >= 0 && tile.y >= 0 &&
               tile.x < tilesX(tile.level) && tile.y < tilesY(tile.level);
    }
    static TileId parent(const TileId& tile) { return {tile.level + 1, tile.x >> 1, tile.y >> 1}; }
    /// Child 0 to 3: bit 0 is the half in x, bit 1 in y. May not exist.
    static TileId child(const TileId& tile, int i) {
        return {tile.level - 1, 2 * tile.x + (i & 1), 2 * tile.y + (i >> 1)};
    }
    /// The tile of the same level beyond `edge`. May not exist.
    static TileId neighbour(const TileId& tile, int edge) {
        constexpr std::array<int, kEdges> kDx = {-1, 1, 0, 0};
        constexpr std::array<int, kEdges> kDy = {0, 0, -1, 1};
        const auto e = static_cast<std::size_t>(edge);
        return {tile.level, tile.x + kDx[e], tile.y + kDy[e]};
    }

    /// Tiles of all levels, finest level first, each level row by row.
    std::uint32_t tileCount() const { return tileCount_; }
    std::uint32_t tileIndex(const TileId& tile) const {
        const Level& level = levels_[static_cast<std::size_t>(tile.level)];
        return level.firstTile + static_cast<std::uint32_t>(tile.y * level.x + tile.x);
    }
    /// Precondition: index < tileCount().
    TileId tileOf(std::uint32_t index) const;
    /// Pages of all levels in the same order.
    std::uint32_t pageCount() const { return pageCount_; }
    std::uint32_t pageIndex(const TileId& tile) const;
    /// The tile of lowest x and y in a page: its place 0; place = (y % 4) * 4 + x % 4.
    TileId firstTileOfPage(std::uint32_t page) const;
    static int placeInPage(const TileId& tile) {
        return (tile.y % kPageTiles) * kPageTiles + tile.x % kPageTiles;
    }

private:
    struct Level {
        std::int32_t x;
        std::int32_t y;
        std::uint32_t firstTile;
        std::uint32_t firstPage;
    };

    std::int32_t columns_;
    std::int32_t rows_;
    std::vector<Level> levels_;
    std::uint32_t tileCount_ = 0;
    std::uint32_t pageCount_ = 0;
};

}  // namespace eyrie::terrain
