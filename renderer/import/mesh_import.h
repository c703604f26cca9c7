// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/pack_mesh.h"
#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"
#include "renderer/mesh/lod/lod_tree.h"

namespace eyrie::import {

struct MeshImportOptions {
    std::uint32_t leafTriangles = 8192;  ///< triangles a leaf may have; 1 to 65,535
    PackOptions pack = {};               ///< lattice, normals and winding
    bool isRaw = false;                  ///< pages are not coded
    /// About as much is used: PLY files of meshes that would take more are imported part by part,
    /// with what is left on the disk of the output. 0: as much as it takes.
    std::uint64_t memoryBytes = 0;
};

/// The least that MeshImportOptions::memoryBytes may be.
inline constexpr std::uint64_t kLeastMeshMemory = std::uint64_t{256} << 20;

/// Wall-clock seconds of the stages.
struct MeshImportSeconds {
    double read = 0;
    double pack = 0;  ///< lattice, weld and normals
    double tree = 0;
    double levels = 0;  ///< simplified, and measured
    double write = 0;   ///< flushed to the disk
    double total = 0;
};

struct MeshImportReport {
    std::uint64_t triangles = 0;     ///< stored
    std::uint64_t vertices = 0;      ///< each counted once
    std::uint64_t droppedFaces = 0;  ///< of the sources, with fewer than three corners
    PackCounts counts;
    std::uint64_t nodes = 0;
    std::uint64_t pointNodes = 0;        ///< of these, that are drawn as points
    std::uint64_t sourceBytes = 0;       ///< of the files named
    std::vector<std::string> notes;      ///< what was odd in the sources; a line each
    std::uint64_t bytes = 0;             ///< of the .eym file
    double stepMetres = 0;               ///< of the lattice
    double errorMetres = 0;              ///< bound on what rounding moved: reading, and the lattice
    double coarsestErrorMetres = 0;      ///< of the root
    std::vector<mesh::LodLevel> levels;  ///< of detail, from the finest
    MeshImportSeconds seconds;
};

/// Imports mesh files (readMeshes) as one mesh into `outPath`, an .eym file that appears only when
/// it is complete. Stages reported: "reading", "welding", "normals", "tree", "levels", "writing";
/// those of importInParts (mesh_import_parts.h) where it takes more memory than it may.
/// Errors, all with nothing left behind: those of readMeshes; InvalidArgument (nothing to draw),
/// NotFound, PermissionDenied, Cancelled, ResourceExhausted (memory, disk; a mesh
/// that would take more than it may, and is no PLY), Unavailable.
absl::StatusOr<MeshImportReport> importMesh(const std::vector<std::string>& sourcePaths,
                                            const std::string& outPath,
                                            const MeshImportOptions& options = {},
                                            const ImportControl& control = {});

/// The same for a mesh in memory. `sourceHash` is kept in the file (EymFile::sourceHash).
absl::StatusOr<MeshImportReport> importMesh(TriangleMesh source, const std::string& outPath,
                                            const MeshImportOptions& options = {},
                                            const ImportControl& control = {},
                                            std::uint64_t sourceHash = 0);

}  // namespace eyrie::import
