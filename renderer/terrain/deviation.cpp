// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <glm/geometric.hpp>

#include "fabric/simd_clones.h"

namespace eyrie::terrain {
namespace {

/// z over the lattice: z0 + perColumn * (i - i0) + perRow * (j - j0).
struct Plane {
    explicit Plane(const Triangle& t) : i0(t[0].i), j0(t[0].j), z0(t[0].z) {
        // All exact in double for aligned triangles, whose determinant is a power of two.
        const double x1 = t[1].i - i0, y1 = t[1].j - j0, z1 = t[1].z - z0;
        const double x2 = t[2].i - i0, y2 = t[2].j - j0, z2 = t[2].z - z0;
        const double determinant = x1 * y2 - x2 * y1;
        perColumn = (z1 * y2 - z2 * y1) / determinant;
        perRow = (x1 * z2 - x2 * z1) / determinant;
    }

    double at(std::int32_t i, std::int32_t j) const {
        return z0 + perColumn * (i - i0) + perRow * (j - j0);
    }

    std::int32_t i0;
    std::int32_t j0;
    double z0;
    double perColumn;
    double perRow;
};

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

Triangle sortedByRow(Triangle t) {
    if (t[1].j < t[0].j)
        std::swap(t[0], t[1]);
    if (t[2].j < t[1].j)
        std::swap(t[1], t[2]);
    if (t[1].j < t[0].j)
        std::swap(t[0], t[1]);
    return t;
}

std::int32_t columnStep(const Corner& from, const Corner& to) {
    return (to.i - from.i) / (to.j - from.j);
}

/// An aligned triangle as one slab, or two where its hypotenuse is a column.
Slabs slabsOf(const Triangle& triangle) {
    const auto [a, b, c] = sortedByRow(triangle);
    Slabs result;
    const auto add = [&](std::int32_t row, std::int32_t count, std::int32_t x, std::int32_t xStep,
                         std::int32_t y, std::int32_t yStep) {
        const bool xIsLow = x < y || (x == y && xStep < yStep);
        result.slabs[static_cast<std::size_t>(result.count++)] =
            xIsLow ? Slab{row, count, x, xStep, y, yStep} : Slab{row, count, y, yStep, x, xStep};
    };
    const std::int32_t longStep = columnStep(a, c);
    if (a.j == b.j) {
        add(a.j, c.j - a.j + 1, a.i, longStep, b.i, columnStep(b, c));
    } else if (b.j == c.j) {
        add(a.j, c.j - a.j + 1, a.i, longStep, a.i, columnStep(a, b));
    } else {
        add(a.j, b.j - a.j + 1, a.i, longStep, a.i, columnStep(a, b));
        const std::int32_t next = b.j + 1;
        const std::int32_t shortStep = columnStep(b, c);
        add(next, c.j - b.j, a.i + longStep * (next - a.j), longStep, b.i + shortStep, shortStep);
    }
    return result;
}

/// The hot loop. NaN never wins a comparison.
EYRIE_SIMD_CLONES double slabDeviation(const float* heights, std::ptrdiff_t stride,
                                       const Slab& slab, const Plane& plane) {
    double worst = 0;
    std::int32_t low = slab.low;
    std::int32_t high = slab.high;
    for (std::int32_t r = 0; r < slab.count; ++r) {
        const std::int32_t j = slab.firstRow + r;
        const float* row = heights + stride * j + low;
        const double first = plane.at(low, j);
        const double slope = plane.perColumn;
        const std::int32_t count = high - low + 1;
#pragma omp simd reduction(max : worst)
        for (std::int32_t k = 0; k < count; ++k) {
            const double d = std::abs(static_cast<double>(row[k]) - (first + slope * k));
            worst = d > worst ? d : worst;
        }
        low += slab.lowStep;
        high += slab.highStep;
    }
    return worst;
}

EYRIE_SIMD_CLONES std::int32_t countNodata(const float* row, std::int32_t count) {
    std::int32_t nodata = 0;
#pragma omp simd reduction(+ : nodata)
    for (std::int32_t k = 0; k < count; ++k) nodata += row[k] != row[k] ? 1 : 0;
    return nodata;
}

std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
    return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

std::int64_t ceilDivide(std::int64_t a, std::int64_t b) { return -floorDivide(-a, b); }

/// Calls visit(row, low, high) for the posts of any closed triangle, row by row.
template <typename Visit>
void forEachRow(const Triangle& triangle, Visit visit) {
    const auto [a, b, c] = sortedByRow(triangle);
    const auto low = [](const Corner& p, const Corner& q, std::int32_t j) {
        return p.i + ceilDivide(std::int64_t{q.i - p.i} * (j - p.j), q.j - p.j);
    };
    const auto high = [](const Corner& p, const Corner& q, std::int32_t j) {
        return p.i + floorDivide(std::int64_t{q.i - p.i} * (j - p.j), q.j - p.j);
    };
    const bool longIsLow =
        std::int64_t{c.i - a.i} * (b.j - a.j) <= std::int64_t{c.j - a.j} * (b.i - a.i);
    for (std::int32_t j = a.j; j <= c.j; ++j) {
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
        if (first <= last)
            visit(j, static_cast<std::int32_t>(first), static_cast<std::int32_t>(last));
    }
}

bool isDiagonal(const Corner& a, const Corner& b) {
    return std::abs(b.i - a.i) == std::abs(b.j - a.j);
}

/// Distances of a drawn edge a-b from the source where the edge meets lines of the lattice.
/// A line is met at a + t (b - a) with t = num / den.
class EdgeCrossings {
public:
    EdgeCrossings(const HeightGrid& grid, const Corner& a, const Corner& b)
        : grid_(grid), a_(a), dx_(b.i - a.i), dy_(b.j - a.j), dz_(b.z - a.z) {}

    void atColumns() {
        for (std::int64_t k = 1; k < std::abs(dx_); ++k) {
            const Split y = split(a_.j, dy_, k, std::abs(dx_));
            const std::int32_t i = column(dx_ < 0 ? -k : k);
            if (y.fraction != 0)
                note(k, std::abs(dx_), grid_.at(i, y.whole), grid_.at(i, y.whole + 1), y.fraction);
        }
    }

    void atRows() {
        for (std::int64_t k = 1; k < std::abs(dy_); ++k) {
            const Split x = split(a_.i, dx_, k, std::abs(dy_));
            const auto j = static_cast<std::int32_t>(a_.j + (dy_ < 0 ? -k : k));
            if (x.fraction != 0)
                note(k, std::abs(dy_), grid_.at(x.whole, j), grid_.at(x.whole + 1, j), x.fraction);
        }
    }

    /// Diagonals i - j = constant, from post (i, j) to (i + 1, j + 1).
    void atMainDiagonals() {
        const std::int64_t den = std::abs(dx_ - dy_);
        for (std::int64_t k = 1; k < den; ++k) {
            const Split x = split(a_.i, dx_, k, den);
            const Split y = split(a_.j, dy_, k, den);
            if (x.fraction != 0)
                note(k, den, grid_.at(x.whole, y.whole), grid_.at(x.whole + 1, y.whole + 1),
                     x.fraction);
        }
    }

    /// Diagonals i + j = constant, from post (i, j + 1) to (i + 1, j).
    void atOtherDiagonals() {
        const std::int64_t den = std::abs(dx_ + dy_);
        for (std::int64_t k = 1; k < den; ++k) {
            const Split x = split(a_.i, dx_, k, den);
            const Split y = split(a_.j, dy_, k, den);
            if (x.fraction != 0)
                note(k, den, grid_.at(x.whole, y.whole + 1), grid_.at(x.whole + 1, y.whole),
                     x.fraction);
        }
    }

    double worst() const { return worst_; }
    bool meetsNodata() const { return meetsNodata_; }

private:
    struct Split {
        std::int32_t whole;
        double fraction;
    };

    static Split split(std::int64_t start, std::int64_t delta, std::int64_t num, std::int64_t den) {
        const std::int64_t scaled = delta * num;
        const std::int64_t whole = floorDivide(scaled, den);
        return {static_cast<std::int32_t>(start + whole),
                static_cast<double>(scaled - whole * den) / static_cast<double>(den)};
    }

    std::int32_t column(std::int64_t offset) const {
        return static_cast<std::int32_t>(a_.i + offset);
    }

    void note(std::int64_t num, std::int64_t den, double h0, double h1, double fraction) {
        const double drawn = a_.z + dz_ * (static_cast<double>(num) / static_cast<double>(den));
        const double d = std::abs(drawn - (h0 + (h1 - h0) * fraction));
        if (d != d)
            meetsNodata_ = true;
        else
            worst_ = std::max(worst_, d);
    }

    const HeightGrid& grid_;
    Corner a_;
    std::int64_t dx_;
    std::int64_t dy_;
    double dz_;
    double worst_ = 0;
    bool meetsNodata_ = false;
};

}  // namespace

SourceSurface::SourceSurface(const HeightGrid& grid, bool hasNodata)
    : grid_(grid),
      hasNodata_(hasNodata),
      postTolerance_(std::min(grid.postMetres() / 2048, 0.05)) {}

double SourceSurface::longestEdgeMetres(const Triangle& triangle) const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner& a = triangle[k];
        const Corner& b = triangle[(k + 1) % 3];
        const fabric::Vec2 along = grid_.perColumn * static_cast<double>(b.i - a.i) +
                                   grid_.perRow * static_cast<double>(b.j - a.j);
        longest = std::max(longest, glm::length(along));
    }
    return longest;
}

SourceSurface::Contents SourceSurface::contents(const Triangle& triangle) const {
    std::int64_t posts = 0;
    std::int64_t nodata = 0;
    forEachRow(triangle, [&](std::int32_t j, std::int32_t low, std::int32_t high) {
        posts += high - low + 1;
        nodata += countNodata(grid_.row(j) + low, high - low + 1);
    });
    if (nodata == 0)
        return Contents::Data;
    return nodata == posts ? Contents::Nodata : Contents::Mixed;
}

double SourceSurface::rowsDeviation(const Triangle& triangle) const {
    const Plane plane(triangle);
    const Slabs slabs = slabsOf(triangle);
    double worst = 0;
    for (int k = 0; k < slabs.count; ++k)
        worst = std::max(worst, slabDeviation(grid_.heights.data(), grid_.columns,
                                              slabs.slabs[static_cast<std::size_t>(k)], plane));
    return worst;
}

/// At the centres of the cells that the triangle's diagonal edges cut in half: the other diagonal.
double SourceSurface::diagonalEdgesDeviation(const Triangle& triangle) const {
    double worst = 0;
    for (std::size_t e = 0; e < 3; ++e) {
        const Corner& a = triangle[e];
        const Corner& b = triangle[(e + 1) % 3];
        if (!isDiagonal(a, b))
            continue;
        const std::int32_t length = std::abs(b.i - a.i);
        const std::int32_t di = b.i > a.i ? 1 : -1;
        const std::int32_t dj = b.j > a.j ? 1 : -1;
        const double slope = (b.z - a.z) / length;
        for (std::int32_t k = 0; k < length; ++k) {
            const std::int32_t i = a.i + di * k;
            const std::int32_t j = a.j + dj * k;
            const double other =
                (static_cast<double>(grid_.at(i + di, j)) + grid_.at(i, j + dj)) / 2;
            const double d = std::abs(a.z + slope * (k + 0.5) - other);
            worst = d > worst ? d : worst;  // NaN never wins
        }
    }
    return worst;
}

bool SourceSurface::liesOnItsPosts(const Triangle& triangle) const {
    Triangle unmoved = triangle;
    for (Corner& corner : unmoved) corner.z = grid_.at(corner.i, corner.j);
    return rowsDeviation(unmoved) <= postTolerance_;
}

double SourceSurface::ofAligned(const Triangle& triangle) const {
    if (hasNodata_) {
        const Contents held = contents(triangle);
        if (held != Contents::Data)
            return held == Contents::Mixed ? longestEdgeMetres(triangle) : 0;
    }
    const double atPosts = rowsDeviation(triangle);
    const double atCentres = diagonalEdgesDeviation(triangle);
    return atCentres > atPosts && !liesOnItsPosts(triangle) ? atCentres : atPosts;
}

double SourceSurface::ofGeneral(const Triangle& triangle) const {
    if (hasNodata_) {
        const Contents held = contents(triangle);
        if (held != Contents::Data)
            return held == Contents::Mixed ? longestEdgeMetres(triangle) : 0;
    }
    const Plane plane(triangle);
    double worst = 0;
    forEachRow(triangle, [&](std::int32_t j, std::int32_t low, std::int32_t high) {
        const Slab row{j, 1, low, 0, high, 0};
        worst = std::max(worst, slabDeviation(grid_.heights.data(), grid_.columns, row, plane));
    });
    for (std::size_t e = 0; e < 3; ++e) {
        EdgeCrossings crossings(grid_, triangle[e], triangle[(e + 1) % 3]);
        crossings.atColumns();
        crossings.atRows();
        crossings.atMainDiagonals();
        crossings.atOtherDiagonals();
        if (crossings.meetsNodata())
            return longestEdgeMetres(triangle);
        worst = std::max(worst, crossings.worst());
    }
    return worst;
}

}  // namespace eyrie::terrain
