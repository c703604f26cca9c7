// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

/// What is lost of a file that uses an extension.
struct Loss {
    std::string_view extension;
    const char* caveat;
};
constexpr std::array kLosses = {
    Loss{"CESIUM_RTC",
         "left out the centre that its coordinates are relative to (CESIUM_RTC): it is put around "
         "the origin"},
    Loss{"EXT_mesh_gpu_instancing",
         "left out copies of its meshes (EXT_mesh_gpu_instancing): each is where its node is"},
    Loss{"KHR_materials_transmission",
         "what is clear as glass (KHR_materials_transmission) is opaque: give its materials the "
         "alphaMode BLEND and less alpha"},
    Loss{
        "KHR_materials_unlit",
        "what is to be shown as it is (KHR_materials_unlit), as of photographs, is lit as the rest "
        "is, and darker where no light falls"},
    Loss{"KHR_node_visibility",
         "shows nodes, too, that are not to be seen (KHR_node_visibility): leave these out"},
};

/// Without taking apart all that a file may have in its texts.
std::size_t countScenes(std::string_view json) {
    constexpr std::string_view kKey = "\"scenes\"";
    std::string_view rest = json.substr(std::min(json.find(kKey), json.size()));
    rest.remove_prefix(std::min(kKey.size(), rest.size()));
    if (!take(rest, ':') || !take(rest, '['))
        return 0;
    std::size_t count = 0, depth = 0;
    bool isQuoted = false;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const char c = rest[i];
        if (isQuoted && c == '\\')
            ++i;
        else if (c == '"')
            isQuoted = !isQuoted;
        else if (!isQuoted && (c == '{' || c == '['))
            count += depth++ == 0 ? 1 : 0;
        else if (!isQuoted && (c == '}' || c == ']') && depth-- == 0)
            break;
    }
    return count;
}

/// Materials are drawn by their diffuse colour and texture alone, and textures of a kind that is
/// not read are told of.
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

nlohmann::json parsed(std::string_view json) {
    using Json = nlohmann::json;
    const auto isNear = [](int depth, Json::parse_event_t, Json&) { return depth < 8; };
    return Json::parse(json, isNear, false);
}

/// Assimp knows the weights of meshes, and not those that nodes have in their place.
std::string morphCaveat(std::string_view json) {
    const nlohmann::json root = parsed(json);
    const auto nodes = root.find("nodes");
    if (nodes == root.end())
        return {};
    const auto isMorphed = [](const nlohmann::json& node) {
        const auto weights = node.find("weights");
        return node.contains("mesh") && weights != node.end() &&
               std::ranges::any_of(*weights, [](const nlohmann::json& weight) {
                   return weight.is_number() && weight != 0;
               });
    };
    const auto morphed = std::ranges::count_if(*nodes, isMorphed);
    return morphed == 0
               ? ""
               : fmt::format(
                     "left out the weights of morph targets of {} nodes: their meshes have "
                     "their basic shape; apply the shape keys before export",
                     morphed);
}

/// What is left out of textures that have no image but an extension's; empty where there are none.
std::string textureCaveat(std::string_view json, const std::string& extension) {
    const nlohmann::json root = parsed(json);
    const auto textures = root.find("textures");
    if (textures == root.end())
        return {};
    const auto isLost = [&](const nlohmann::json& texture) {
        const auto extensions = texture.find("extensions");
        return extensions != texture.end() && extensions->contains(extension) &&
               !texture.contains("source");
    };
    const auto lost = std::ranges::count_if(*textures, isLost);
    return lost == 0 ? ""
                     : fmt::format(
                           "left out {} of {} textures, whose images are of a kind that is not "
                           "read ({}): export them as PNG or JPEG",
                           lost, textures->size(), extension);
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
    constexpr std::array kImages = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
                                    "MSFT_texture_dds"};
    const std::string_view json = gltfChunksOf(bytes).json;
    std::vector<std::string> caveats;
    std::set<std::string> seen;
    for (const std::string& extension : namesAt(json, "extensionsUsed")) {
        if (!seen.insert(extension).second)
            continue;
        for (const auto& [name, caveat] : kLosses)
            if (extension == name)
                caveats.emplace_back(caveat);
        if (std::ranges::count(kImages, extension) > 0)
            if (std::string caveat = textureCaveat(json, extension); !caveat.empty())
                caveats.push_back(std::move(caveat));
    }
    if (const std::size_t scenes = countScenes(json); scenes > 1)  // Assimp reads the one shown
        caveats.push_back(
            fmt::format("left out {} of its {} scenes: export what you want of them as one",
                        scenes - 1, scenes));
    if (json.find("\"weights\"") != json.npos)
        if (std::string caveat = morphCaveat(json); !caveat.empty())
            caveats.push_back(std::move(caveat));
    return caveats;
}

}  // namespace eyrie::import
