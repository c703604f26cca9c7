// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "renderer/terrain/height_grid.h"

namespace eyrie::terrain {

/// A corner of a triangle: a post, and the height it is drawn at (NaN at nodata posts).
struct Corner {
    std::int32_t i = 0;
    std::int32_t j = 0;
    double z = 0;
};
using Triangle = std::array<Corner, 3>;

/// Greatest vertical distance between drawn triangles and the full-resolution source, in metres.
///
/// The source between posts is whatever the reader of a DEM takes it for: a cell split along
/// either diagonal, or bilinear (which lies between those two). Each of the three is piecewise
/// linear or bounded by such, so the greatest distance lies at a post, or where an edge of the
/// triangle crosses a grid line or a cell's diagonal: those points are all looked at, none
/// sampled. One exception: where all posts of an aligned triangle lie on it, to within
/// postToleranceMetres, the drawing follows such a reading, and only its distance at posts counts.
///
/// Triangles that hold both data and nodata count as their longest edge: that is how far what
/// is drawn may reach into a hole, or a hole into what should be drawn. All nodata counts as 0.
///
/// Computed in double from float heights: rounding stays below 2^-40 of the greatest height, see
/// kDeviationRounding.
class SourceSurface {
public:
    /// Keeps a reference to `grid`.
    SourceSurface(const HeightGrid& grid, bool hasNodata);

    /// Of a right isosceles triangle with legs or hypotenuse along the axes, corners on posts.
    double ofAligned(const Triangle& triangle) const;
    /// Of any triangle with corners on posts. Counts cells' diagonals even on planes.
    double ofGeneral(const Triangle& triangle) const;

    const HeightGrid& grid() const { return grid_; }
    bool hasNodata() const { return hasNodata_; }
    double longestEdgeMetres(const Triangle& triangle) const;
    /// 1/2048 of a post, 5 cm at most: far below what any level's threshold resolves.
    double postToleranceMetres() const { return postTolerance_; }

private:
    enum class Contents { Data, Nodata, Mixed };

    double rowsDeviation(const Triangle& triangle) const;
    double diagonalEdgesDeviation(const Triangle& triangle) const;
    double edgeDeviation(const Corner& a, const Corner& b) const;
    Contents contents(const Triangle& triangle) const;
    bool liesOnItsPosts(const Triangle& triangle) const;

    const HeightGrid& grid_;
    bool hasNodata_;
    double postTolerance_;
};

/// Share of the greatest height that rounding may take off a computed deviation.
inline constexpr double kDeviationRounding = 1.0 / (1LL << 40);

}  // namespace eyrie::terrain
