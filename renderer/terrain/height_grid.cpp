// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/height_grid.h"

namespace eyrie::terrain {

void HeightStatistics::add(const float* posts, std::int32_t count) {
    float low = min;
    float high = max;
    std::int32_t nodata = 0;
    std::int32_t fractions = 0;
    for (std::int32_t i = 0; i < count; ++i) {
        const float h = posts[i];
        low = h < low ? h : low;
        high = h > high ? h : high;
        nodata += h != h ? 1 : 0;
        fractions += std::trunc(h) < h || std::trunc(h) > h ? 1 : 0;
    }
    min = low;
    max = high;
    nodataPosts += static_cast<std::uint64_t>(nodata);
    allIntegers = allIntegers && fractions == 0;
}

void HeightStatistics::add(const HeightStatistics& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    nodataPosts += other.nodataPosts;
    allIntegers = allIntegers && other.allIntegers;
}

namespace {

double latticeStepFor(double postMetres) {
    constexpr double kStepsPerPost = 256;
    // From 2 m above ground half of it is half a pixel of 360 lines.
    constexpr double kFineEnough = 1.0 / 64;
    constexpr double kMostStepsPerPost = 8192;
    constexpr double kCoarsest = 1.0 / 16;
    const double step =
        std::min(postMetres / kStepsPerPost,
                 std::clamp(postMetres / kMostStepsPerPost, kFineEnough, kCoarsest));
    return std::exp2(std::floor(std::log2(step)));
}

}  // namespace

HeightLattice chooseHeightLattice(const HeightStatistics& statistics, double postMetres) {
    constexpr double kMaxSteps = (1 << 23) - 1;
    HeightLattice lattice;
    if (!statistics.allIntegers)
        lattice = {latticeStepFor(postMetres), false};
    const double highest = statistics.highestMagnitude();
    while (highest / lattice.stepMetres > kMaxSteps) lattice = {lattice.stepMetres * 2, false};
    return lattice;
}

}  // namespace eyrie::terrain
