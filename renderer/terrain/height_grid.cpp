// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/height_grid.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace eyrie::terrain {
namespace {

void addRow(HeightStatistics& statistics, const float* row, std::int32_t columns) {
    float min = statistics.min;
    float max = statistics.max;
    std::int32_t nodata = 0;
    std::int32_t fractions = 0;
    for (std::int32_t i = 0; i < columns; ++i) {
        const float h = row[i];
        min = h < min ? h : min;
        max = h > max ? h : max;
        nodata += h != h ? 1 : 0;
        fractions += std::trunc(h) < h || std::trunc(h) > h ? 1 : 0;
    }
    statistics.min = min;
    statistics.max = max;
    statistics.nodataPosts += static_cast<std::uint64_t>(nodata);
    statistics.allIntegers = statistics.allIntegers && fractions == 0;
}

HeightStatistics join(HeightStatistics a, const HeightStatistics& b) {
    a.min = std::min(a.min, b.min);
    a.max = std::max(a.max, b.max);
    a.nodataPosts += b.nodataPosts;
    a.allIntegers = a.allIntegers && b.allIntegers;
    return a;
}

}  // namespace

HeightStatistics heightStatistics(const HeightGrid& grid) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::int32_t>(0, grid.rows), HeightStatistics{},
        [&](const tbb::blocked_range<std::int32_t>& range, HeightStatistics statistics) {
            for (std::int32_t j = range.begin(); j < range.end(); ++j)
                addRow(statistics, grid.row(j), grid.columns);
            return statistics;
        },
        join);
}

HeightLattice chooseHeightLattice(const HeightStatistics& statistics, double postMetres) {
    constexpr double kMaxSteps = (1 << 23) - 1;
    constexpr double kStepsPerPost = 256;
    constexpr double kCoarsestStep = 0.25;
    HeightLattice lattice;
    if (!statistics.allIntegers)
        lattice = {
            std::min(std::exp2(std::floor(std::log2(postMetres / kStepsPerPost))), kCoarsestStep),
            false};
    const double highest = std::max(std::abs(static_cast<double>(statistics.min)),
                                    std::abs(static_cast<double>(statistics.max)));
    while (highest / lattice.stepMetres > kMaxSteps) lattice = {lattice.stepMetres * 2, false};
    return lattice;
}

}  // namespace eyrie::terrain
