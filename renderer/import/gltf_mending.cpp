// SPDX-License-Identifier: Apache-2.0
// Khronos' specifications of glTF 2.0, KHR_lights_punctual and KHR_texture_transform.
#include "renderer/import/gltf_mending.h"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace eyrie::import {
namespace {

/// What is at the end of a way of keys; null where there is nothing.
Json* memberAt(Json& object, std::initializer_list<const char*> keys) {
    Json* found = &object;
    for (const char* key : keys) {
        if (!found->is_object() || !found->contains(key))
            return nullptr;
        found = &(*found)[key];
    }
    return found;
}

bool mendTexture(Json& texture) {
    const Json* set = memberAt(texture, {"extensions", "KHR_texture_transform", "texCoord"});
    const Json* plain = memberAt(texture, {"texCoord"});
    if (set == nullptr || *set == (plain != nullptr ? *plain : Json(0)))
        return false;
    texture["texCoord"] = Json(*set);
    return true;
}

bool mendTextures(Json& root) {
    bool isMended = false;
    Json* materials = memberAt(root, {"materials"});
    if (materials == nullptr || !materials->is_array())
        return false;
    for (Json& material : *materials)
        for (Json* texture :
             {memberAt(material, {"pbrMetallicRoughness", "baseColorTexture"}),
              memberAt(material,
                       {"extensions", "KHR_materials_pbrSpecularGlossiness", "diffuseTexture"})})
            isMended = (texture != nullptr && mendTexture(*texture)) || isMended;
    return isMended;
}

/// By their numbers, those of the scene that is shown.
std::vector<bool> shownNodesOf(const Json& root, std::size_t count) {
    std::vector<bool> isShown(count, false);
    const Json& scenes = at(root, "scenes");
    const Json& scene = at(root, "scene");
    const std::uint64_t number = scene.is_number_unsigned() ? scene.get<std::uint64_t>() : 0;
    if (!scenes.is_array() || number >= scenes.size())
        return isShown;
    std::vector<const Json*> waiting = {&at(scenes[number], "nodes")};
    while (!waiting.empty()) {
        const Json& nodes = *waiting.back();
        waiting.pop_back();
        for (const Json& node : nodes) {
            const std::uint64_t index =
                node.is_number_unsigned() ? node.get<std::uint64_t>() : count;
            if (index >= count || isShown[index])
                continue;
            isShown[index] = true;
            waiting.push_back(&at(root["nodes"][index], "children"));
        }
    }
    return isShown;
}

bool mendLights(Json& root) {
    constexpr const char* kLights = "KHR_lights_punctual";
    Json* lights = memberAt(root, {"extensions", kLights, "lights"});
    Json* nodes = memberAt(root, {"nodes"});
    if (lights == nullptr || !lights->is_array() || nodes == nullptr || !nodes->is_array())
        return false;
    const auto nameOf = [&](std::size_t i) {  // as Assimp has it
        const std::string name = textAt((*nodes)[i], "name");
        return name.empty() ? fmt::format("nodes_{}", i) : name;
    };
    std::multiset<std::string> names;
    for (std::size_t i = 0; i < nodes->size(); ++i) names.insert(nameOf(i));
    const std::vector<bool> isShown = shownNodesOf(root, nodes->size());
    std::set<std::uint64_t> taken;
    bool isMended = false;
    for (std::size_t i = 0; i < nodes->size(); ++i) {
        Json* light = memberAt((*nodes)[i], {"extensions", kLights, "light"});
        if (!isShown[i] || light == nullptr || !light->is_number_unsigned() ||
            light->get<std::uint64_t>() >= lights->size())
            continue;
        if (!taken.insert(light->get<std::uint64_t>()).second) {
            lights->push_back(Json((*lights)[light->get<std::size_t>()]));
            *light = lights->size() - 1;
            isMended = true;
        }
        std::string name = nameOf(i);
        if (names.count(name) < 2)
            continue;
        names.erase(names.find(name));
        name += fmt::format("_{}", i);
        while (names.contains(name)) name += '_';
        names.insert(name);
        (*nodes)[i]["name"] = name;
        isMended = true;
    }
    return isMended;
}

bool mendPrimitives(Json& root, std::vector<std::string>& notes) {
    Json* meshes = memberAt(root, {"meshes"});
    if (meshes == nullptr || !meshes->is_array())
        return false;
    std::size_t all = 0, lost = 0;
    for (Json& mesh : *meshes) {
        Json* primitives = memberAt(mesh, {"primitives"});
        if (primitives == nullptr || !primitives->is_array())
            continue;
        Json placed = Json::array();
        for (Json& primitive : *primitives)
            if (memberAt(primitive, {"attributes", "POSITION"}) != nullptr)
                placed.push_back(primitive);
        all += primitives->size();
        lost += primitives->size() - placed.size();
        *primitives = std::move(placed);
    }
    if (lost > 0)
        notes.push_back(fmt::format(
            "left out {} of {} parts of its meshes (primitives), which have no positions", lost,
            all));
    return lost > 0;
}

}  // namespace

bool mendGltf(Json& root, std::vector<std::string>& notes) {
    const bool hasMendedLights = mendLights(root);
    const bool hasMendedPrimitives = mendPrimitives(root, notes);
    return mendTextures(root) || hasMendedLights || hasMendedPrimitives;
}

}  // namespace eyrie::import
