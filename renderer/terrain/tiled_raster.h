// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "renderer/terrain/scratch.h"

namespace eyrie::terrain {

/// Cells a side of a tile of a raster on scratch: those of the largest quadtree tile that has
/// every post, so triangles up to that size lie in one.
inline constexpr std::int32_t kRasterTileCells = 128;
inline constexpr std::int32_t kRasterTilePosts = kRasterTileCells + 1;
inline constexpr std::size_t kRasterTileValues =
    static_cast<std::size_t>(kRasterTilePosts) * kRasterTilePosts;

/// Which tiles of a raster something is about; none: all of them.
using TileFilter = std::function<bool(std::int32_t x, std::int32_t y)>;

/// A rectangle of posts.
struct PostRect {
    std::int32_t i = 0;
    std::int32_t j = 0;
    std::int32_t columns = 0;
    std::int32_t rows = 0;
};

/// Values per post, in tiles of 129 x 129 on a Scratch. Tile (x, y) holds posts 128 x to
/// 128 x + 128, so neighbours hold their common border twice. Past the raster's last column and
/// row a tile repeats them or not, as its writer chose. Any thread may use it.
template <typename T>
class TiledRaster {
public:
    using Tile = std::shared_ptr<const T[]>;

    TiledRaster() = default;
    /// Precondition: columns, rows >= 1.
    TiledRaster(Scratch& scratch, std::int32_t columns, std::int32_t rows)
        : scratch_(&scratch),
          columns_(columns),
          rows_(rows),
          tilesX_(tilesOver(columns)),
          tilesY_(tilesOver(rows)),
          place_(scratch.reserve(kTileBytes, static_cast<std::uint64_t>(tilesX_) *
                                                 static_cast<std::uint64_t>(tilesY_))) {}

    std::int32_t columns() const { return columns_; }
    std::int32_t rows() const { return rows_; }
    std::int32_t tilesX() const { return tilesX_; }
    std::int32_t tilesY() const { return tilesY_; }

    Tile tile(std::int32_t x, std::int32_t y) const {
        const Scratch::Piece piece = scratch_->read(placeOf(x, y), kTileBytes);
        return {piece, reinterpret_cast<const T*>(piece.get())};
    }
    /// `values`: kRasterTileValues of them, row by row.
    void write(std::int32_t x, std::int32_t y, std::shared_ptr<T[]> values) {
        const auto* bytes = reinterpret_cast<const std::byte*>(values.get());
        scratch_->write(placeOf(x, y), {std::move(values), bytes}, kTileBytes);
    }
    /// For a raster that nobody reads again: makes room on the scratch.
    void forget() {
        for (std::int32_t y = 0; y < tilesY_; ++y)
            for (std::int32_t x = 0; x < tilesX_; ++x) scratch_->forget(placeOf(x, y));
    }
    static std::shared_ptr<T[]> newTile() {
        const std::shared_ptr<std::byte[]> piece = Scratch::newPiece(kTileBytes);
        return {piece, reinterpret_cast<T*>(piece.get())};
    }

    /// Calls visit(values, stride, part) for each tile's part of `rect`; `values` points at the
    /// part's first post. Precondition: `rect` lies within the tiles.
    template <typename Visit>
    void forEachPart(const PostRect& rect, Visit visit) const {
        const std::int32_t lastX = tileOf(rect.i + rect.columns - 1, tilesX_);
        const std::int32_t lastY = tileOf(rect.j + rect.rows - 1, tilesY_);
        for (std::int32_t y = rect.j / kRasterTileCells; y <= lastY; ++y)
            for (std::int32_t x = std::min(rect.i / kRasterTileCells, tilesX_ - 1); x <= lastX; ++x)
                visitPart(rect, x, std::min(y, tilesY_ - 1), visit);
    }

private:
    static constexpr std::size_t kTileBytes = kRasterTileValues * sizeof(T);

    static std::int32_t tilesOver(std::int32_t posts) {
        return std::max(1, (posts - 1 + kRasterTileCells - 1) / kRasterTileCells);
    }
    /// The tile that ends a rectangle in `post`: the lower one on a border.
    static std::int32_t tileOf(std::int32_t post, std::int32_t tiles) {
        return std::clamp((post - 1) / kRasterTileCells, 0, tiles - 1);
    }
    std::uint64_t placeOf(std::int32_t x, std::int32_t y) const {
        return place_ + Scratch::stride(kTileBytes) *
                            (static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(tilesX_) +
                             static_cast<std::uint64_t>(x));
    }
    template <typename Visit>
    void visitPart(const PostRect& rect, std::int32_t x, std::int32_t y, Visit& visit) const {
        const std::int32_t i0 = std::max(rect.i, x * kRasterTileCells);
        const std::int32_t j0 = std::max(rect.j, y * kRasterTileCells);
        const std::int32_t i1 =
            std::min(rect.i + rect.columns, x * kRasterTileCells + kRasterTilePosts);
        const std::int32_t j1 =
            std::min(rect.j + rect.rows, y * kRasterTileCells + kRasterTilePosts);
        const Tile values = tile(x, y);
        visit(values.get() + (j0 - y * kRasterTileCells) * kRasterTilePosts +
                  (i0 - x * kRasterTileCells),
              PostRect{i0, j0, i1 - i0, j1 - j0});
    }

    Scratch* scratch_ = nullptr;
    std::int32_t columns_ = 0;
    std::int32_t rows_ = 0;
    std::int32_t tilesX_ = 0;
    std::int32_t tilesY_ = 0;
    std::uint64_t place_ = 0;
};

/// Copies the posts of `rect` to `out`, row by row; posts outside of the raster repeat its border.
template <typename T>
void readClamped(const TiledRaster<T>& raster, const PostRect& rect, T* out) {
    const std::int32_t i0 = std::clamp(rect.i, 0, raster.columns() - 1);
    const std::int32_t j0 = std::clamp(rect.j, 0, raster.rows() - 1);
    const std::int32_t i1 = std::clamp(rect.i + rect.columns - 1, 0, raster.columns() - 1);
    const std::int32_t j1 = std::clamp(rect.j + rect.rows - 1, 0, raster.rows() - 1);
    const auto at = [&](std::int32_t i, std::int32_t j) {
        return out + static_cast<std::ptrdiff_t>(j - rect.j) * rect.columns + (i - rect.i);
    };
    raster.forEachPart(
        {i0, j0, i1 - i0 + 1, j1 - j0 + 1}, [&](const T* values, const PostRect& part) {
            for (std::int32_t j = 0; j < part.rows; ++j)
                std::copy_n(values + j * kRasterTilePosts, part.columns, at(part.i, part.j + j));
        });
    for (std::int32_t j = j0; j <= j1; ++j) {
        std::fill(at(rect.i, j), at(i0, j), *at(i0, j));
        std::fill(at(i1, j) + 1, at(rect.i, j) + rect.columns, *at(i1, j));
    }
    for (std::int32_t j = rect.j; j < rect.j + rect.rows; ++j)
        if (j < j0 || j > j1)
            std::copy_n(at(rect.i, j < j0 ? j0 : j1), rect.columns, at(rect.i, j));
}

}  // namespace eyrie::terrain
