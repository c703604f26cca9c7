// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/packed_mesh.h"

/// The normals of meshes' vertices on patches: how far what is lit there turns from what the source
/// has. docs/errors.md#normals.
namespace eyrie::mesh {

/// Angles between the normals of points of a surface, as blended from those at its triangles'
/// corners, and of their partners on the source, degrees.
struct NormalError {
    double most = 0;  ///< none is greater; 180 where nothing is known
    double mean = 0;  ///< their mean over the surface is not greater

    /// The greater of both.
    void hold(const NormalError& other) {
        most = std::max(most, other.most);
        mean = std::max(mean, other.mean);
    }
};

/// As packed.
FieldValue normalOf(const PackedMesh& mesh, std::uint32_t vertex);

/// One a triangle. Of a patch without any they are those of the source's triangles, of which it
/// then consists.
std::vector<FieldChanges> normalChangesOf(const PackedMesh& mesh, const Patch& patch);

/// Of points of the patch. 0 where it has no changes of normals.
NormalError normalError(const PackedMesh& mesh, const Patch& patch);

/// Of a sample of its points (point_sample.h), which are lit as their triangles are, but packed
/// anew, and with the triangle's own normal where its material has one side.
NormalError sampledNormalError(const PackedMesh& mesh, const Patch& patch);

}  // namespace eyrie::mesh
