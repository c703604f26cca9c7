// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// Whether a triangle hides one after it that has the same points in the same turn.
using Hides = std::function<bool(std::uint32_t before, std::uint32_t after)>;

/// Says of each triangle whether one before it has the same three points in the same turn, and
/// hides it: what is drawn first wins where depths are equal, so the picture is the same without
/// it. The two sides of a sheet, the same points in opposite turns, are both kept. Of many that lie
/// in one place and do not hide each other only the first few are compared with those after them.
/// Preconditions: every corner is below `points`; no triangle has a point twice; what hides what
/// hides a triangle hides that, too.
std::vector<bool> findDuplicates(std::span<const mesh::Triangle> triangles, std::size_t points,
                                 const Hides& hides);

}  // namespace eyrie::import
