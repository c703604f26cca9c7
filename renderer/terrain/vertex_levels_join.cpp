// SPDX-License-Identifier: Apache-2.0
// The second step: children across the tiles' borders.
#include <algorithm>
#include <memory>
#include <vector>

#include "renderer/terrain/tile_progress.h"
#include "renderer/terrain/vertex_levels.h"

namespace eyrie::terrain {

/// A square of 8 x 8 tiles: the vertices up to a spacing of 16, with their children across
/// borders. A vertex of spacing s depends on others within 2s + s / 2 of it at most.
class VertexLevels::GroupJoin {
public:
    static constexpr std::int32_t kTiles = 8;
    static constexpr std::int32_t kCells = kTiles * kRasterTileCells;
    static constexpr std::int32_t kHalo = 2 * kCoarseSpacing;

    GroupJoin(VertexLevels& levels, std::int32_t x, std::int32_t y)
        : levels_(levels), x_(x), y_(y) {
        const std::int32_t i1 = std::min(x * kCells + kCells + kHalo, levels.coveredI_);
        const std::int32_t j1 = std::min(y * kCells + kCells + kHalo, levels.coveredJ_);
        rect_.i = std::max(0, x * kCells - kHalo);
        rect_.j = std::max(0, y * kCells - kHalo);
        rect_.columns = i1 - rect_.i + 1;
        rect_.rows = j1 - rect_.j + 1;
        counts_.resize(static_cast<std::size_t>(rect_.columns) *
                       static_cast<std::size_t>(rect_.rows));
    }

    void run() {
        load();
        for (std::int32_t s = 1; s <= kCoarseSpacing; s *= 2) {
            if (s > 1)
                raiseEdges(s);
            if (s < kCoarseSpacing)
                raiseCentres(s);
        }
        for (int layer = 0; layer < kLayers; ++layer) store(layer);
        storeCoarse();
    }

private:
    /// Brings a child's need to a vertex, not its reach.
    static void raise(std::uint8_t& code, std::uint8_t child) {
        code = std::max(code, DeviationScale::lowest(DeviationScale::exceeded(child)));
    }

    std::uint8_t* row(std::int32_t v) {
        return counts_.data() +
               static_cast<std::ptrdiff_t>(v) * static_cast<std::ptrdiff_t>(rect_.columns);
    }
    std::int32_t endOf(std::int32_t posts, std::int32_t first, std::int32_t size,
                       std::int32_t s) const {
        return std::min(size, posts - 1 + s - first);
    }

    void load() {
        levels_.measured_.forEachPart(rect_, [&](const std::uint8_t* values, const PostRect& part) {
            for (std::int32_t j = 0; j < part.rows; ++j) {
                std::uint8_t* out = row(part.j - rect_.j + j) + (part.i - rect_.i);
                const std::uint8_t* in = values + j * kRasterTilePosts;
                for (std::int32_t k = 0; k < part.columns; ++k) out[k] = std::max(out[k], in[k]);
            }
        });
    }

    /// Vertices at the group's own edge lack children; they lie in the halo.
    void raiseCentres(std::int32_t s) {
        const std::int32_t endU = endOf(levels_.columns_, rect_.i, rect_.columns - s, s);
        const std::int32_t endV = endOf(levels_.rows_, rect_.j, rect_.rows - s, s);
        for (std::int32_t v = s; v < endV; v += 2 * s) {
            std::uint8_t* here = row(v);
            const std::uint8_t* below = row(v - s);
            const std::uint8_t* above = row(v + s);
            for (std::int32_t u = s; u < endU; u += 2 * s)
                raise(here[u], std::max({here[u - s], here[u + s], below[u], above[u]}));
        }
    }

    void raiseEdges(std::int32_t s) {
        const std::int32_t h = s / 2;
        const std::int32_t endU = endOf(levels_.columns_, rect_.i, rect_.columns, s);
        const std::int32_t endV = endOf(levels_.rows_, rect_.j, rect_.rows, s);
        for (std::int32_t v = 0; v < endV; v += s) {
            std::uint8_t* here = row(v);
            const std::uint8_t* below = v >= h ? row(v - h) : nullptr;
            const std::uint8_t* above = v + h < rect_.rows ? row(v + h) : nullptr;
            for (std::int32_t u = (v & s) == 0 ? s : 0; u < endU; u += 2 * s)
                for (const std::uint8_t* other : {below, above}) {
                    if (other != nullptr && u >= h)
                        raise(here[u], other[u - h]);
                    if (other != nullptr && u + h < rect_.columns)
                        raise(here[u], other[u + h]);
                }
        }
    }

    void store(int layer) {
        TiledRaster<std::uint8_t>& raster = levels_.joined_[static_cast<std::size_t>(layer)];
        const std::int32_t tiles = kTiles >> layer;
        for (std::int32_t y = y_ * tiles; y < std::min((y_ + 1) * tiles, raster.tilesY()); ++y)
            for (std::int32_t x = x_ * tiles; x < std::min((x_ + 1) * tiles, raster.tilesX()); ++x)
                raster.write(x, y, thinned(layer, x, y));
    }

    std::shared_ptr<std::uint8_t[]> thinned(int layer, std::int32_t x, std::int32_t y) {
        auto tile = TiledRaster<std::uint8_t>::newTile();
        for (std::int32_t v = 0; v < kRasterTilePosts; ++v)
            for (std::int32_t u = 0; u < kRasterTilePosts; ++u) {
                const std::int32_t i = ((x * kRasterTileCells + u) << layer) - rect_.i;
                const std::int32_t j = ((y * kRasterTileCells + v) << layer) - rect_.j;
                tile[static_cast<std::size_t>(v * kRasterTilePosts + u)] =
                    i < rect_.columns && j < rect_.rows ? row(j)[i] : std::uint8_t{0};
            }
        return tile;
    }

    void storeCoarse() {
        const std::int32_t endI = std::min(x_ * kCells + kCells, levels_.coveredI_ + 1);
        const std::int32_t endJ = std::min(y_ * kCells + kCells, levels_.coveredJ_ + 1);
        // The last column and row of the tiles begin no group of their own.
        const std::int32_t lastI = endI == levels_.coveredI_ ? endI + 1 : endI;
        const std::int32_t lastJ = endJ == levels_.coveredJ_ ? endJ + 1 : endJ;
        for (std::int32_t j = y_ * kCells; j < lastJ; j += kCoarseSpacing)
            for (std::int32_t i = x_ * kCells; i < lastI; i += kCoarseSpacing)
                levels_.coarse_[levels_.coarseIndex(i, j)] = row(j - rect_.j)[i - rect_.i];
    }

    VertexLevels& levels_;
    std::int32_t x_;
    std::int32_t y_;
    PostRect rect_;
    std::vector<std::uint8_t> counts_;
};

absl::Status VertexLevels::join(const import::ImportControl& control, const TileFilter& needed) {
    const auto isNeeded = [&](std::int32_t groupX, std::int32_t groupY) {
        if (!needed)
            return true;
        constexpr std::int32_t kTiles = GroupJoin::kTiles;
        for (std::int32_t y = groupY * kTiles; y < (groupY + 1) * kTiles; ++y)
            for (std::int32_t x = groupX * kTiles; x < (groupX + 1) * kTiles; ++x)
                if (x < measured_.tilesX() && y < measured_.tilesY() && needed(x, y))
                    return true;
        return false;
    };
    const auto over = [](std::int32_t tiles) {
        return (tiles + GroupJoin::kTiles - 1) / GroupJoin::kTiles;
    };
    return forEachTile(over(measured_.tilesX()), over(measured_.tilesY()), "joining", scratch_,
                       control, [&](std::int32_t x, std::int32_t y) {
                           if (isNeeded(x, y))
                               GroupJoin(*this, x, y).run();
                       });
}

}  // namespace eyrie::terrain
