// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_import.h"
#include "renderer/mesh/output_file.h"

/// Import of a mesh that does not fit memory: read to disk, cut into parts there, and built part
/// by part. The file is that of an import in memory, to the byte.
namespace eyrie::import {

/// What the program takes by itself (measured: 60 to 88 MiB).
inline constexpr std::uint64_t kProgramBytes = std::uint64_t{96} << 20;

/// About what an import takes in memory beside that, of PLY files or of what was read.
std::uint64_t importBytes(std::uint64_t triangles, std::uint64_t vertices,
                          std::uint64_t sourceBytes, const MeshImportOptions& options,
                          bool isTextured = false);

/// Triangles that a part may have where importing it may take `memoryBytes`, and all of the mesh
/// has so many vertices and triangles.
std::uint64_t trianglesAtOnce(std::uint64_t memoryBytes, std::uint64_t triangles,
                              std::uint64_t vertices, const MeshImportOptions& options);

/// Imports PLY files into the empty `out`, which the caller commits, by parts of `atOnce` triangles
/// at most (more where a leaf, or a node that is simplified, may have more). Without textures.
/// Stages reported: "reading", "welding", "backs", "tree", "borders", "levels", "writing". Errors:
/// those of importMesh; InvalidArgument where a face has more than three corners or winding is to
/// be made consistent (PackOptions::orients).
absl::StatusOr<MeshImportReport> importInParts(std::span<const std::string> paths,
                                               mesh::OutputFile& out, std::uint64_t atOnce,
                                               const MeshImportOptions& options,
                                               const ImportControl& control,
                                               std::uint64_t sourceHash);

}  // namespace eyrie::import
