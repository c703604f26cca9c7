// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// Says of each triangle whether one before it has the same three points in the same turn. What is
/// drawn first wins where depths are equal, so the picture is the same without it. The two sides
/// of a sheet, the same points in opposite turns, are both kept.
/// Preconditions: every corner is below `points`; no triangle has a point twice.
std::vector<bool> findDuplicates(std::span<const mesh::Triangle> triangles, std::size_t points);

}  // namespace eyrie::import
