// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/import/assimp_formats.h"
#include "renderer/import/triangle_mesh.h"

struct aiScene;

namespace eyrie::import {

/// What the nodes of a scene, read from a file of this `text`, show as one mesh, in metres where
/// the file names a unit, z up. Errors: InvalidArgument (a vertex that is not finite, a corner that
/// is no vertex, no face at all, more than 2^32 vertices).
absl::StatusOr<TriangleMesh> gatherMeshes(const aiScene& scene, const AssimpFormat& format,
                                          std::string_view text);

}  // namespace eyrie::import
