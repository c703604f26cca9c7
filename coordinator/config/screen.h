// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coordinator/config/configuration.h"
#include "fabric/frustum.h"

/// Walls and what is seen of them. Metres, right-handed, y up, -z ahead. After Cruz-Neira, Sandin,
/// DeFanti: "Surround-Screen Projection-Based Virtual Reality" (1993), off-axis projection.
namespace eyrie::config {

/// The wall that a projector in `projection` throws its picture on: `distance` before the origin,
/// as wide as the field of view opens there, turned by roll, then pitch, then heading.
///
/// Equalizer takes such a plane to be behind the projector in one place and before it in another,
/// which shows with model units other than 1; here it is always before it.
Wall wallOf(const Projection& projection);

/// Nothing for a surface that is not there.
std::optional<Wall> wallOf(const Surface& surface);

/// A part of a wall, in fractions from its lower left corner.
Wall part(const Wall& wall, const Viewport& fraction);

/// What an eye sees through a wall as through a window.
struct Sight {
    fabric::Frustum frustum;          ///< at unit distance, in the wall's axes
    fabric::Mat4 viewFromWorld{1.0};  ///< x along the wall's lower side, y along its left one
};

/// Nothing where the eye is not before the wall.
std::optional<Sight> sightThrough(const Wall& wall, const fabric::Vec3& eye);

}  // namespace eyrie::config
