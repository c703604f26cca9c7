// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/normal_map.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <tbb/parallel_for.h>

#include "fabric/simd_clones.h"

namespace eyrie::terrain {
namespace {

constexpr std::int32_t kMaxSamples = kMaxTileCells + 1;

/// A row of a tile's heights with one sample more on either side.
using PaddedRow = std::array<float, kMaxSamples + 2>;

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

}  // namespace

NormalMaps::NormalMaps(const HeightGrid& grid, int levels)
    : grid_(grid), thinned_(static_cast<std::size_t>(Quadtree::spacingShift(levels - 1) + 1)) {
    thinned_[0] = {grid.columns, grid.rows, {}};
    for (std::size_t shift = 1; shift < thinned_.size(); ++shift) {
        const Thinned& finer = thinned_[shift - 1];
        Thinned& coarser = thinned_[shift];
        coarser.columns = finer.columns / 2 + 1;
        coarser.rows = finer.rows / 2 + 1;
        coarser.heights.resize(static_cast<std::size_t>(coarser.columns) *
                               static_cast<std::size_t>(coarser.rows));
        tbb::parallel_for(std::int32_t{0}, coarser.rows,
                          [&](std::int32_t j) { smoothRow(static_cast<int>(shift), j); });
    }
}

const float* NormalMaps::row(int shift, std::int32_t j) const {
    if (shift == 0)
        return grid_.row(j);
    const Thinned& thinned = thinned_[static_cast<std::size_t>(shift)];
    return thinned.heights.data() +
           static_cast<std::size_t>(j) * static_cast<std::size_t>(thinned.columns);
}

void NormalMaps::smoothRow(int shift, std::int32_t j) {
    Thinned& coarser = thinned_[static_cast<std::size_t>(shift)];
    const Thinned& finer = thinned_[static_cast<std::size_t>(shift - 1)];
    thread_local std::vector<float> sum;
    thread_local std::vector<float> weights;
    sum.assign(static_cast<std::size_t>(finer.columns), 0.0F);
    weights.assign(static_cast<std::size_t>(finer.columns), 0.0F);
    for (std::int32_t d = -1; d <= 1; ++d)
        weigh(row(shift - 1, std::clamp(2 * j + d, 0, finer.rows - 1)), d == 0 ? 2.0F : 1.0F,
              finer.columns, sum.data(), weights.data());
    float* out = coarser.heights.data() +
                 static_cast<std::size_t>(j) * static_cast<std::size_t>(coarser.columns);
    for (std::int32_t i = 0; i < coarser.columns; ++i) {
        const auto at = [&](std::int32_t k) {
            return static_cast<std::size_t>(std::clamp(k, 0, finer.columns - 1));
        };
        const std::size_t a = at(2 * i - 1), b = at(2 * i), c = at(2 * i + 1);
        out[i] = (sum[a] + 2 * sum[b] + sum[c]) / (weights[a] + 2 * weights[b] + weights[c]);
    }
}

void NormalMaps::fill(const TileId& tile, std::span<std::int8_t> out) const {
    assert(out.size() == normalMapBytes(tile.level));
    const int shift = Quadtree::spacingShift(tile.level);
    const std::int32_t cells = Quadtree::cells(tile.level);
    const std::int32_t samples = cells + 1;
    const Thinned& thinned = thinned_[static_cast<std::size_t>(shift)];
    const auto column = [&](std::int32_t k) {
        return std::clamp(tile.x * cells + k, 0, thinned.columns - 1);
    };
    const auto rowIndex = [&](std::int32_t k) {
        return std::clamp(tile.y * cells + k, 0, thinned.rows - 1);
    };
    const auto post = [&](std::int32_t sample, std::int32_t posts) {
        return std::min(sample << shift, posts - 1);
    };
    const auto load = [&](std::int32_t k, PaddedRow& padded) {
        const float* source = row(shift, rowIndex(k));
        for (std::int32_t i = 0; i < samples + 2; ++i)
            padded[static_cast<std::size_t>(i)] = source[column(i - 1)];
    };

    std::array<float, kMaxSamples> inverseX{};
    for (std::int32_t k = 0; k < samples; ++k)
        inverseX[static_cast<std::size_t>(k)] =
            inverseDistance(post(column(k - 1), grid_.columns), post(column(k + 1), grid_.columns));
    const fabric::Vec2 a = grid_.perColumn;
    const fabric::Vec2 b = grid_.perRow;
    const Basis basis{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(b.x),
                      static_cast<float>(b.y), static_cast<float>(a.x * b.y - a.y * b.x)};

    std::array<PaddedRow, 3> rows{};
    load(-1, rows[0]);
    load(0, rows[1]);
    for (std::int32_t k = 0; k < samples; ++k) {
        const auto r = static_cast<std::size_t>(k);
        load(k + 1, rows[(r + 2) % 3]);
        const float inverseY =
            inverseDistance(post(rowIndex(k - 1), grid_.rows), post(rowIndex(k + 1), grid_.rows));
        normalRow(rows[r % 3].data(), rows[(r + 1) % 3].data(), rows[(r + 2) % 3].data(),
                  inverseX.data(), inverseY, basis, samples,
                  out.data() + r * 2 * static_cast<std::size_t>(samples));
    }
}

}  // namespace eyrie::terrain
