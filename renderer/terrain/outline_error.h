// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "renderer/terrain/deviation.h"

namespace eyrie::terrain {

/// A line that is drawn between two corners; or a corner, twice.
struct DrawnSide {
    Corner from;
    Corner to;
};

/// How far triangles that mix data and nodata bring an outline off: what is drawn, or there, over
/// the one side is no farther, in metres of space, from what is there, or drawn, on the other.
///
/// Ground is looked at in quarters of cells, which two neighbouring posts and the cell's middle
/// bound. However the source is read (a cell split along either diagonal, or bilinear), what lies
/// over a quarter is in the convex hull of its two posts and of those of the diagonals' middles
/// that have data at both ends. Distances to something convex, such as a side, are convex
/// functions, so over a hull they are greatest at its points.
///
/// Holds a reference to the surface: one object per thread.
class OutlineError {
public:
    explicit OutlineError(SourceSurface& surface) : surface_(surface) {}

    /// Of a triangle that is drawn, all of its corners having data: of data in it to its sides, and
    /// of what is drawn to the ground right there or to posts with data. No less than `atLeast`.
    double ofDrawn(const Triangle& triangle, double atLeast);
    /// Of one that is not: from data in it to the nearest of `drawn`, one at least; no less than
    /// `atLeast`.
    double ofDropped(const Triangle& triangle, std::span<const DrawnSide> drawn, double atLeast);
    /// Of one that is not, where nothing is known of that is drawn: about, to a corner of the next
    /// triangle. No bound on that, but on how far data in it are from nodata.
    double around(const Triangle& triangle);

private:
    using Point = glm::dvec3;
    struct Cell;
    /// In metres, from the first post; straight up is z.
    struct Line {
        Point from;
        Point along;
        double perLength;  ///< 1 / |along|²; 0: a point
    };

    Point place(double i, double j, double z) const;
    Cell cellAt(std::int32_t i, std::int32_t j);
    double farthestDrawn(const Triangle& triangle, double atLeast, double atMost);
    double nearestPost(const Triangle& triangle, std::int32_t i, std::int32_t j,
                       std::span<const Point> points, double enough, double atMost);
    void setLines(std::span<const DrawnSide> sides);

    SourceSurface& surface_;
    std::vector<Line> lines_;
};

}  // namespace eyrie::terrain
