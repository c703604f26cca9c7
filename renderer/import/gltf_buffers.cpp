// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_buffers.h"

#include <cstdint>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "renderer/import/gltf_chunks.h"
#include "renderer/import/gltf_json.h"
#include "renderer/import/texture_files.h"

namespace eyrie::import {

std::optional<std::string> shortBufferOfGltf(std::span<const std::byte> bytes,
                                             const std::string& path) {
    const Json root = parsedGltf(gltfChunksOf(bytes).json);
    for (const Json& buffer : at(root, "buffers")) {
        const std::string uri = textAt(buffer, "uri");
        const Json& length = at(buffer, "byteLength");
        const std::string file = uri.starts_with("data:") ? "" : findTexture(uri, path);
        std::error_code ignored;
        const std::uintmax_t found = std::filesystem::file_size(file, ignored);
        if (!ignored && length.is_number_unsigned() && found < length.get<std::uint64_t>())
            return fmt::format(
                "found {} bytes in its buffer '{}', expected {}; copy that file again, or export "
                "the mesh again",
                found, uri, length.get<std::uint64_t>());
    }
    return std::nullopt;
}

}  // namespace eyrie::import
