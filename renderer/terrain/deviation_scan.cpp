// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation_scan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "fabric/simd_clones.h"
#include "renderer/terrain/floor_divide.h"

namespace eyrie::terrain {
namespace {

/// Rows firstRow to firstRow + count - 1 of a triangle, columns low to high; both ends move by
/// whole columns from row to row.
struct Slab {
    std::int32_t firstRow;
    std::int32_t count;
    std::int32_t low;
    std::int32_t lowStep;
    std::int32_t high;
    std::int32_t highStep;
};

struct Slabs {
    std::array<Slab, 2> slabs;
    int count = 0;
};

/// An aligned triangle as one slab, or two where its hypotenuse is a column.
Slabs slabsOf(const Triangle& t) {
    const std::int32_t i = t[0].i, j = t[0].j;
    const std::int32_t di1 = t[1].i - i, dj1 = t[1].j - j;
    const std::int32_t di2 = t[2].i - i, dj2 = t[2].j - j;
    if (di1 == 0 || dj1 == 0) {  // legs along the axes
        const std::int32_t across = di1 + di2;
        const std::int32_t up = dj1 + dj2;
        const std::int32_t low = across < 0 ? i + across : i;
        const std::int32_t high = across < 0 ? i : i + across;
        const std::int32_t length = std::abs(up);
        if (up > 0)  // widest first
            return {{Slab{j, length + 1, low, across < 0 ? 1 : 0, high, across < 0 ? 0 : -1}}, 1};
        return {{Slab{j - length, length + 1, across < 0 ? i : low, across < 0 ? -1 : 0,
                      across < 0 ? high : i, across < 0 ? 0 : 1}},
                1};
    }
    const std::int32_t half = std::abs(di1);
    if (dj1 == dj2) {  // hypotenuse along a row
        if (dj1 > 0)
            return {{Slab{j, half + 1, i, -1, i, 1}}, 1};
        return {{Slab{j - half, half + 1, i - half, 1, i + half, -1}}, 1};
    }
    const std::int32_t h = i + di1;
    if (di1 > 0)
        return {{Slab{j - half, half, h, -1, h, 0}, Slab{j, half + 1, i, 1, h, 0}}, 2};
    return {{Slab{j - half, half, h, 0, h, 1}, Slab{j, half + 1, h, 0, i, -1}}, 2};
}

/// The hot loop. NaN never wins a comparison. A post's distance is computed the same way wherever
/// a row starts.
inline double rowDeviation(const float* row, std::int32_t count, double first, double slope,
                           std::int32_t offset, double worst) {
#pragma omp simd reduction(max : worst)
    for (std::int32_t k = 0; k < count; ++k) {
        const double d = std::abs(static_cast<double>(row[k]) -
                                  (first + slope * static_cast<double>(offset + k)));
        worst = d > worst ? d : worst;
    }
    return worst;
}

EYRIE_SIMD_CLONES double slabDeviation(const HeightPatch& patch, const Slab& slab,
                                       const Plane& plane, double worst) {
    std::int32_t low = slab.low;
    std::int32_t high = slab.high;
    for (std::int32_t r = 0; r < slab.count; ++r) {
        const std::int32_t j = slab.firstRow + r;
        const double first = plane.z0 + plane.perRow * (j - plane.j0);
        worst = rowDeviation(patch.row(j) + (low - patch.i0), high - low + 1, first,
                             plane.perColumn, low - plane.i0, worst);
        low += slab.lowStep;
        high += slab.highStep;
    }
    return worst;
}

/// One row without the set-up of a vector loop.
__attribute__((optimize("no-tree-vectorize"))) double shortRowDeviation(
    const HeightPatch& patch, std::int32_t j, std::int32_t low, std::int32_t high,
    const Plane& plane, double worst) {
    const double first = plane.z0 + plane.perRow * (j - plane.j0);
    const float* row = patch.row(j) - patch.i0;
    for (std::int32_t i = low; i <= high; ++i) {
        const double d =
            std::abs(static_cast<double>(row[i]) - (first + plane.perColumn * (i - plane.i0)));
        worst = d > worst ? d : worst;
    }
    return worst;
}

EYRIE_SIMD_CLONES std::int32_t countNodata(const float* row, std::int32_t count) {
    std::int32_t nodata = 0;
#pragma omp simd reduction(+ : nodata)
    for (std::int32_t k = 0; k < count; ++k) nodata += row[k] != row[k] ? 1 : 0;
    return nodata;
}

Triangle sortedByRow(Triangle t) {
    if (t[1].j < t[0].j)
        std::swap(t[0], t[1]);
    if (t[2].j < t[1].j)
        std::swap(t[1], t[2]);
    if (t[1].j < t[0].j)
        std::swap(t[0], t[1]);
    return t;
}

/// Calls visit(row, low, high) for the patch's posts of any closed triangle, row by row.
template <typename Visit>
void forEachRow(const HeightPatch& patch, const Triangle& triangle, Visit visit) {
    const auto [a, b, c] = sortedByRow(triangle);
    const auto low = [](const Corner& p, const Corner& q, std::int32_t j) {
        return p.i + ceilDivide(std::int64_t{q.i - p.i} * (j - p.j), q.j - p.j);
    };
    const auto high = [](const Corner& p, const Corner& q, std::int32_t j) {
        return p.i + floorDivide(std::int64_t{q.i - p.i} * (j - p.j), q.j - p.j);
    };
    const bool longIsLow =
        std::int64_t{c.i - a.i} * (b.j - a.j) <= std::int64_t{c.j - a.j} * (b.i - a.i);
    for (std::int32_t j = std::max(a.j, patch.j0); j <= std::min(c.j, patch.j1); ++j) {
        std::int64_t first;
        std::int64_t last;
        if (j == b.j) {
            first = longIsLow ? low(a, c, j) : b.i;
            last = longIsLow ? b.i : high(a, c, j);
        } else {
            const Corner& p = j < b.j ? a : b;
            const Corner& q = j < b.j ? b : c;
            first = longIsLow ? low(a, c, j) : low(p, q, j);
            last = longIsLow ? high(p, q, j) : high(a, c, j);
        }
        first = std::max<std::int64_t>(first, patch.i0);
        last = std::min<std::int64_t>(last, patch.i1);
        if (first <= last)
            visit(j, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last));
    }
}

}  // namespace

HeightPatch HeightPatch::clipped(std::int32_t fromI, std::int32_t fromJ, std::int32_t toI,
                                 std::int32_t toJ) const {
    HeightPatch part = *this;
    part.i0 = std::max(i0, fromI);
    part.j0 = std::max(j0, fromJ);
    part.i1 = std::min(i1, toI);
    part.j1 = std::min(j1, toJ);
    part.posts = row(part.j0) + (part.i0 - i0);
    return part;
}

Plane planeOf(const Triangle& t) {
    const double x1 = t[1].i - t[0].i, y1 = t[1].j - t[0].j, z1 = t[1].z - t[0].z;
    const double x2 = t[2].i - t[0].i, y2 = t[2].j - t[0].j, z2 = t[2].z - t[0].z;
    const double determinant = x1 * y2 - x2 * y1;
    return {t[0].i, t[0].j, t[0].z, (z1 * y2 - z2 * y1) / determinant,
            (x1 * z2 - x2 * z1) / determinant};
}

/// The determinant is a power of two, or that negated: dividing by it is exact.
Plane planeOfAligned(const Triangle& t) {
    const double x1 = t[1].i - t[0].i, y1 = t[1].j - t[0].j, z1 = t[1].z - t[0].z;
    const double x2 = t[2].i - t[0].i, y2 = t[2].j - t[0].j, z2 = t[2].z - t[0].z;
    const double inverse = 1 / (x1 * y2 - x2 * y1);
    return {t[0].i, t[0].j, t[0].z, (z1 * y2 - z2 * y1) * inverse, (x1 * z2 - x2 * z1) * inverse};
}

double scanAligned(const HeightPatch& patch, const Triangle& triangle, const Plane& plane,
                   double worst) {
    const Slabs slabs = slabsOf(triangle);
    for (int k = 0; k < slabs.count; ++k) {
        const Slab& slab = slabs.slabs[static_cast<std::size_t>(k)];
        worst = slabDeviation(patch, slab, plane, worst);
    }
    return worst;
}

double scanGeneral(const HeightPatch& patch, const Triangle& triangle, const Plane& plane,
                   double worst) {
    constexpr std::int32_t kShort = 16;  // posts
    forEachRow(patch, triangle, [&](std::int32_t j, std::int32_t low, std::int32_t high) {
        worst = high - low < kShort ? shortRowDeviation(patch, j, low, high, plane, worst)
                                    : slabDeviation(patch, {j, 1, low, 0, high, 0}, plane, worst);
    });
    return worst;
}

PostCounts countPosts(const HeightPatch& patch, const Triangle& triangle) {
    PostCounts counts;
    forEachRow(patch, triangle, [&](std::int32_t j, std::int32_t low, std::int32_t high) {
        const std::int32_t posts = high - low + 1;
        const std::int32_t nodata = countNodata(patch.row(j) + (low - patch.i0), posts);
        counts.nodata += nodata;
        counts.data += posts - nodata;
    });
    return counts;
}

}  // namespace eyrie::terrain
