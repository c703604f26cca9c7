// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "fabric/lights.h"
#include "fabric/vec.h"
#include "renderer/mesh/lattice.h"
#include "renderer/mesh/material.h"

namespace eyrie::mesh {

/// Corners of a triangle, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A whole mesh in packed form (vertex_packing.h). `colours`, `textureCoordinates` and
/// `materialOf` may be empty; otherwise every array of vertices has one entry a vertex.
struct PackedMesh {
    Lattice lattice;
    std::vector<std::uint64_t> positions;
    std::vector<std::uint32_t> normals;
    std::vector<std::uint32_t> colours;
    std::vector<glm::ivec2> textureCoordinates;  ///< in kTextureSteps
    std::vector<std::uint16_t> materialOf;       ///< the same at the corners of a triangle
    std::vector<Triangle> triangles;
    std::vector<Material> materials;
    std::vector<Image> images;
    fabric::FileLights lights;  ///< object space; at most fabric::kMaxLights
    /// Where the source had each vertex, metres; empty unless that is to be kept. Vertices that
    /// differ in it only are not the same.
    std::vector<fabric::Vec3> exact;
    /// Bound on how far those had moved already (import::TriangleMesh::roundingMetres).
    double roundingMetres = 0;

    /// Bound on how far a vertex is from where its file states it.
    double errorMetres() const { return lattice.errorMetres() + roundingMetres; }

    bool operator==(const PackedMesh&) const = default;
};

}  // namespace eyrie::mesh
