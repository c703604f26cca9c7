// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/truth/pinhole.h"
#include "renderer/truth/triangle.h"

namespace eyrie::truth {

/// Drawn triangles, by where on the screen they are. Refers to both. Any thread may ask.
///
/// At its very edge a triangle that is seen edge-on may cover a pixel whose centre it misses, by up
/// to the 1/256 pixel to which its corners are rounded, and its plane has any depth there. What
/// such a pixel shows is a point beside its centre. Which depths rasterisation may give a triangle
/// is derived in docs/errors.md#rasterisation.
class ShownSurface {
public:
    ShownSurface(std::span<const Triangle> triangles, const Pinhole& camera);

    /// How far beside a picture point a triangle may be that is shown there: 1/256 pixel that its
    /// corners are rounded by, and as much for single precision.
    static constexpr double kReachPixels = 1.0 / 128;

    struct Point {
        fabric::Vec3 point{0};
        std::size_t triangle = 0;  ///< of those given
        bool mayHaveDepth =
            false;  ///< rasterisation may give its triangle the depth asked for here
        /// A side within reach, of its triangle or of one that has a corner in common with that,
        /// ends what is drawn: no other triangle goes on from it to the other side. Of triangles
        /// that reach behind the near plane, and beside those thinner than the reach, any side may.
        bool isAtEnd = false;
    };

    /// The point that picture point (x, y) shows: of what lies within reach, of the triangle that
    /// may have `depth` there, and of several or none such the one whose plane is nearest to it,
    /// the point next to it. Nothing where nothing is within reach.
    std::optional<Point> at(double x, double y, double depth) const;

private:
    std::size_t tileOf(double x, double y) const;
    /// Whether `triangle` has a side within reach of a picture point from which none of `near`,
    /// which are all that are within reach, goes on.
    bool hasEndAt(double x, double y, std::uint32_t triangle,
                  std::span<const std::uint32_t> near) const;
    void add(std::uint32_t triangle);

    std::span<const Triangle> triangles_;
    const Pinhole& camera_;
    int columns_;  ///< of tiles
    int rows_;
    std::vector<std::vector<std::uint32_t>> tiles_;  ///< the triangles that may reach into each
};

}  // namespace eyrie::truth
