// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/statusor.h>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Triangles that synthesizeMesh makes at most.
inline constexpr std::uint64_t kMaxSyntheticTriangles = 1'000'000'000;

/// How high bumps of a synthetic mesh are beside those of twice their width.
/// As on scans: what simplifying them costs grows as it does on the Stanford models.
inline constexpr double kScanRoughness = 0.33;
/// As steep at every size, down to single triangles: nothing simplifies easily.
inline constexpr double kEvenRoughness = 0.48;

/// A closed bumpy ball of about one metre's radius around the origin, with detail down to a few
/// triangles' size: 8 n^2 triangles for the n that comes nearest to `triangles` (at least 8, at
/// most kMaxSyntheticTriangles). `roughness` is between 0 and 0.5. Coordinates are floats' values.
///
/// The same on every machine for the same arguments, and for any number of threads; the same `seed`
/// has the same large shape at every size.
/// K. Perlin, "An Image Synthesizer", 1985 (gradient noise); "Improving Noise", 2002 (its fade).
TriangleMesh synthesizeMesh(std::uint64_t triangles, std::uint64_t seed,
                            double roughness = kEvenRoughness);

/// Cuts each triangle into four at the middles of its edges, `times` times over; what was closed
/// stays so. Normals and colours go. Coordinates are floats' values. Errors: InvalidArgument when
/// that would make more than kMaxSyntheticTriangles, or the mesh has more already.
absl::StatusOr<TriangleMesh> subdivide(TriangleMesh mesh, int times);

/// Moves points by smooth noise, as a scanner's: each coordinate by at most about `metres`, in
/// bumps from 1/64 of the mesh's diagonal down to 1/1024. Points at one place stay together.
/// Normals go. Coordinates are floats' values.
void displace(TriangleMesh& mesh, double metres, std::uint64_t seed);

}  // namespace eyrie::import
