// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/vec.h"

namespace eyrie::fabric {

/// A view frustum, given by its extent on the plane at unit distance before the eye (view axes:
/// x right, y up, looking down -z). May be off-axis. There is no far plane: depth is reversed and
/// infinite (1 at `nearMetres`, 0 at infinity).
struct Frustum {
    double left = -1;
    double right = 1;
    double bottom = -1;
    double top = 1;

    bool operator==(const Frustum&) const = default;
};

/// Distance of the near plane of every picture. Reversed floating-point depth has the same relative
/// precision at any distance, so a near plane this close costs nothing.
inline constexpr double kNearMetres = 1e-3;

/// The symmetric frustum of a whole vertical field of view and a width / height ratio.
Frustum symmetricFrustum(double fovYDegrees, double aspect);

/// Clip from view: reversed depth, infinite far plane, for glClipControl(…, GL_ZERO_TO_ONE).
/// Depth written is nearMetres / z for view-space depth z.
Mat4 clipFromView(const Frustum& frustum, double nearMetres);

/// View-space depth in metres of a reversed depth value; infinity for 0 (nothing was hit).
inline double viewDepthMetres(double reversedDepth, double nearMetres) {
    return nearMetres / reversedDepth;
}

}  // namespace eyrie::fabric
