// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coordinator/config/configuration.h"
#include "fabric/sight.h"

/// Walls and what is seen of them. Metres, right-handed, y up, -z ahead. After Cruz-Neira, Sandin,
/// DeFanti: "Surround-Screen Projection-Based Virtual Reality" (1993), off-axis projection.
namespace eyrie::config {

/// The wall that a projector in `projection` throws its picture on: `distance` before the origin,
/// as wide as the field of view opens there, turned by roll, then pitch, then heading.
///
/// Equalizer takes such a plane to be behind the projector in one place and before it in another,
/// which shows with model units other than 1; here it is always before it.
Wall wallOf(const Projection& projection);

/// The cosine of the angle in the lower left corner: 0 of rectangles.
double skewOf(const Wall& wall);

/// As much of it comes of corners that are written with few digits.
inline constexpr double kRoundedSkew = 1e-3;

/// A rectangle: of a wall that is further from one, that on its lower side and as high. Nothing for
/// a surface that is not there.
std::optional<Wall> wallOf(const Surface& surface);

/// A part of a wall, in fractions from its lower left corner.
Wall part(const Wall& wall, const Viewport& fraction);

/// `by` times as wide, about its centre.
Wall widened(const Wall& wall, double by);

/// Each corner `by` times as far from `from`.
Wall scaled(const Wall& wall, const fabric::Vec3& from, double by);

/// Where a head that is at `roomFromHead` takes it.
Wall moved(const Wall& wall, const fabric::Mat4& roomFromHead);

/// How far `from` is before the wall along `direction`, of length 1; not above 0 where it does not
/// look at it.
double distanceAlong(const Wall& wall, const fabric::Vec3& from, const fabric::Vec3& direction);

/// What an eye sees through a wall as through a window. Both in the camera's axes.
/// Nothing where the eye is not before the wall.
std::optional<fabric::Sight> sightThrough(const Wall& wall, const fabric::Vec3& eye);

}  // namespace eyrie::config
