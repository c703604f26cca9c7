// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>
#include <glm/gtc/matrix_transform.hpp>

#include "fabric/frustum.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// Where a view is looked at from and through, other than by the camera itself: an eye beside the
/// camera, a wall that is not straight ahead. Against the camera's axes (x right, y up, -z ahead,
/// its eye the origin), so that one camera moves all views of a room.
struct Sight {
    Vec3 eye{0, 0, 0};         ///< metres
    Mat3 viewFromCamera{1.0};  ///< rotation; x along the lower side of what is looked through
    Frustum frustum;           ///< at unit distance; may be off-axis, and its pixels not square

    bool operator==(const Sight&) const = default;
};

/// Of points: the eye becomes the origin.
inline Mat4 viewFromCamera(const Sight& sight) {
    return glm::translate(Mat4(sight.viewFromCamera), -sight.eye);
}

/// Tangents of the angle off the axis: 89.994 degrees, and how narrow a frustum may be.
inline constexpr double kMaxFrustumTangent = 1e4;
inline constexpr double kMinFrustumSize = 1e-6;

/// InvalidArgument, naming the field, when the sight spans no picture: not finite, an eye beyond
/// kMaxCoordinateMetres from the camera, a matrix that is no rotation, or a frustum that is empty
/// or beyond the limits above.
absl::Status validate(const Sight& sight);

}  // namespace eyrie::fabric
