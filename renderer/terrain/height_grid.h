// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "fabric/vec.h"

namespace eyrie::terrain {

inline constexpr float kNodata = std::numeric_limits<float>::quiet_NaN();

/// Where the posts of an elevation model stand: post (i, j) at (x, y) = origin + i * perColumn + j
/// * perRow, in metres. The two span a right-handed basis (their determinant is positive): for a
/// raster with its north row first, row 0 here is the southern one.
struct GridFrame {
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    fabric::Vec2 origin{0, 0};
    fabric::Vec2 perColumn{1, 0};
    fabric::Vec2 perRow{0, 1};

    /// Side of a square as large as a cell.
    double postMetres() const { return std::sqrt(perColumn.x * perRow.y - perColumn.y * perRow.x); }
};

/// Posts of an elevation model in memory: row-major, post (i, j) is heights[j * columns + i] metres
/// high and stands where GridFrame says. NaN is nodata; there are no infinities.
struct HeightGrid {
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::vector<float> heights;
    fabric::Vec2 origin{0, 0};
    fabric::Vec2 perColumn{1, 0};
    fabric::Vec2 perRow{0, 1};

    const float* row(std::int32_t j) const {
        return heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
    }
    float* row(std::int32_t j) {
        return heights.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(columns);
    }
    float at(std::int32_t i, std::int32_t j) const { return row(j)[i]; }

    GridFrame frame() const { return {columns, rows, origin, perColumn, perRow}; }
};

/// What one pass over all posts tells.
struct HeightStatistics {
    float min = std::numeric_limits<float>::infinity();
    float max = -std::numeric_limits<float>::infinity();  ///< below min: there is no data at all
    std::uint64_t nodataPosts = 0;
    bool allIntegers = true;

    void add(const float* posts, std::int32_t count);
    void add(const HeightStatistics& other);
    bool operator==(const HeightStatistics&) const = default;
    double highestMagnitude() const {
        return std::max(std::abs(static_cast<double>(min)), std::abs(static_cast<double>(max)));
    }
};

/// The lattice of heights: multiples of a power of two, in metres.
struct HeightLattice {
    double stepMetres = 1;
    bool isLossless = true;  ///< every post lies on it

    /// A product with it is exact, as the division by stepMetres is, and faster.
    double stepsPerMetre() const { return 1 / stepMetres; }
    /// Precondition: `height` is not NaN and within the statistics the lattice was chosen for.
    static std::int32_t quantise(float height, double stepsPerMetre) {
        // Beyond 2^52 doubles are whole numbers: rounds halves to even, as std::nearbyint does,
        // which is a call on processors without SSE4.1.
        constexpr double kWhole = 0x1.8p52;
        return static_cast<std::int32_t>(static_cast<double>(height) * stepsPerMetre + kWhole -
                                         kWhole);
    }
};

/// 1 m for whole metres. Otherwise 1/64 m, less where posts are nearer than 4 m (at most 1/256 of
/// a post) and more where they are 256 m or more apart (1/8192 of a post, 1/16 m at most). Coarser
/// only where heights would not stay below 2^23 steps.
HeightLattice chooseHeightLattice(const HeightStatistics& statistics, double postMetres);

}  // namespace eyrie::terrain
