// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <absl/status/status.h>

#include "fabric/camera.h"
#include "fabric/hidden_objects.h"
#include "fabric/object_look.h"
#include "fabric/transfer_function.h"

namespace eyrie::fabric {

/// Lines of equal elevation; every fifth is stronger.
struct ContourLines {
    double intervalMetres = 100;  ///< 0.001 to 100,000
    double widthPixels = 1;       ///< 0.25 to 16

    bool operator==(const ContourLines&) const = default;
};

/// Where light comes from, as seen from the scene.
struct Sun {
    double azimuthDegrees = 0;    ///< clockwise from north, world y; -360 to 360
    double elevationDegrees = 0;  ///< above the horizon; -90 to 90

    bool operator==(const Sun&) const = default;
};

/// How objects, terrain above all, are shown beside their shading. A default one changes nothing
/// and costs nothing.
struct Look {
    /// Heights are drawn times this, about height 0 of the object; -1000 to 1000.
    double exaggeration = 1;
    std::optional<TransferFunction> transfer = {};  ///< none: hypsometricTints()
    double slopeShading = 1;                        ///< how far steep ground shows rock, 0 to 1
    std::optional<ContourLines> contours = {};
    double saturation = 1;    ///< 0 (grey) to 2
    bool tileBounds = false;  ///< boxes around the tiles and nodes that are drawn
    bool pageBounds = false;  ///< boxes around the pages whose tiles the view needs
    bool levelTint = false;   ///< each level of the quadtree, or of a mesh's tree, has a colour
    /// Each range of the data that a channel draws has a colour, unless levels have: the one part
    /// of a look that pictures of different decompositions differ by.
    bool rangeTint = false;
    /// What is drawn is chosen for this camera, and seen from the frame's: no error is promised.
    std::optional<Camera> cutCamera = {};
    std::optional<Sun> sun = {};  ///< see lightsOf()
    /// What is promised, counted and timed is that of the others.
    HiddenObjects hidden = {};
    ObjectLooks objects = {};

    bool operator==(const Look&) const = default;
};

inline constexpr double kMaxExaggeration = 1000;

/// InvalidArgument, naming the field, for what lies outside the ranges above.
absl::Status validate(const Look& look);

/// A terrain's transform with its heights drawn times `exaggeration`. 1 changes no bit. Nothing is
/// drawn flatter than a billionth of its height: 0 stays a map that can be inverted, and Everest
/// under 10 micrometres high.
Mat4 exaggerated(const Mat4& worldFromObject, double exaggeration);

}  // namespace eyrie::fabric
