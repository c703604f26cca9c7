// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/texture_pyramid.h"

#include <cassert>
#include <cmath>

namespace eyrie::terrain {
namespace {

/// Texels of level 0 over so many posts.
std::int64_t texelsOver(std::int32_t posts, int texelShift) {
    const std::int64_t cells = posts - 1;
    if (texelShift >= 0)
        return cells << texelShift;
    return (cells + (std::int64_t{1} << -texelShift) - 1) >> -texelShift;
}

std::int64_t tilesOver(std::int64_t texels) { return (texels + kTextureSide - 1) / kTextureSide; }

}  // namespace

bool TexturePyramid::isPossible(std::int32_t columns, std::int32_t rows, int texelShift) {
    if (columns < 2 || rows < 2 || texelShift < kMinTexelShift || texelShift > kMaxTexelShift)
        return false;
    const auto x = static_cast<std::uint64_t>(tilesOver(texelsOver(columns, texelShift)));
    const auto y = static_cast<std::uint64_t>(tilesOver(texelsOver(rows, texelShift)));
    constexpr std::uint64_t kMostAcross = 1 << 21;  // so that a row of texels can be counted
    return x <= kMostAcross && y <= kMostAcross && x * y <= kMaxTextureTiles;
}

TexturePyramid::TexturePyramid(std::int32_t columns, std::int32_t rows, int texelShift)
    : texelShift_(texelShift) {
    assert(isPossible(columns, rows, texelShift));
    std::int64_t width = texelsOver(columns, texelShift);
    std::int64_t height = texelsOver(rows, texelShift);
    while (true) {
        levels_.push_back({width, height, static_cast<std::int32_t>(tilesOver(width)),
                           static_cast<std::int32_t>(tilesOver(height)), tileCount_});
        const Level& level = levels_.back();
        tileCount_ += static_cast<std::uint32_t>(level.x) * static_cast<std::uint32_t>(level.y);
        if (level.x == 1 && level.y == 1)
            return;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
}

TextureId TexturePyramid::tileOf(std::uint32_t index) const {
    assert(index < tileCount_);
    int level = levels() - 1;
    while (levels_[static_cast<std::size_t>(level)].firstTile > index) --level;
    const std::uint32_t place = index - levels_[static_cast<std::size_t>(level)].firstTile;
    const auto across = static_cast<std::uint32_t>(tilesX(level));
    return {level, static_cast<std::int32_t>(place % across),
            static_cast<std::int32_t>(place / across)};
}

TexelRect TexturePyramid::texels(const TextureId& tile) const {
    const auto blocks = [](std::int64_t all, std::int64_t first) {
        const std::int64_t own = std::min<std::int64_t>(kTextureSide, all - first);
        return static_cast<std::int32_t>((own + kBlockSide - 1) / kBlockSide * kBlockSide +
                                         2 * std::int64_t{kTextureBorder});
    };
    const std::int64_t x = std::int64_t{tile.x} * kTextureSide;
    const std::int64_t y = std::int64_t{tile.y} * kTextureSide;
    return {x - kTextureBorder, y - kTextureBorder, blocks(width(tile.level), x),
            blocks(height(tile.level), y)};
}

double TexturePyramid::sidePosts(int level) const {
    return std::ldexp(double{kTextureSide}, level - texelShift_);
}

}  // namespace eyrie::terrain
