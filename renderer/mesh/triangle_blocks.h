// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/mesh/lattice_box.h"
#include "renderer/mesh/node_block.h"

namespace eyrie::mesh {

/// Triangles that follow each other in a node's index list, and between what they lie. The list
/// follows a curve that fills space (gatherNode), so that is a small part of the node.
struct TriangleBlock {
    std::uint32_t first = 0;  ///< in the index list
    std::uint32_t count = 0;
    LatticeBox bounds;
};

/// All of a node's triangles, in their order; nothing of a node of points.
std::vector<TriangleBlock> triangleBlocks(const NodeGeometry& geometry);

}  // namespace eyrie::mesh
