// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "renderer/lod/frustum_clip.h"
#include "renderer/lod/view.h"

namespace eyrie::lod {

/// Screen-space error of two surfaces whose points lie at most `error` apart along the object's z
/// axis: terrain as drawn and its source.
///
/// Upper bounds, in pixels, on the distance in the picture of any two such points of which one or
/// both are visible. Narrower than ObjectView::screenSpaceErrorPixels, which knows nothing of the
/// direction: what lies below one another projects onto a line towards the picture's nadir, and the
/// shorter the more steeply one looks down. That counts down to kLeastSlant only.
/// Proof: docs/errors.md#projection-of-a-vertical-error.
class VerticalError {
public:
    /// `error` in object units. Keeps a reference to `view`.
    VerticalError(const ObjectView& view, double error);

    /// Over points of which at least one of each pair lies in `bounds`. 0 when none can be seen;
    /// infinite when `bounds` comes within the error of the eye, as when the eye is inside.
    double pixels(const fabric::Box& bounds) const;

    /// The same where one of each pair lies on a triangle; object space, three corners each. Finite
    /// unless the surface itself passes within the error of the eye.
    double pixels(std::span<const fabric::Vec3> triangleCorners) const;

    /// The share of an error that counts at least, however steeply one looks down on it. What
    /// stands on terrain may be drawn too low or too high by the error itself: not by more than
    /// 1 / kLeastSlant times tau, then.
    static constexpr double kLeastSlant = 0.25;

private:
    /// Extremes over points in view that may be visible, or have a partner that is.
    struct Extremes;

    void grow(Extremes& extremes, const Polygon& polygon) const;
    double bound(const Extremes& extremes) const;
    bool holdsTheEye(const fabric::Box& bounds) const;

    const ObjectView& view_;
    fabric::Vec3 up_;              ///< the object's z axis in the view, (x, y, depth)
    std::array<Plane, 4> planes_;  ///< a point outside is not visible, nor is its partner
    double depthReach_;            ///< by how much the depths of partners differ, at most
    double scale_;                 ///< pixels at unit slant and depth
    fabric::Vec2 squeeze_;         ///< 1 along the side of a pixel that is the shorter, else less
    double leastSlant_;
};

}  // namespace eyrie::lod
