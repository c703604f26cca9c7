// SPDX-License-Identifier: Apache-2.0
// W. Evans, D. Kirkpatrick, G. Townsend, "Right-Triangulated Irregular Networks", 2001; R.
// Pajarola, "Large Scale Terrain Visualization Using the Restricted Quadtree Triangulation", 1998.
// Departs from both in the error: theirs is the midpoint's alone, which understates what a triangle
// leaves out by up to 1.8 times on real terrain; here each triangle is measured in full.
#include "renderer/terrain/vertex_levels.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "renderer/terrain/finest_row.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::terrain {

VertexLevels::VertexLevels(const SourceSurface& surface, std::vector<double> thresholdsMetres)
    : surface_(surface),
      thresholds_(std::move(thresholdsMetres)),
      floatThresholds_(thresholds_.begin(), thresholds_.end()),
      columns_(surface.grid().columns),
      rows_(surface.grid().rows),
      levels_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    const Quadtree quadtree(static_cast<std::uint32_t>(columns_),
                            static_cast<std::uint32_t>(rows_));
    assert(static_cast<int>(thresholds_.size()) == quadtree.levels());
    side_ = Quadtree::side(quadtree.top().level);
}

absl::StatusOr<VertexLevels> VertexLevels::compute(const SourceSurface& surface,
                                                   std::vector<double> thresholdsMetres,
                                                   const import::ImportControl& control) {
    VertexLevels levels(surface, std::move(thresholdsMetres));
    control.report("measuring", 0);
    double done = 0;
    for (std::int32_t s = 1; s < levels.side_; s *= 2) {
        for (const bool isCentre : {false, true}) {
            if (absl::Status status = control.check(); !status.ok())
                return status;
            levels.measureClass(s, isCentre);
            // Three quarters of the vertices belong to the first two classes, and so on.
            done += (1 - done) * (isCentre ? 0.4 : 0.5);
            control.report("measuring", done);
        }
    }
    control.report("measuring", 1);
    return levels;
}

Corner VertexLevels::corner(const Point& p) const {
    const std::int32_t i = std::min(p.i, columns_ - 1);
    const std::int32_t j = std::min(p.j, rows_ - 1);
    return {i, j, surface_.grid().at(i, j)};
}

int VertexLevels::thresholdsExceededBy(double deviationMetres) const {
    int count = 0;
    for (const double threshold : thresholds_) {
        if (!(deviationMetres > threshold))
            break;
        ++count;
    }
    return count;
}

/// Of a triangle of the padded square.
double VertexLevels::deviation(const std::array<Point, 3>& t) const {
    const auto isInside = [&](const Point& p) { return p.i < columns_ && p.j < rows_; };
    const Triangle triangle = {corner(t[0]), corner(t[1]), corner(t[2])};
    if (std::all_of(t.begin(), t.end(), isInside))
        return surface_.ofAligned(triangle);
    const auto pastColumns = [&](const Corner& c) { return c.i == columns_ - 1; };
    const auto pastRows = [&](const Corner& c) { return c.j == rows_ - 1; };
    if (std::all_of(triangle.begin(), triangle.end(), pastColumns) ||
        std::all_of(triangle.begin(), triangle.end(), pastRows))
        return 0;  // squeezed to nothing
    return surface_.ofGeneral(triangle);
}

/// Thresholds exceeded by the triangle p, apex, q; none where the apex lies outside of the square.
int VertexLevels::exceededByTriangle(const Point& p, const Point& apex, const Point& q) const {
    if (apex.i < 0 || apex.j < 0 || apex.i > side_ || apex.j > side_)
        return 0;
    return thresholdsExceededBy(deviation({p, apex, q}));
}

/// Thresholds exceeded by the two triangles that vertex (i, j) of spacing s splits.
int VertexLevels::exceededBySplit(std::int32_t i, std::int32_t j, std::int32_t s,
                                  bool isCentre) const {
    if (isCentre) {
        // Of a square of side 2s the diagonal that meets the centre of the square around it.
        const bool isMain = (((i - s) ^ (j - s)) & (2 * s)) == 0;
        const std::int32_t d = isMain ? s : -s;
        const Point p{i - d, j - s};
        const Point q{i + d, j + s};
        return std::max(exceededByTriangle(p, {i + d, j - s}, q),
                        exceededByTriangle(q, {i - d, j + s}, p));
    }
    const bool isHorizontal = (i & s) != 0;
    const std::int32_t dx = isHorizontal ? s : 0;
    const std::int32_t dy = isHorizontal ? 0 : s;
    const Point p{i - dx, j - dy};
    const Point q{i + dx, j + dy};
    return std::max(exceededByTriangle(p, {i + dy, j - dx}, q),
                    exceededByTriangle(q, {i - dy, j + dx}, p));
}

/// Thresholds exceeded by the vertices that split the halves of (i, j)'s triangles.
int VertexLevels::exceededByChildren(std::int32_t i, std::int32_t j, std::int32_t s,
                                     bool isCentre) const {
    const auto at = [&](std::int32_t x, std::int32_t y) {
        return x < 0 || y < 0 || x > side_ || y > side_ ? 0 : exceeded(x, y);
    };
    if (isCentre)
        return std::max({at(i - s, j), at(i + s, j), at(i, j - s), at(i, j + s)});
    if (s == 1)
        return 0;
    const std::int32_t h = s / 2;
    return std::max({at(i - h, j - h), at(i + h, j - h), at(i - h, j + h), at(i + h, j + h)});
}

int VertexLevels::exceededBy(std::int32_t i, std::int32_t j, std::int32_t s, bool isCentre) const {
    const int exceeded = exceededByChildren(i, j, s, isCentre);
    if (exceeded == static_cast<int>(thresholds_.size()))
        return exceeded;
    return std::max(exceeded, exceededBySplit(i, j, s, isCentre));
}

/// Row j of the first class but for its ends. Precondition: 0 < j < rows - 1.
void VertexLevels::measureFinestRow(std::int32_t j) {
    const HeightGrid& grid = surface_.grid();
    thread_local std::vector<std::uint8_t> counts;
    counts.resize(static_cast<std::size_t>(columns_));
    const bool isEven = (j & 1) == 0;
    finestRow(grid.row(j - 1), grid.row(j), grid.row(j + 1), columns_, isEven,
              static_cast<float>(surface_.postToleranceMetres()), floatThresholds_, counts.data());
    for (std::int32_t i = isEven ? 1 : 2; i < columns_ - 1; i += 2) {
        const std::uint8_t count = counts[static_cast<std::size_t>(i)];
        levels_[index(i, j)] = count == kFinestRowNodata
                                   ? static_cast<std::uint8_t>(exceededBy(i, j, 1, false))
                                   : count;
    }
}

void VertexLevels::measureRow(std::int32_t j, std::int32_t s, bool isCentre,
                              std::vector<Found>& outside) {
    const bool isFinest = s == 1 && !isCentre && j > 0 && j < rows_ - 1;
    if (isFinest)
        measureFinestRow(j);
    const std::int32_t first = isCentre || (j & s) == 0 ? s : 0;
    const std::int32_t end = std::min(columns_ - 1 + s, side_ + 1);
    for (std::int32_t i = first; i < end; i += 2 * s) {
        if (isFinest && i > 0 && i < columns_ - 1)
            continue;
        const auto exceeded = static_cast<std::uint8_t>(exceededBy(i, j, s, isCentre));
        if (i < columns_ && j < rows_)
            levels_[index(i, j)] = exceeded;
        else if (exceeded > 0)
            outside.push_back({key(i, j), exceeded});
    }
}

/// All vertices of one spacing: midpoints of the sides of squares of side 2s, or their centres.
void VertexLevels::measureClass(std::int32_t s, bool isCentre) {
    const std::int32_t first = isCentre ? s : 0;
    const std::int32_t step = isCentre ? 2 * s : s;
    const std::int32_t end = std::min(rows_ - 1 + s, side_ + 1);
    const std::int32_t count = (end - first + step - 1) / step;
    tbb::enumerable_thread_specific<std::vector<Found>> outside;
    tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count),
                      [&](const tbb::blocked_range<std::int32_t>& range) {
                          std::vector<Found>& mine = outside.local();
                          for (std::int32_t k = range.begin(); k < range.end(); ++k)
                              measureRow(first + k * step, s, isCentre, mine);
                      });
    for (const std::vector<Found>& found : outside)
        for (const Found& vertex : found) outside_[vertex.key] = vertex.exceeded;
}

}  // namespace eyrie::terrain
