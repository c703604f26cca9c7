// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// A node's own copy of its triangles, as it is stored and drawn: 16-bit indices into arrays that
/// hold nothing else. What the mesh has not is empty.
struct PackedNode {
    std::vector<std::uint64_t> positions;
    std::vector<std::uint32_t> normals;
    std::vector<std::uint32_t> colours;
    std::vector<glm::ivec2> textureCoordinates;
    std::vector<std::uint16_t> indices;
    std::vector<fabric::Vec3> exact;
};

/// Gathers triangles of the mesh's vertices, one part after the other, each along a Morton curve
/// through its centroids, vertices in the order of first use: neighbours in space lie close in
/// memory.
/// Precondition: at most kMaxLeafVertices unique vertices.
PackedNode gatherNode(const PackedMesh& mesh, std::span<const std::span<const Triangle>> parts);

}  // namespace eyrie::mesh
