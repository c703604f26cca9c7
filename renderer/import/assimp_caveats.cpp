// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_caveats.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "renderer/import/gltf_extensions.h"

namespace eyrie::import {
namespace {

/// Of the nodes of X3D that hold others and are passed over with all in them, those in a file.
std::vector<std::string> x3dCaveats(std::string_view text) {
    constexpr std::array<std::string_view, 8> kPassedOver = {
        "Anchor",       "Billboard",     "Collision", "GeoLOD",
        "GeoTransform", "HAnimHumanoid", "LOD",       "ProtoInstance"};
    std::string found;
    for (const std::string_view name : kPassedOver)
        if (text.find(fmt::format("<{} ", name)) != std::string_view::npos ||
            text.find(fmt::format("<{}>", name)) != std::string_view::npos)
            found += fmt::format("{}{}", found.empty() ? "" : ", ", name);
    if (found.empty())
        return {};
    return {
        fmt::format("left out all that is in nodes of the kinds {}, which are not read: put it "
                    "into Groups and Transforms",
                    found)};
}

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

}  // namespace

std::vector<std::string> caveats(std::span<const std::byte> bytes, const AssimpFormat& format) {
    if (format.isGltf())
        return gltfCaveats(bytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (format.extension == ".x3d")
        return x3dCaveats(text);
    if (format.extension == ".dae")
        return colladaCaveats(text);
    const bool isPlaced = text.find("\nloc ") != std::string_view::npos ||
                          text.find("\nrot ") != std::string_view::npos;
    if (!format.extension.starts_with(".ac") || !isPlaced)
        return {};
    return {
        "objects are put where their own 'loc' says; that of groups around them, and 'rot' "
        "beside 'loc', are not taken right: export it in another format if parts are misplaced"};
}

}  // namespace eyrie::import
