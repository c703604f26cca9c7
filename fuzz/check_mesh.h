// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Ends the program where a mesh that was read does not keep TriangleMesh's invariant; packs it.
inline void checkMesh(TriangleMesh mesh) {
    const std::size_t count = mesh.positions.size();
    const auto isOfEach = [count](const auto& values) {
        return values.empty() || values.size() == count;
    };
    if (!isOfEach(mesh.normals) || !isOfEach(mesh.colours) || !isOfEach(mesh.materialOf) ||
        mesh.textureCoordinates.size() != mesh.materialOf.size())
        std::abort();
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle)
            if (corner >= count || (!mesh.materialOf.empty() &&
                                    (mesh.materialOf[corner] >= mesh.materials.size() ||
                                     mesh.materialOf[corner] != mesh.materialOf[triangle[0]])))
                std::abort();
    mesh.images.resize(mesh.textures.size());  // as if they had been loaded
    PackCounts counts;
    static_cast<void>(packMesh(std::move(mesh), counts));
}

}  // namespace eyrie::import
