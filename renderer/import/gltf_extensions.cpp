// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "access/printable.h"
#include "renderer/import/gltf_chunks.h"

namespace eyrie::import {
namespace {

std::string_view afterSpace(std::string_view text) {
    return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

/// Takes `mark` from the front of `text`, spaces before it included, or nothing.
bool take(std::string_view& text, char mark) {
    const std::string_view rest = afterSpace(text);
    if (!rest.starts_with(mark))
        return false;
    text = rest.substr(1);
    return true;
}

/// The strings of the array that follows `key` and a colon. Extensions' names have no escapes.
std::vector<std::string> namesAt(std::string_view json, std::string_view key) {
    const std::string quoted = fmt::format("\"{}\"", key);
    std::vector<std::string> names;
    for (std::size_t at = json.find(quoted); at != std::string_view::npos;
         at = json.find(quoted, at + 1)) {
        std::string_view rest = json.substr(at + quoted.size());
        if (!take(rest, ':') || !take(rest, '['))
            continue;  // the words of another key, or of a text
        while (take(rest, '"')) {
            const std::size_t end = std::min(rest.find('"'), rest.size());
            names.emplace_back(rest.substr(0, end));
            rest.remove_prefix(std::min(end + 1, rest.size()));
            take(rest, ',');
        }
    }
    return names;
}

/// Materials are drawn by their diffuse colour and texture alone, and a texture of a kind that is
/// not read is named where it is missed.
bool isRead(std::string_view extension) {
    constexpr std::array kPrefixes = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                      "MSFT_texture_"};
    constexpr std::array kNames = {"KHR_draco_mesh_compression", "KHR_lights_punctual",
                                   "KHR_mesh_quantization", "EXT_meshopt_compression"};
    return std::ranges::count(kNames, extension) > 0 ||
           std::ranges::any_of(kPrefixes,
                               [&](const char* prefix) { return extension.starts_with(prefix); });
}

absl::Status notRead(std::string_view extension) {
    const bool isPacked = extension.ends_with("_meshopt_compression");
    return absl::InvalidArgumentError(
        fmt::format("requires the glTF extension '{}', which is not read; export it without{}",
                    access::printable(extension),
                    isPacked ? ", with EXT_meshopt_compression, or compressed by Draco" : ""));
}

}  // namespace

absl::Status checkGltfExtensions(std::span<const std::byte> bytes) {
    const std::string_view json = gltfChunksOf(bytes).json;
    for (const std::string& extension : namesAt(json, "extensionsRequired"))
        if (!isRead(extension))
            return notRead(extension);
    return absl::OkStatus();
}

std::vector<std::string> gltfCaveats(std::span<const std::byte> bytes) {
    std::vector<std::string> caveats;
    for (const std::string& extension : namesAt(gltfChunksOf(bytes).json, "extensionsUsed")) {
        if (extension == "CESIUM_RTC")
            caveats.emplace_back(
                "left out the centre that its coordinates are relative to (CESIUM_RTC): it is put "
                "around the origin");
        if (extension == "EXT_mesh_gpu_instancing")
            caveats.emplace_back(
                "left out copies of its meshes (EXT_mesh_gpu_instancing): each is where its node "
                "is");
    }
    return caveats;
}

}  // namespace eyrie::import
