// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <absl/status/status.h>

namespace eyrie::import {

/// Whether what a .gltf or .glb file requires of its readers is read here. Assimp does not ask: it
/// takes what it knows. Errors: InvalidArgument, which names the extension and how to do without.
absl::Status checkGltfExtensions(std::span<const std::byte> bytes);

/// What a file uses that moves or repeats what it shows, or has its images in, and is left out
/// here, and scenes that it does not show: for TriangleMesh::notes.
std::vector<std::string> gltfCaveats(std::span<const std::byte> bytes);

}  // namespace eyrie::import
