// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Whether a file's name ends like that of a mesh that readMesh knows, packed or not: packed ones
/// it refuses.
bool isMeshSource(const std::string& path);

/// Whether the normals that a file may have say which edges are sharp. Those of PLY are mostly a
/// scanner's, and STL has those of faces alone, whatever the surface.
bool statesEdges(const std::string& path);

/// Their endings, as in ".ply, .jdn, .obj".
std::string meshSourceEndings();

struct MeshReading {
    bool onlyNormalsOfEdges = false;  ///< files that are not of statesEdges() have none then
    /// That Assimp may take in its process, textures in theirs, reading .jdn or the polygons of a
    /// PLY here, or the meshes of several files together; 0: what sound files need. Of triangles
    /// PLY takes a constant times the file's size, which its header tells (measurePly).
    std::uint64_t memoryBytes = 0;
};

/// Reads a mesh of any known format, textures included (texture_files.h): PLY and .jdn told by what
/// the file starts with, or its name; the others, read by Assimp, by its name. Errors: those of the
/// format's reader, which name the file; InvalidArgument (no known format).
absl::StatusOr<TriangleMesh> readMesh(const std::string& path, const ImportControl& control = {},
                                      const MeshReading& reading = {});

/// Whether readMesh takes a file for PLY.
bool isPly(const std::string& path);

/// What vertices are coloured without colours of their own, beside others that have some.
inline constexpr fabric::Rgba kPlainColour{204, 204, 204, 255};

/// The buffers, material files and textures that a file of OBJ, glTF, AC3D, PLY or .jdn names, as
/// far as they exist. Errors: NotFound, PermissionDenied, InvalidArgument (a folder), Unavailable.
absl::StatusOr<std::vector<std::string>> companionsOf(const std::string& path);

/// What the reader of a source's format reads: the source and, of glTF, its buffers.
std::uint64_t bytesToRead(const std::string& path);

/// Of the bytes of all files that a mesh is read from: `paths`, and companionsOf these. One file
/// without such company has the hash of its own bytes (mesh::contentHash). Errors: as above.
absl::StatusOr<std::uint64_t> meshSourceHash(std::span<const std::string> paths);

}  // namespace eyrie::import
