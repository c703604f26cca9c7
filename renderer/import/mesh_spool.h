// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "fabric/image.h"
#include "fabric/vec.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/import/progress.h"
#include "renderer/import/row_file.h"
#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lattice.h"

/// A mesh on disk, in its source's order: what readMeshes has in memory.
namespace eyrie::import {

/// A triangle that is left of the mesh, on the lattice.
struct SpooledTriangle {
    std::array<std::uint64_t, 3> positions{};  ///< packed (vertex_packing.h)
    mesh::Triangle vertices{};                 ///< of the source
    std::uint32_t number = 0;                  ///< its place among the source's triangles
};

struct MeshSpool {
    RowFile<fabric::Vec3> positions;
    RowFile<glm::vec3> normals;     ///< zero where the source has none
    RowFile<fabric::Rgba> colours;  ///< againstPlain(): zero where the source has none
    bool hasNormals = false;
    bool hasColours = false;
    RowFile<mesh::Triangle> source;  ///< its triangles
    std::uint64_t vertexCount = 0;
    std::uint64_t sourceTriangles = 0;
    std::uint64_t droppedFaces = 0;
    std::vector<std::string> notes;

    // After placeOnLattice():
    std::uint64_t collapsedTriangles = 0;  ///< with two corners in one place: gone from `source`
    std::vector<bool> isUsed;              ///< by a triangle; of each vertex
    mesh::Lattice lattice;
    RowFile<SpooledTriangle> triangles;  ///< in their order
    std::uint64_t triangleCount = 0;
};

/// From a colour to what MeshSpool::colours has of it, and back.
fabric::Rgba againstPlain(fabric::Rgba colour);

/// Reads PLY files to the disk of `outPath`, as readMeshes reads them to memory.
/// Stage reported: "reading". Errors: those of readPlyPieces, disk full, more than 2^30 triangles.
absl::StatusOr<MeshSpool> spoolMeshes(std::span<const std::string> paths,
                                      const std::string& outPath, const ImportControl& control);

/// Fits the lattice and fills spool.triangles: without those that have no area there, and those
/// that were there already. `atOnce`: triangles that memory may hold.
/// Stage reported: "welding". Errors: those of packMesh.
absl::Status placeOnLattice(MeshSpool& spool, int latticeBits, std::uint64_t atOnce,
                            const std::string& outPath, PackCounts& counts,
                            const ImportControl& control);

}  // namespace eyrie::import
