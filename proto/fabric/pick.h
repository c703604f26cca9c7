// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include <absl/status/status.h>

#include "fabric/camera.h"
#include "fabric/hidden_objects.h"
#include "fabric/sight.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// What somebody points at: a place of a picture.
struct PickRequest {
    Camera camera;
    std::int32_t viewWidth = 0;  ///< pixels, 1 to kMaxViewPixels
    std::int32_t viewHeight = 0;
    /// Pixels from the picture's lower left corner, x to the right, y up, 0 to its width and
    /// height; the middle of its first pixel is (0.5, 0.5).
    Vec2 place{0, 0};
    double exaggeration = 1;    ///< that terrains are drawn with, see Look
    HiddenObjects hidden = {};  ///< that are looked through
    /// What the picture is seen by; nothing: straight ahead, by the camera's field of view.
    std::optional<Sight> sight = {};

    bool operator==(const PickRequest&) const = default;
};

/// InvalidArgument, naming the field: what validate says of cameras and sights, a size or
/// exaggeration out of range, a place outside the picture.
absl::Status validate(const PickRequest& request);

/// Where the line of sight through a place first meets a scene's data at their finest, and how far
/// that may be from where it meets their source. docs/errors.md#picking.
struct PickedPoint {
    std::int32_t object = 0;  ///< index in Scene::objects
    Vec3 worldMetres{0, 0, 0};
    Vec3 normal{0, 0, 1};       ///< of the triangle, world, unit, towards the eye
    double distanceMetres = 0;  ///< from the eye
    /// The source's surface has a point so near to it: of terrain straight above or below it in
    /// object space, however its cells between posts are read.
    double errorMetres = 0;
    /// Distances from the eye between which the same line of sight first meets the source. On a
    /// surface seen edge-on they may lie far more than errorMetres apart. The second is infinite
    /// where the source may be missed.
    double nearestMetres = 0;
    double farthestMetres = 0;
    double pixelMetres = 0;  ///< height of a pixel at its distance
    /// Of terrain: its height there in its own object space, metres, as not exaggerated.
    std::optional<double> elevationMetres;
    double elevationErrorMetres = 0;  ///< how far off that is; 0 without one

    bool operator==(const PickedPoint&) const = default;
};

/// Nothing where the line of sight meets nothing.
using Picked = std::optional<PickedPoint>;

}  // namespace eyrie::fabric
