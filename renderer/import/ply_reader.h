// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Reads a PLY mesh: text or binary of either byte order; elements and properties in any order,
/// others skipped. Taken are
///   vertex:     x y z; nx ny nz and red green blue [alpha] (diffuse_red ... too) where complete;
///               whole-number colours count to 255, 16-bit ones to 65,535 and real ones to 1 or,
///               where their values say so (byte_colours.h), to 255, as notes say
///   face:       list vertex_indices or vertex_index, of three corners or more (polygon.h)
///   tristrips:  the same, strips parted by -1
///   textures:   images named by comments TextureFile, for loadTextures; a face's coordinates in
///               its list texcoord, of its image texnumber, or its vertices' (s t, u v, texture_u
///               texture_v). Vertices along seams are split. An image stands for the colours.
/// Faces of fewer corners are dropped and counted; those whose texcoord or texnumber fits nothing
/// have no texture, and are counted in notes, as coordinates are that are no numbers. Colours of
/// faces, and textures by halves (images or coordinates alone), are left out, which notes say, as
/// they do of vertices that are not opaque, which show so where a texture is see-through alone.
///
/// Errors: NotFound, PermissionDenied, Cancelled, InvalidArgument naming file, element, number,
/// field, what was found, what was expected and the remedy: truncated file, counts that cannot fit
/// the file, coordinates that are not finite, corners out of range, no faces (a point cloud).
/// Memory stays within a constant times the file's size, whatever its header says.
absl::StatusOr<TriangleMesh> readPly(const std::string& path, const ImportControl& control = {});

/// What reads a mesh piece by piece is given, in turn: vertices and triangles that follow those
/// before, corners numbered through the whole mesh, which need not have come yet. It may take what
/// the piece holds.
using TakePiece = std::function<absl::Status(TriangleMesh& piece)>;

/// The same a few megabytes at a time, and no more in memory; droppedFaces count from the start,
/// and the last has the notes of all. Textures are left out, which those say. Errors: as above;
/// those of `take`; InvalidArgument where a face has more than three corners.
absl::Status readPlyPieces(const std::string& path, const TakePiece& take,
                           const ImportControl& control = {});

/// How much a PLY file declares; what it has no room for is an error.
struct PlySize {
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;  ///< strips count as many as they may have triangles
    std::uint64_t fileBytes = 0;
    bool isTextured = false;
    /// As many as the vertices may become where faces lie in images: of triangles one a corner.
    std::uint64_t splitVertices = 0;
};
/// Errors: those of readPly but for what lies in the body.
absl::StatusOr<PlySize> measurePly(const std::string& path);

/// The files of images that PLY text at `path` names; none where its header is damaged.
std::vector<std::string> texturesOfPly(std::string_view file, const std::string& path);

/// The same as readPly from memory. `name` stands for the file, in messages too. Where
/// `memoryBytes` is not 0 what polygons take ends there: ResourceExhausted.
absl::StatusOr<TriangleMesh> parsePly(std::string_view file, const std::string& name,
                                      const ImportControl& control = {},
                                      std::uint64_t memoryBytes = 0);

}  // namespace eyrie::import
