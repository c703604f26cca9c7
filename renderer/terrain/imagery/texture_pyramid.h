// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace eyrie::terrain {

/// Texels a side of a texture tile, without its border.
inline constexpr std::int32_t kTextureSide = 512;
/// Texels beyond each side of a tile that are its neighbours': one block of BC1, the same bits as
/// the neighbour's own, so that filtering does not know where a tile ends.
inline constexpr std::int32_t kTextureBorder = 4;
inline constexpr std::int32_t kBlockSide = 4;  ///< texels of a BC1 block
/// Limits of TexturePyramid::texelShift: a texture tile of a post to a texel of a whole terrain.
inline constexpr int kMinTexelShift = -22;
inline constexpr int kMaxTexelShift = 9;
inline constexpr std::uint64_t kMaxTextureTiles = std::uint64_t{1} << 22;

/// Level 0 is the finest; x and y count tiles of that level from texel (0, 0).
struct TextureId {
    std::int32_t level = 0;
    std::int32_t x = 0;
    std::int32_t y = 0;

    bool operator==(const TextureId&) const = default;
};

/// A rectangle of texels of one level; may reach beyond it.
struct TexelRect {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int32_t columns = 0;
    std::int32_t rows = 0;
};

/// The shape of the texture quadtree over a grid of posts. Texels of level L are 2^(L - texelShift)
/// posts a side, whatever the posts' spacing, and the first one's corner is post (0, 0): so tiles
/// of posts and of texels nest in each other. The only tile of the last level covers the grid. A
/// texel is stored in its level alone: the coarser levels of a tile are those of the tiles above.
class TexturePyramid {
public:
    TexturePyramid() : TexturePyramid(2, 2, 0) {}
    /// Precondition: isPossible(...).
    TexturePyramid(std::int32_t columns, std::int32_t rows, int texelShift);

    /// Whether the shift and the number of tiles that it leads to are within the limits.
    static bool isPossible(std::int32_t columns, std::int32_t rows, int texelShift);

    int texelShift() const { return texelShift_; }
    int levels() const { return static_cast<int>(levels_.size()); }
    std::int64_t width(int level) const { return levels_[static_cast<std::size_t>(level)].width; }
    std::int64_t height(int level) const { return levels_[static_cast<std::size_t>(level)].height; }
    std::int32_t tilesX(int level) const { return levels_[static_cast<std::size_t>(level)].x; }
    std::int32_t tilesY(int level) const { return levels_[static_cast<std::size_t>(level)].y; }
    std::uint32_t tileCount() const { return tileCount_; }
    TextureId top() const { return {levels() - 1, 0, 0}; }

    static TextureId parent(const TextureId& tile) {
        return {tile.level + 1, tile.x >> 1, tile.y >> 1};
    }
    bool contains(const TextureId& tile) const {
        return tile.level >= 0 && tile.level < levels() && tile.x >= 0 && tile.y >= 0 &&
               tile.x < tilesX(tile.level) && tile.y < tilesY(tile.level);
    }

    /// Finest level first, each level row by row.
    std::uint32_t tileIndex(const TextureId& tile) const {
        const Level& level = levels_[static_cast<std::size_t>(tile.level)];
        return level.firstTile +
               static_cast<std::uint32_t>(tile.y) * static_cast<std::uint32_t>(level.x) +
               static_cast<std::uint32_t>(tile.x);
    }
    /// Precondition: index < tileCount().
    TextureId tileOf(std::uint32_t index) const;

    /// What a tile holds, border included: at the edge of the level no more blocks than it has.
    TexelRect texels(const TextureId& tile) const;
    std::int32_t blocksX(const TextureId& tile) const { return texels(tile).columns / kBlockSide; }
    std::int32_t blocksY(const TextureId& tile) const { return texels(tile).rows / kBlockSide; }

    /// Posts of a tile's side, before clamping to the grid.
    double sidePosts(int level) const;
    double texelPosts(int level) const { return sidePosts(level) / kTextureSide; }

private:
    struct Level {
        std::int64_t width;
        std::int64_t height;
        std::int32_t x;
        std::int32_t y;
        std::uint32_t firstTile;
    };

    int texelShift_;
    std::vector<Level> levels_;
    std::uint32_t tileCount_ = 0;
};

}  // namespace eyrie::terrain
