// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Reads several into one, in this order: side by side, as many as cores and
/// `reading.memoryBytes` leave room for. Where only some have colours, the others are of
/// kPlainColour; where only some have materials, the others have a plain one. Notes begin with
/// their file's name where there are several. Precondition: there is one. Errors: those of
/// readMesh, of the first file that has one; InvalidArgument (more than 2^32 vertices).
absl::StatusOr<TriangleMesh> readMeshes(std::span<const std::string> paths,
                                        const ImportControl& control = {},
                                        const MeshReading& reading = {});

/// In messages: of one, or of the first and how many more.
std::string nameOf(std::span<const std::string> paths);

}  // namespace eyrie::import
