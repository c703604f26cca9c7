// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/normal_map.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <memory>

#include "fabric/simd_clones.h"
#include "fabric/status.h"
#include "renderer/terrain/tile_progress.h"

namespace eyrie::terrain {
namespace {

constexpr std::int32_t kMaxSamples = kMaxTileCells + 1;

/// A tile's samples with one more on either side.
constexpr std::int32_t kPaddedSamples = kMaxSamples + 2;

/// Metres of object space as the normal needs them: n = (dP/di) x (dP/dj).
struct Basis {
    float ax, ay, bx, by, up;
};

/// Rise per post between two neighbours `inverse`^-1 posts apart, of which one may be nodata.
inline float slope(float before, float here, float after, float inverse) {
    const bool hasBefore = before == before;
    const bool hasAfter = after == after;
    const float low = hasBefore ? before : here;
    const float high = hasAfter ? after : here;
    const float rise = (high - low) * (hasBefore && hasAfter ? inverse : 2 * inverse);
    return rise == rise ? rise : 0.0F;
}

inline std::int8_t signedNormalised(float value) {
    return static_cast<std::int8_t>(value * 127.0F + (value < 0 ? -0.5F : 0.5F));
}

EYRIE_SIMD_CLONES void normalRow(const float* below, const float* here, const float* above,
                                 const float* inverseX, float inverseY, const Basis& basis,
                                 std::int32_t samples, std::int8_t* out) {
    for (std::int32_t k = 0; k < samples; ++k) {
        const float di = slope(here[k], here[k + 1], here[k + 2], inverseX[k]);
        const float dj = slope(below[k + 1], here[k + 1], above[k + 1], inverseY);
        const float x = basis.ay * dj - di * basis.by;
        const float y = di * basis.bx - basis.ax * dj;
        const float scale = 1.0F / std::sqrt(x * x + y * y + basis.up * basis.up);
        out[2 * k] = signedNormalised(x * scale);
        out[2 * k + 1] = signedNormalised(y * scale);
    }
}

float inverseDistance(std::int32_t before, std::int32_t after) {
    return after > before ? 1.0F / static_cast<float>(after - before) : 0.0F;
}

EYRIE_SIMD_CLONES void weigh(const float* source, float weight, std::int32_t columns, float* sum,
                             float* weights) {
    for (std::int32_t i = 0; i < columns; ++i) {
        const bool isData = source[i] == source[i];
        sum[i] += isData ? weight * source[i] : 0.0F;
        weights[i] += isData ? weight : 0.0F;
    }
}

/// One row of smoothed heights out of three rows of finer ones, every second column.
void smoothRow(const float* rows, std::int32_t stride, float* out) {
    constexpr std::int32_t kColumns = 2 * kRasterTilePosts + 1;
    std::array<float, kColumns> sum{};
    std::array<float, kColumns> weights{};
    for (std::int32_t d = 0; d < 3; ++d)
        weigh(rows + d * stride, d == 1 ? 2.0F : 1.0F, kColumns, sum.data(), weights.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(kRasterTilePosts); ++i)
        out[i] = (sum[2 * i] + 2 * sum[2 * i + 1] + sum[2 * i + 2]) /
                 (weights[2 * i] + 2 * weights[2 * i + 1] + weights[2 * i + 2]);
}

std::shared_ptr<float[]> smoothed(const TiledRaster<float>& finer, std::int32_t x, std::int32_t y) {
    constexpr std::int32_t kSide = 2 * kRasterTilePosts + 1;
    thread_local std::vector<float> posts(static_cast<std::size_t>(kSide) * kSide);
    readClamped(finer, {2 * x * kRasterTileCells - 1, 2 * y * kRasterTileCells - 1, kSide, kSide},
                posts.data());
    auto tile = TiledRaster<float>::newTile();
    for (std::int32_t v = 0; v < kRasterTilePosts; ++v)
        smoothRow(posts.data() + 2 * v * kSide, kSide, tile.get() + v * kRasterTilePosts);
    return tile;
}

}  // namespace

NormalMaps::NormalMaps(const ElevationModel& model, Scratch& scratch, int levels)
    : model_(model), scratch_(scratch) {
    std::int32_t columns = model.frame.columns;
    std::int32_t rows = model.frame.rows;
    for (int shift = 1; shift <= Quadtree::spacingShift(levels - 1); ++shift) {
        columns = columns / 2 + 1;
        rows = rows / 2 + 1;
        smoothed_.emplace_back(scratch, columns, rows);
    }
}

absl::Status NormalMaps::make(const import::ImportControl& control) {
    const import::ImportControl quiet{{}, control.stop};
    for (std::size_t k = 0; k < smoothed_.size(); ++k) {
        const TiledRaster<float>& finer = layer(static_cast<int>(k));
        TiledRaster<float>& coarser = smoothed_[k];
        RETURN_IF_ERROR(forEachTile(
            coarser.tilesX(), coarser.tilesY(), "smoothing", scratch_, quiet,
            [&](std::int32_t x, std::int32_t y) { coarser.write(x, y, smoothed(finer, x, y)); },
            Sweep::FromLastRow));
        control.report("smoothing",
                       static_cast<double>(k + 1) / static_cast<double>(smoothed_.size()));
    }
    return absl::OkStatus();
}

void NormalMaps::fill(const TileId& tile, std::span<std::int8_t> out) const {
    assert(out.size() == normalMapBytes(tile.level));
    const int shift = Quadtree::spacingShift(tile.level);
    const std::int32_t cells = Quadtree::cells(tile.level);
    const std::int32_t samples = cells + 1;
    const TiledRaster<float>& heights = layer(shift);
    const auto column = [&](std::int32_t k) {
        return std::clamp(tile.x * cells + k, 0, heights.columns() - 1);
    };
    const auto rowIndex = [&](std::int32_t k) {
        return std::clamp(tile.y * cells + k, 0, heights.rows() - 1);
    };
    const auto post = [&](std::int32_t sample, std::int32_t posts) {
        return std::min(sample << shift, posts - 1);
    };
    const std::int32_t side = samples + 2;
    std::array<float, static_cast<std::size_t>(kPaddedSamples) * kPaddedSamples> padded;
    readClamped(heights, {tile.x * cells - 1, tile.y * cells - 1, side, side}, padded.data());

    std::array<float, kMaxSamples> inverseX{};
    for (std::int32_t k = 0; k < samples; ++k)
        inverseX[static_cast<std::size_t>(k)] = inverseDistance(
            post(column(k - 1), model_.frame.columns), post(column(k + 1), model_.frame.columns));
    const fabric::Vec2 a = model_.frame.perColumn;
    const fabric::Vec2 b = model_.frame.perRow;
    const Basis basis{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(b.x),
                      static_cast<float>(b.y), static_cast<float>(a.x * b.y - a.y * b.x)};

    for (std::int32_t k = 0; k < samples; ++k) {
        const float inverseY = inverseDistance(post(rowIndex(k - 1), model_.frame.rows),
                                               post(rowIndex(k + 1), model_.frame.rows));
        const float* below = padded.data() + k * side;
        normalRow(below, below + side, below + 2 * side, inverseX.data(), inverseY, basis, samples,
                  out.data() + 2 * k * samples);
    }
}

}  // namespace eyrie::terrain
