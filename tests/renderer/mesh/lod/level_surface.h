// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "renderer/mesh/packed_mesh.h"
#include "renderer/mesh/vertex_packing.h"
#include "renderer/truth/mesh_ray_caster.h"

namespace eyrie::test {

/// Some of a mesh's triangles, to look for points on.
inline truth::MeshRayCaster surfaceOf(const mesh::PackedMesh& mesh,
                                      const std::vector<mesh::Triangle>& triangles) {
    truth::TriangleMesh plain;
    for (const std::uint64_t position : mesh.positions)
        plain.positions.push_back(mesh.lattice.metres(mesh::unpackPosition(position)));
    plain.triangles.assign(triangles.begin(), triangles.end());
    return truth::MeshRayCaster(std::move(plain));
}

}  // namespace eyrie::test
