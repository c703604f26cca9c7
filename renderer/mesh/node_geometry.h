// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A node's own copy of its triangles, as it is stored and drawn: 16-bit indices into arrays that
/// hold nothing else. `colours` and `exact` are empty where the mesh has none.
struct PackedNode {
    std::vector<std::uint64_t> positions;
    std::vector<std::uint32_t> normals;
    std::vector<std::uint32_t> colours;
    std::vector<std::uint16_t> indices;
    std::vector<fabric::Vec3> exact;
    std::uint32_t frontIndexCount = 0;  ///< those of `fronts`, which come first
};

/// Gathers triangles of the mesh's vertices, those of `fronts` before those of `others`, either
/// along a Morton curve through their centroids, vertices in the order of first use: neighbours in
/// space lie close in memory.
/// Precondition: at most kMaxLeafVertices unique vertices.
/// G. M. Morton, "A Computer Oriented Geodetic Data Base", 1966.
PackedNode gatherNode(const PackedMesh& mesh, std::span<const Triangle> fronts,
                      std::span<const Triangle> others = {});

}  // namespace eyrie::mesh
