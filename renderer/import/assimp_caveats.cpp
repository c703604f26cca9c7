// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_caveats.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "renderer/import/amf_text.h"
#include "renderer/import/dxf_text.h"
#include "renderer/import/gltf_extensions.h"
#include "renderer/import/obj_text.h"
#include "renderer/import/off_text.h"
#include "renderer/import/stl_text.h"
#include "renderer/import/x3d_caveats.h"

namespace eyrie::import {
namespace {

/// Assimp reads Maya's way to say so, and not the format's.
std::vector<std::string> colladaCaveats(std::string_view text) {
    for (const std::string_view mode : {"CLAMP", "BORDER", "MIRROR", "NONE"})
        if (text.find(fmt::format(">{}</wrap_", mode)) != std::string_view::npos)
            return {
                fmt::format("textures repeat, also those that ought not ({} of wrap_s or "
                            "wrap_t): export the mesh as .glb if they show where they should "
                            "not",
                            mode)};
    return {};
}

/// What is packed is not mended (collada_text.h).
std::vector<std::string> packedColladaCaveats() {
    return {
        "what its materials say of the coordinates that textures lie by (<bind_vertex_input>) is "
        "not read of packed files: unpack it to .dae if they lie wrong"};
}

/// Assimp takes what there is.
std::vector<std::string> stlCaveats(std::string_view source) {
    const std::optional<std::string> mended = stlTextForAssimp(source);
    const std::string_view text = mended ? std::string_view(*mended) : source;
    const std::size_t end = text.rfind("endsolid");
    const std::size_t lastSolid = text.rfind("\nsolid");  // but the first
    if (!isStlText(source) || (end != text.npos && (lastSolid == text.npos || lastSolid < end)))
        return {};
    return {
        "it ends without 'endsolid', as files do that were cut off: copy or export it again if "
        "anything is missing"};
}

/// Assimp reads as far as the file goes, whatever length its first chunk has.
std::vector<std::string> lwoCaveats(std::span<const std::byte> bytes) {
    constexpr std::size_t kBeforeLength = 4, kHeader = 8;  // FORM, and its length
    if (bytes.size() < kHeader)
        return {};
    std::uint64_t length = kHeader;
    for (std::size_t i = 0; i < 4; ++i)
        length += std::to_integer<std::uint64_t>(bytes[kBeforeLength + i]) << (24 - 8 * i);
    if (bytes.size() >= length)
        return {};
    return {fmt::format(
        "its header says that it has {} bytes, and it has {}, as files do that were cut off: copy "
        "or export it again if anything is missing",
        length, bytes.size())};
}

/// Assimp passes over them, and edges are smooth of which they say that they are sharp.
class SmoothingGroups {
public:
    void add(std::string_view line) {
        constexpr std::string_view kNormal = "vn ", kGroup = "s ";
        haveNormals_ = haveNormals_ || line.starts_with(kNormal);
        if (!line.starts_with(kGroup))
            return;
        line = line.substr(0, line.find_first_of("\r\n")).substr(kGroup.size());
        line = line.substr(0, line.find_last_not_of(" \t") + 1);
        isAnyFlat_ = isAnyFlat_ || line == "off" || line == "0";
        areSeveral_ = areSeveral_ || (!last_.empty() && line != last_);
        last_ = line;
    }

    bool areLost() const { return !haveNormals_ && (isAnyFlat_ || areSeveral_); }

private:
    std::string_view last_;
    bool haveNormals_ = false, isAnyFlat_ = false, areSeveral_ = false;
};

std::vector<std::string> objCaveats(std::string_view text) {
    constexpr std::array<std::string_view, 8> kLeftOut = {"surf ", "curv ", "curv2 ", "bzp ",
                                                          "bsp ",  "cdc ",  "cdp ",   "call "};
    std::uint64_t lines = 0;
    SmoothingGroups groups;
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view line = text.substr(at);
        groups.add(line);
        const auto begins = [&](std::string_view word) { return line.starts_with(word); };
        lines += std::ranges::any_of(kLeftOut, begins) ? 1 : 0;
        at = std::min(text.find('\n', at), text.size() - 1) + 1;
    }
    std::vector<std::string> caveats = objVertexCaveats(text);
    if (lines > 0)
        caveats.push_back(
            fmt::format("left out {} free-form surfaces, curves or calls of other files: turn them "
                        "into polygons, of this file, before export",
                        lines));
    if (groups.areLost())
        caveats.emplace_back(
            "left out its smoothing groups, by which it has sharp edges: it has no normals, and "
            "its edges are smooth unless creases are asked for (--normals crease=DEGREES)");
    return caveats;
}

}  // namespace

std::vector<std::string> caveats(std::span<const std::byte> bytes, const AssimpFormat& format) {
    if (format.isGltf())
        return gltfCaveats(bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (format.extension == ".x3d")
        return x3dCaveats(text);
    if (format.extension == ".dae")
        return colladaCaveats(text);
    if (format.extension == ".zae")
        return packedColladaCaveats();
    if (format.extension == ".amf")
        return amfCaveats(text);
    if (format.extension == ".dxf")
        return dxfCaveats(text);
    if (format.extension == ".stl")
        return stlCaveats(text);
    if (format.extension == ".lwo" || format.extension == ".lxo")
        return lwoCaveats(bytes);
    if (format.extension == ".off")
        return offCaveats(text);
    if (format.extension == ".obj")
        return objCaveats(text);
    const bool isPlaced = text.find("\nloc ") != std::string_view::npos ||
                          text.find("\nrot ") != std::string_view::npos;
    if (!format.extension.starts_with(".ac") || !isPlaced)
        return {};
    return {
        "objects are put where their own 'loc' says; that of groups around them, and 'rot' "
        "beside 'loc', are not taken right: export it in another format if parts are misplaced"};
}

}  // namespace eyrie::import
