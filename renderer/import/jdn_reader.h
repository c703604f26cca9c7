// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Reads a scene of the .jdn format, as an exporter of 2002 wrote it: text of lines `Key = values`
/// with blanks or tabs at will; materials, lights and objects, each section opened by its count.
///
/// All objects become one mesh, with the vertices' normals, and the diffuse colours of materials as
/// vertex colours (as displayed), opacity as their alpha. Textures are named, for loadTextures;
/// where one is, it stands for the diffuse colour. Lights are those of source_lights.h. Lines with
/// unknown keys, objects without a known material or any opacity, and lights that are none are
/// counted in TriangleMesh::notes. `name` is used in messages, which say the line. Where
/// `memoryBytes` is not 0, a scene that takes more to read is refused before anything is read of
/// it. Errors: InvalidArgument, ResourceExhausted, Cancelled.
absl::StatusOr<TriangleMesh> parseJdn(std::string_view text, const std::string& name,
                                      const ImportControl& control = {},
                                      std::uint64_t memoryBytes = 0);

/// Whether a file that starts like this is such a scene.
bool looksLikeJdn(std::string_view text);

}  // namespace eyrie::import
