// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_sharing.h"
#include "renderer/import/mesh_split.h"
#include "renderer/import/mesh_spool.h"
#include "renderer/import/part_mesh.h"
#include "renderer/mesh/back_faces.h"
#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/packed_mesh.h"

/// A mesh on disk becomes an .eym file part by part: each as a mesh in memory does, and then the
/// nodes above them, of what stands for those below. All of it is as if it were done in memory.
namespace eyrie::import {

/// What stands for a part, or for several, when it is drawn as coarsely as there is.
struct PartSurface {
    mesh::PackedMesh mesh;  ///< the vertices that are left
    /// By which a vertex is known in all parts: three times the number of the first triangle that
    /// uses it, and its corner there. Ascending.
    std::vector<std::uint64_t> firstUse;
    /// The least and the greatest part that has a vertex's position.
    std::vector<std::array<std::uint32_t, 2>> sharedBy;
    mesh::LodPart lod;
    double boundSteps = 0;   ///< of lod.patch
    double reachMetres = 0;  ///< mesh::LodTree::colourReachMetres of its root
    /// Too many triangles are left for any node above to be simplified, or drawn as points: they
    /// are not kept.
    bool isEndless = false;
    mesh::Pockets pockets;
    glm::uvec3 boxMin{0U};
    glm::uvec3 boxMax{0U};
};

/// What was written of a part, or of a node above parts.
struct WrittenPart {
    PartSurface surface;
    std::uint64_t offset = 0;  ///< of its .eym file
    std::uint64_t nodes = 0;
    std::uint64_t vertices = 0;  ///< that are in no part before it
    bool computedNormals = false;
    std::uint64_t pointNodes = 0;
    std::vector<mesh::LodLevel> levels;
    double errorMetres = 0;  ///< of the root
};

/// Appends a part's .eym file. Errors: those of packMesh, buildKdTree, buildLodTree and writeEym.
absl::StatusOr<WrittenPart> writePart(const PartWork& work, std::uint32_t part,
                                      const ImportControl& control);

/// Appends that of a node above two others, of itself alone. Errors: as above.
absl::StatusOr<WrittenPart> writeAbove(const PartWork& work, const SplitNode& node,
                                       PartSurface left, PartSurface right,
                                       const ImportControl& control);

}  // namespace eyrie::import
