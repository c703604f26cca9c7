// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/reading_process.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Reads all meshes of a file, each as often as nodes show it, with the nodes' transforms taken in
/// double precision; models of formats in which y is up are turned so that z is. FBX, COLLADA,
/// AMF and X3D are brought to metres by the unit that the file names, which notes say of all but
/// COLLADA; others are in the file's own units.
/// Materials' diffuse colours, times those of vertices, become vertex colours, with the opacity as
/// alpha; diffuse textures are named, or given where the file has them in it, for loadTextures.
/// glTF's alpha modes are kept; in other formats a texture's alpha says what it is for. Animations
/// are left out, which notes say, and bones. Polygons are cut by triangulatePolygon. Points and
/// lines count as dropped faces.
///
/// Assimp runs in a process of its own (reading_process.h) within `limits`.
/// Errors, all naming the file: NotFound, PermissionDenied, InvalidArgument (not readable, no
/// faces, a vertex that is not finite), ResourceExhausted, Cancelled.
absl::StatusOr<TriangleMesh> readWithAssimp(const std::string& path, const ReadingLimits& limits,
                                            const ImportControl& control = {});
absl::StatusOr<TriangleMesh> readWithAssimp(const std::string& path,
                                            const ImportControl& control = {});

}  // namespace eyrie::import
