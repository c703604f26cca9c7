// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

struct PackOptions {
    int latticeBits = mesh::kLatticeBits;  ///< of a coordinate: mesh::fitLattice
    bool keepsExact = false;               ///< the source's positions, too: PackedMesh::exact
};

/// What packing left out and put together.
struct PackCounts {
    std::uint64_t isolatedVertices = 0;     ///< used by no triangle
    std::uint64_t weldedVertices = 0;       ///< became one with an equal vertex before them
    std::uint64_t degenerateTriangles = 0;  ///< without area on the lattice: they cover no pixel
    bool normalsComputed = false;           ///< for all vertices, or for those with unusable ones

    bool operator==(const PackCounts&) const = default;
};

/// Puts a mesh on the lattice that fits it: rounds positions, drops triangles without area, welds
/// vertices that have become equal (position, and the source's normal and colour; if it keeps
/// exact positions, those, too), and gives smooth
/// normals to vertices whose source normal is missing, zero or not finite.
///
/// Depends on the mesh alone. Every remaining vertex lies within lattice.errorMetres() of its
/// source. Errors: Cancelled, InvalidArgument (coordinates too large, or nothing has any area).
absl::StatusOr<mesh::PackedMesh> packMesh(TriangleMesh source, PackCounts& counts,
                                          const ImportControl& control = {},
                                          const PackOptions& options = {});

}  // namespace eyrie::import
