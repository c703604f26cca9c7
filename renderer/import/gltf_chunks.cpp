// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_chunks.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include <absl/status/status.h>

namespace eyrie::import {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJson = 0x4E4F534A;
constexpr std::uint32_t kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

/// Empty, too, where there is no whole header.
std::span<const std::byte> chunkAt(std::span<const std::byte> bytes, std::size_t at) {
    if (bytes.size() < at || bytes.size() - at < kChunkHeaderBytes)
        return {};
    const std::size_t begin = at + kChunkHeaderBytes;
    return bytes.subspan(begin, std::min<std::size_t>(wordAt(bytes, at), bytes.size() - begin));
}

}  // namespace

bool isGlb(std::span<const std::byte> bytes) { return textOf(bytes).starts_with(kMagic); }

GltfChunks gltfChunksOf(std::span<const std::byte> bytes) {
    if (!isGlb(bytes) || bytes.size() < kHeaderBytes + kChunkHeaderBytes)
        return {textOf(bytes), {}};
    const auto json = chunkAt(bytes, kHeaderBytes);
    const std::size_t next = kHeaderBytes + kChunkHeaderBytes + (json.size() + 3) / 4 * 4;
    const auto binary = chunkAt(bytes, next);
    return {textOf(json), !binary.empty() && wordAt(bytes, next + 4) == kBinary
                              ? binary
                              : std::span<const std::byte>()};
}

absl::StatusOr<std::string> glbOf(std::string json, std::span<const std::byte> binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t binaryBytes = (binary.size() + 3) / 4 * 4;
    const std::size_t bytes = kHeaderBytes + 2 * kChunkHeaderBytes + json.size() + binaryBytes;
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        return absl::InvalidArgumentError("is of more than 4 GiB unpacked; export it in parts");
    std::string glb(kMagic);
    glb.reserve(bytes);
    const auto add = [&glb](std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        glb.append(reinterpret_cast<const char*>(&word), sizeof word);
    };
    add(kVersion);
    add(bytes);
    add(json.size());
    add(kJson);
    glb += json;
    add(binaryBytes);
    add(kBinary);
    glb.append(reinterpret_cast<const char*>(binary.data()), binary.size());
    glb.resize(bytes, '\0');
    return glb;
}

}  // namespace eyrie::import
