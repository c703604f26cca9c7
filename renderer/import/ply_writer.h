// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>

#include <absl/status/status.h>

#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Writes binary little-endian PLY that readPly gives back as it was: coordinates as float where
/// that loses nothing, otherwise double; normals and colours where the mesh has them. The file
/// appears only when it is complete. `stop` is as of mesh::OutputFile.
/// Errors: NotFound (no such folder), PermissionDenied, ResourceExhausted, Unavailable.
absl::Status writePly(const TriangleMesh& mesh, const std::string& path,
                      const std::stop_token& stop = {});

}  // namespace eyrie::import
