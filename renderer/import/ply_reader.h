// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Reads a PLY mesh: text or binary of either byte order; elements and properties in any order,
/// others skipped. Taken are
///   vertex:     x y z; nx ny nz and red green blue [alpha] (diffuse_red ... too) where complete;
///               whole-number colours count to 255 (16-bit ones to 65,535), real ones to 1
///   face:       list vertex_indices or vertex_index, of three corners or more (polygon.h)
///   tristrips:  the same, strips parted by -1
/// Faces of fewer corners are dropped and counted.
///
/// Errors: NotFound, PermissionDenied, Cancelled, InvalidArgument naming file, element, number,
/// field, what was found, what was expected and the remedy: truncated file, counts that cannot fit
/// the file, coordinates that are not finite, corners out of range, no faces (a point cloud).
/// Memory stays within a constant times the file's size, whatever its header says.
absl::StatusOr<TriangleMesh> readPly(const std::string& path, const ImportControl& control = {});

/// The same from memory. `name` stands for the file in messages.
absl::StatusOr<TriangleMesh> parsePly(std::string_view file, const std::string& name,
                                      const ImportControl& control = {});

}  // namespace eyrie::import
