// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::import {

/// A .gltf or .glb whose vertices are integers (KHR_mesh_quantization, and texture coordinates
/// without it) or whose buffers are meshoptimizer's (EXT_meshopt_compression), as gltfpack writes
/// them, as a .glb of plain floats that needs neither: for Assimp, which takes integers for the
/// bits of floats. So, too, one whose JSON says what Assimp takes for something else
/// (gltf_mending.h). Coordinates are what the integers say, exactly for up to 24 bits; images keep
/// their names. Nothing for a file that Assimp takes as it is, or for what is no JSON.
///
/// Buffers that are files are looked for where `path` is. Morph targets and animations stay as they
/// are, unpacked. What is left out `notes` say. Errors: InvalidArgument (no sound glTF, with what
/// is wrong; a buffer that is not there; more than 64 times the bytes that it is packed in, part by
/// part and all in all).
absl::StatusOr<std::optional<std::string>> unpackGltf(std::span<const std::byte> bytes,
                                                      const std::string& path,
                                                      std::vector<std::string>& notes);

}  // namespace eyrie::import
