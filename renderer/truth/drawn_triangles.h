// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "renderer/truth/pinhole.h"
#include "renderer/truth/triangle.h"

namespace eyrie::truth {

/// What a picture point shows of drawn triangles.
struct ShownPlace {
    fabric::Vec3 point;       ///< of a drawn triangle: the one next to the picture point
    double depthAtPoint = 0;  ///< of the triangle's plane at the picture point itself
};

/// What lies within `reachPixels` of picture point (x, y) on the screen, and has its plane at the
/// point nearest to `depth`. Nothing where there is none.
std::optional<ShownPlace> shownAt(std::span<const Triangle> triangles, const Pinhole& camera,
                                  double x, double y, double depth, double reachPixels);

}  // namespace eyrie::truth
