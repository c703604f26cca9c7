// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

#include "fabric/vec.h"

namespace eyrie::fabric {

/// Of a camera's position: further away a double has no tenth of a metre left.
inline constexpr double kMaxCoordinateMetres = 1e15;

inline constexpr double kMinFovYDegrees = 1;
inline constexpr double kMaxFovYDegrees = 170;

/// A pinhole camera in world space (metres, right-handed, z up unless `up` says otherwise).
struct Camera {
    Vec3 eye{0, 0, 0};
    Vec3 target{0, 1, 0};
    Vec3 up{0, 0, 1};
    double fovYDegrees = 45;  ///< whole vertical field of view, kMinFovYDegrees and up

    bool operator==(const Camera&) const = default;
};

/// InvalidArgument, naming the field, when the camera spans no picture: not finite or beyond
/// kMaxCoordinateMetres, target too near to eye or up too short to give a direction, up
/// parallel to the view direction, or a field of view outside 1 to 170 degrees.
absl::Status validate(const Camera& camera);

/// Rotation from world to view axes (view: right-handed, x right, y up, looks down -z).
/// Precondition: validate(camera) is ok.
Mat3 viewFromWorldRotation(const Camera& camera);

}  // namespace eyrie::fabric
