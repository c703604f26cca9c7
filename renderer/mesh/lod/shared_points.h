// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Of each vertex, how deep nodes lie, the root at 0, that do not have all triangles with a corner
/// at its position: in those it belongs to others, too, whether or not it looks like a border of
/// theirs. 0 for vertices at the position of one of `goesOnAt`, where the mesh goes on beyond the
/// tree.
std::vector<std::uint8_t> sharedFrom(const PackedMesh& mesh, const KdTree& tree,
                                     std::span<const std::uint32_t> goesOnAt = {});

}  // namespace eyrie::mesh
