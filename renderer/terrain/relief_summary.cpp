// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/relief_summary.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "fabric/simd_clones.h"

namespace eyrie::terrain {
namespace {

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    std::int32_t nodata = 0;
};

/// Of the posts' heights over a plane through the first post's place.
EYRIE_SIMD_CLONES Range rangeOver(const float* posts, std::int32_t side, double z0,
                                  double perColumn, double perRow) {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    std::int32_t nodata = 0;
    for (std::int32_t j = 0; j < side; ++j) {
        const float* row = posts + j * kRasterTilePosts;
        const double first = z0 + perRow * j;
#pragma omp simd reduction(min : low) reduction(max : high) reduction(+ : nodata)
        for (std::int32_t i = 0; i < side; ++i) {
            const double d = static_cast<double>(row[i]) - (first + perColumn * i);
            low = d < low ? d : low;
            high = d > high ? d : high;
            nodata += row[i] != row[i] ? 1 : 0;
        }
    }
    return {low, high, nodata};
}

float finite(float value) { return std::isfinite(value) ? value : 0; }

float below(double value) {
    return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity());
}

float above(double value) { return -below(-value); }

}  // namespace

ReliefSummary::ReliefSummary(std::int32_t columns, std::int32_t rows) {
    constexpr std::int64_t kMostBlocks = 1'500'000;
    const auto over = [&](std::int32_t posts) {
        const std::int32_t tiles =
            std::max(1, (posts - 1 + kRasterTileCells - 1) / kRasterTileCells);
        return std::int64_t{tiles} * (kRasterTileCells / blockCells_);
    };
    while (blockCells_ < kRasterTileCells && over(columns) * over(rows) > kMostBlocks)
        blockCells_ *= 2;
    across_ = static_cast<std::int32_t>(over(columns));
    blocks_.resize(static_cast<std::size_t>(over(columns) * over(rows)));
}

void ReliefSummary::add(std::int32_t x, std::int32_t y, const float* tile) {
    const std::int32_t perTile = kRasterTileCells / blockCells_;
    const auto side = static_cast<float>(blockCells_);
    for (std::int32_t v = 0; v < perTile; ++v)
        for (std::int32_t u = 0; u < perTile; ++u) {
            const float* first = tile + (v * kRasterTilePosts + u) * blockCells_;
            const float* last = first + blockCells_ * kRasterTilePosts;
            const float a = *first, b = first[blockCells_], c = *last, d = last[blockCells_];
            Block& block = blocks_[static_cast<std::size_t>(y * perTile + v) *
                                       static_cast<std::size_t>(across_) +
                                   static_cast<std::size_t>(x * perTile + u)];
            block.perColumn = finite((b - a + (d - c)) / (2 * side));
            block.perRow = finite((c - a + (d - b)) / (2 * side));
            block.z0 = finite(a);
            const Range range =
                rangeOver(first, blockCells_ + 1, static_cast<double>(block.z0),
                          static_cast<double>(block.perColumn), static_cast<double>(block.perRow));
            block.low = below(range.low);
            block.high = above(range.high);
            block.hasNodata = range.nodata > 0 ? 1 : 0;
        }
}

double ReliefSummary::farthest(std::int32_t x, std::int32_t y, const Plane& plane) const {
    const Block& block = at(x, y);
    if (block.low > block.high)
        return 0;
    const double first = static_cast<double>(block.z0) - plane.at(x * blockCells_, y * blockCells_);
    const double across = (static_cast<double>(block.perColumn) - plane.perColumn) * blockCells_;
    const double up = (static_cast<double>(block.perRow) - plane.perRow) * blockCells_;
    const double lowest =
        first + std::min(across, 0.0) + std::min(up, 0.0) + static_cast<double>(block.low);
    const double highest =
        first + std::max(across, 0.0) + std::max(up, 0.0) + static_cast<double>(block.high);
    constexpr double kRounding = 1e-12;
    const double slack = kRounding * (std::abs(static_cast<double>(block.z0)) + std::abs(first) +
                                      std::abs(across) + std::abs(up));
    return std::max(std::abs(lowest), std::abs(highest)) + slack;
}

std::vector<std::byte> ReliefSummary::bytes() const {
    std::vector<std::byte> bytes(blocks_.size() * sizeof(Block));
    std::memcpy(bytes.data(), blocks_.data(), bytes.size());
    return bytes;
}

bool ReliefSummary::restore(std::span<const std::byte> bytes) {
    if (bytes.size() != blocks_.size() * sizeof(Block))
        return false;
    std::memcpy(blocks_.data(), bytes.data(), bytes.size());
    return true;
}

}  // namespace eyrie::terrain
