// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Triangles that synthesizeMesh makes at most.
inline constexpr std::uint64_t kMaxSyntheticTriangles = 1'000'000'000;

/// A closed bumpy ball of about one metre's radius around the origin, with detail down to a few
/// triangles' size: 8 n^2 triangles for the n that comes nearest to `triangles` (at least 8, at
/// most kMaxSyntheticTriangles). Coordinates are floats' values.
///
/// The same on every machine for the same arguments, and for any number of threads; the same `seed`
/// has the same large shape at every size.
/// K. Perlin, "An Image Synthesizer", 1985 (gradient noise); "Improving Noise", 2002 (its fade).
TriangleMesh synthesizeMesh(std::uint64_t triangles, std::uint64_t seed);

}  // namespace eyrie::import
