// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// As much of JSON as it takes to ask a glTF file for what Assimp does not tell. Keys come in their
/// quotation marks. Any text may be asked; of what is no JSON the answers mean nothing.
namespace eyrie::import {

/// The JSON of a .gltf, or that of a .glb, which is its first chunk.
std::string_view gltfJsonOf(std::span<const std::byte> bytes);

/// Takes `mark` from the front of `text`, spaces before it included, or nothing.
bool take(std::string_view& text, char mark);

/// The objects of the array that follows the first `key`, `most` of them at most.
std::vector<std::string_view> objectsAt(std::string_view json, std::string_view key,
                                        std::size_t most);

/// The whole number that follows the first `key` and a colon.
std::optional<std::size_t> numberAfter(std::string_view json, std::string_view key);

}  // namespace eyrie::import
