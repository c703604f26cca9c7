// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace eyrie::import {

/// What is wrong with the first buffer of a .gltf or .glb at `path` that is a file shorter than it
/// says, in words that follow its name; nothing where none is.
std::optional<std::string> shortBufferOfGltf(std::span<const std::byte> bytes,
                                             const std::string& path);

}  // namespace eyrie::import
