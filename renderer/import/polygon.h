// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fabric/vec.h"

namespace eyrie::import {

/// Corners a concave polygon may have: clipping ears takes up to the square of them.
inline constexpr std::size_t kMaxConcaveCorners = 16384;

/// Appends the `corners.size() - 2` triangles of a polygon, which has at least three corners and
/// may be slightly out of plane. Convex: a fan from its first corner. Concave: ears are clipped in
/// the plane its area is largest in. A polygon that crosses itself still gives that many triangles.
/// False, appending nothing, when a concave polygon has more than kMaxConcaveCorners.
/// G. H. Meisters, "Polygons Have Ears", 1975; normal: M. E. Newell, in Sutherland et al. 1974.
bool triangulatePolygon(std::span<const fabric::Vec3> positions,
                        std::span<const std::uint32_t> corners,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace eyrie::import
