// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::import {

/// What a .gltf or .glb file is made of (glTF 2.0, "GLB File Format Specification").
struct GltfChunks {
    std::string_view json;              ///< all of a .gltf
    std::span<const std::byte> binary;  ///< the buffer that a .glb brings along, if it does
};

/// What JSON may begin with, though glTF forbids it; Assimp refuses such files.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// Whether a file's bytes begin as a .glb's do.
bool isGlb(std::span<const std::byte> bytes);

/// Of a file's bytes, which they lie in. As much as there is of chunks that are cut off.
GltfChunks gltfChunksOf(std::span<const std::byte> bytes);

/// A .glb of them. Errors: InvalidArgument (more than its 32 bits count).
absl::StatusOr<std::string> glbOf(std::string json, std::span<const std::byte> binary);

}  // namespace eyrie::import
