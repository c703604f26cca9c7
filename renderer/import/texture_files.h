// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include <absl/status/status.h>

#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// In either direction; texture coordinates that are farther away are cut off there.
inline constexpr double kMostImageSides = 16384;

/// Reads the images that `mesh` names, where a source at `path` would have them, into
/// TriangleMesh::images, in a process of its own (reading_process.h): PNG, JPEG, TGA, BMP, GIF, PSD
/// and what else stb_image knows, and SGI's, up to mesh::kMaxImageSide a side. Names may have
/// backslashes; files that are not where they are named are looked for beside the source by their
/// last part, then without regard to case, then as URIs have it, with %20 for a space, then so
/// beside OBJ's material files that name them.
///
/// An image that is missing, damaged or too large is counted in the notes, the first with its name
/// and the reason; its materials have their colour alone. Where a material of kReplacesColour has
/// its image colours become white. Alpha is kept where a material uses it.
/// A material of kAlphaByImage whose image has alpha is blended if more than half of the texels
/// that are not opaque are not clear either, and has holes otherwise; it is opaque if all texels
/// are clear, which notes say. Materials that are blended
/// for nothing are opaque; the same materials are one; and where there is nothing but a plain one
/// there is none. Notes say how many texture coordinates will be cut off. Errors: Cancelled;
/// ResourceExhausted (reading them takes more than `memoryBytes`, where that is not 0).
absl::Status loadTextures(TriangleMesh& mesh, const std::string& path, const ImportControl& control,
                          std::uint64_t memoryBytes = 0);

/// The file that `name` in a source at `path` means; empty where there is none that may be read
/// (companion_folder.h).
std::string findTexture(const std::string& name, const std::string& path);

/// The same of `name` in a file at `companion` that the source is read with, as OBJ's materials
/// are: beside that where the source has none.
std::string findTexture(const std::string& name, const std::string& path,
                        const std::string& companion);

}  // namespace eyrie::import
