// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_sharing.h"
#include "renderer/import/mesh_split.h"
#include "renderer/import/mesh_spool.h"
#include "renderer/mesh/codec/exact_codec.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::import {

/// What all parts have in common.
struct PartWork {
    const MeshSpool& spool;
    const MeshSplit& split;
    const MeshSharing& sharing;
    const std::optional<std::vector<bool>>& isBehind;  ///< findBacks
    const MeshImportOptions& options;
    std::uint64_t sourceHash = 0;
    std::optional<mesh::ExactForm> exactForm;
    mesh::OutputFile& out;  ///< unnamed
};

/// A part on the lattice, without its guests.
struct PartMesh {
    mesh::PackedMesh mesh;
    std::vector<std::uint64_t> firstUse;                 ///< as PartSurface (mesh_part.h) has it
    std::vector<std::array<std::uint32_t, 2>> sharedBy;  ///< the same
    std::uint64_t newVertices = 0;                       ///< that are in no part before it
    bool computedNormals = false;
    std::vector<bool> isBehind;  ///< of its triangles, where that is known
};

/// Packs a part as the whole mesh would be, and leaves its guests out. Errors: those of packMesh.
absl::StatusOr<PartMesh> packPart(const PartWork& work, std::uint32_t part,
                                  const ImportControl& control);

/// The vertices of a mesh that `triangles` use, ascending, and `triangles` numbered by them.
std::vector<std::uint32_t> compact(std::size_t vertexCount, std::vector<mesh::Triangle>& triangles);

/// Those vertices of a mesh, without triangles.
mesh::PackedMesh withVertices(const mesh::PackedMesh& mesh,
                              const std::vector<std::uint32_t>& vertices);

/// Those entries of an array that has one a vertex, or none.
template <typename T>
std::vector<T> chosenOf(const std::vector<T>& from, const std::vector<std::uint32_t>& vertices) {
    std::vector<T> to;
    if (!from.empty())
        for (const std::uint32_t vertex : vertices) to.push_back(from[vertex]);
    return to;
}

}  // namespace eyrie::import
