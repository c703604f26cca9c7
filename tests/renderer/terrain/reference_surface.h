// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/terrain/deviation.h"
#include "renderer/terrain/height_grid.h"

/// What terrain is held against in these tests: written from the definitions, sharing no code with
/// what it checks.
namespace eyrie::test {

/// The three readings of a grid at (x, y) posts: cells split from post (i, j) to (i + 1, j + 1),
/// along the other diagonal, and bilinear.
inline std::array<double, 3> readings(const terrain::HeightGrid& grid, double x, double y) {
    const auto i = std::min(static_cast<std::int32_t>(std::floor(x)), grid.columns - 2);
    const auto j = std::min(static_cast<std::int32_t>(std::floor(y)), grid.rows - 2);
    const double u = x - i;
    const double v = y - j;
    const double a = grid.at(i, j), b = grid.at(i + 1, j);
    const double c = grid.at(i, j + 1), d = grid.at(i + 1, j + 1);
    const double mainDiagonal =
        u >= v ? a + u * (b - a) + v * (d - b) : a + v * (c - a) + u * (d - c);
    const double otherDiagonal =
        u + v <= 1 ? a + u * (b - a) + v * (c - a) : d + (1 - u) * (c - d) + (1 - v) * (b - d);
    const double bilinear = a * (1 - u) * (1 - v) + b * u * (1 - v) + c * (1 - u) * v + d * u * v;
    return {mainDiagonal, otherDiagonal, bilinear};
}

/// Barycentric coordinates of (x, y) in a triangle of posts with an area.
inline std::array<double, 3> barycentric(const terrain::Triangle& t, double x, double y) {
    const double x1 = t[1].i - t[0].i, y1 = t[1].j - t[0].j;
    const double x2 = t[2].i - t[0].i, y2 = t[2].j - t[0].j;
    const double det = x1 * y2 - x2 * y1;
    const double b = ((x - t[0].i) * y2 - x2 * (y - t[0].j)) / det;
    const double c = (x1 * (y - t[0].j) - (x - t[0].i) * y1) / det;
    return {1 - b - c, b, c};
}

inline bool isInside(const std::array<double, 3>& weights) {
    return std::min({weights[0], weights[1], weights[2]}) >= -1e-12;
}

/// Calls visit(x, y, drawn height) for all points of a triangle on a lattice of 1 / `density`
/// posts.
template <typename Visit>
void forEachSample(const terrain::Triangle& t, int density, Visit visit) {
    const auto [left, right] = std::minmax({t[0].i, t[1].i, t[2].i});
    const auto [bottom, top] = std::minmax({t[0].j, t[1].j, t[2].j});
    for (std::int32_t sy = bottom * density; sy <= top * density; ++sy)
        for (std::int32_t sx = left * density; sx <= right * density; ++sx) {
            const double x = static_cast<double>(sx) / density;
            const double y = static_cast<double>(sy) / density;
            const auto w = barycentric(t, x, y);
            if (isInside(w))
                visit(x, y, w[0] * t[0].z + w[1] * t[1].z + w[2] * t[2].z);
        }
}

}  // namespace eyrie::test
