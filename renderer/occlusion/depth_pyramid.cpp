// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/depth_pyramid.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "fabric/frustum.h"
#include "fabric/simd_clones.h"
#include "renderer/lod/frustum_clip.h"

namespace eyrie::occlusion {
namespace {

constexpr float kRasterisationMargin = 1.0F / 512;

/// least[i] = min(least[i], row[i]).
EYRIE_SIMD_CLONES void takeLesser(float* __restrict least, const float* __restrict row, int count) {
    for (int i = 0; i < count; ++i) least[i] = row[i] < least[i] ? row[i] : least[i];
}

int blocksIn(int pixels, int side) { return (pixels + side - 1) / side; }

}  // namespace

DepthPyramid::Level DepthPyramid::smallestBlocks(int width, int height,
                                                 std::span<const float> depth) {
    Level level{blocksIn(width, kBlockPixels), blocksIn(height, kBlockPixels), {}};
    level.farthest.reserve(static_cast<std::size_t>(level.width) *
                           static_cast<std::size_t>(level.height));
    std::vector<float> columns(static_cast<std::size_t>(width));
    for (int y = 0; y < height; y += kBlockPixels) {
        std::fill(columns.begin(), columns.end(), std::numeric_limits<float>::infinity());
        for (int row = y; row < std::min(y + kBlockPixels, height); ++row)
            takeLesser(
                columns.data(),
                depth.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(width),
                width);
        for (int x = 0; x < width; x += kBlockPixels)
            level.farthest.push_back(*std::min_element(
                columns.begin() + x, columns.begin() + std::min(x + kBlockPixels, width)));
    }
    return level;
}

DepthPyramid::Level DepthPyramid::blocksOf(const Level& finer) {
    Level level{blocksIn(finer.width, 2), blocksIn(finer.height, 2), {}};
    level.farthest.reserve(static_cast<std::size_t>(level.width) *
                           static_cast<std::size_t>(level.height));
    for (int y = 0; y < finer.height; y += 2)
        for (int x = 0; x < finer.width; x += 2) {
            const int x1 = std::min(x + 1, finer.width - 1);
            const int y1 = std::min(y + 1, finer.height - 1);
            level.farthest.push_back(
                std::min({finer.at(x, y), finer.at(x1, y), finer.at(x, y1), finer.at(x1, y1)}));
        }
    return level;
}

void DepthPyramid::build(const fabric::PixelViewport& area, std::span<const float> depth) {
    area_ = area;
    levels_.clear();
    if (area.isEmpty())
        return;
    assert(depth.size() == static_cast<std::size_t>(area.area()));
    levels_.push_back(smallestBlocks(area.width, area.height, depth));
    while (levels_.back().farthest.size() > 1) levels_.push_back(blocksOf(levels_.back()));
}

bool DepthPyramid::hides(const fabric::PixelViewport& rect, float reversedDepth) const {
    const fabric::PixelViewport seen = intersection(rect, area_);
    if (seen.isEmpty())
        return true;
    const int x = seen.x - area_.x;
    const int y = seen.y - area_.y;
    const Blocks blocks{x / kBlockPixels, y / kBlockPixels, (x + seen.width - 1) / kBlockPixels,
                        (y + seen.height - 1) / kBlockPixels};
    return hides(levels_.size() - 1, 0, 0, blocks, reversedDepth);
}

/// Of the block (x, y) of a level, which `blocks` touches.
bool DepthPyramid::hides(std::size_t level, int x, int y, const Blocks& blocks,
                         float reversedDepth) const {
    if (levels_[level].at(x, y) > reversedDepth)
        return true;
    if (level == 0)
        return false;
    const auto finer = static_cast<int>(level) - 1;
    for (int childY = std::max(2 * y, blocks.y0 >> finer);
         childY <= std::min(2 * y + 1, blocks.y1 >> finer); ++childY)
        for (int childX = std::max(2 * x, blocks.x0 >> finer);
             childX <= std::min(2 * x + 1, blocks.x1 >> finer); ++childX)
            if (!hides(level - 1, childX, childY, blocks, reversedDepth))
                return false;
    return true;
}

float nearestReversedDepth(const lod::ObjectView& view, const fabric::Box& bounds) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const fabric::Vec3& corner : lod::viewCorners(bounds, view.viewFromObject()))
        nearest = std::min(nearest, corner.z);
    if (!(nearest > fabric::kNearMetres))
        return std::numeric_limits<float>::infinity();
    return static_cast<float>(fabric::kNearMetres / nearest) * (1 + kRasterisationMargin);
}

bool isHidden(const DepthPyramid& pyramid, const lod::ObjectView& view, const fabric::Box& bounds) {
    return pyramid.hides(view.coveredPixels(bounds), nearestReversedDepth(view, bounds));
}

}  // namespace eyrie::occlusion
