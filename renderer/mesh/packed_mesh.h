// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fabric/vec.h"
#include "renderer/mesh/lattice.h"

namespace eyrie::mesh {

/// Corners of a triangle, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A whole mesh in packed form (vertex_packing.h). `colours` may be empty; otherwise every array
/// but `triangles` and `exact` has one entry a vertex.
struct PackedMesh {
    Lattice lattice;
    std::vector<std::uint64_t> positions;
    std::vector<std::uint32_t> normals;
    std::vector<std::uint32_t> colours;
    std::vector<Triangle> triangles;
    /// Where the source had each vertex, metres; empty unless that is to be kept. Vertices that
    /// differ in it only are not the same.
    std::vector<fabric::Vec3> exact;

    bool operator==(const PackedMesh&) const = default;
};

}  // namespace eyrie::mesh
