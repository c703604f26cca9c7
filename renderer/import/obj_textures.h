// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

struct aiScene;

namespace eyrie::import {

/// What `map_Kd`, in whatever case, says of a material: name, and where a place of the source lies
/// on it, at scale * place + offset, v upwards.
struct ObjTexture {
    std::string name;
    glm::vec2 scale{1, 1};
    glm::vec2 offset{0, 0};

    bool operator==(const ObjTexture&) const = default;
};

/// What follows `map_Kd`. Of options those that scale and shift (-s, -o) are taken, of one to
/// three numbers each; others are passed over.
ObjTexture parseMapKd(std::string_view arguments);

/// The names of all textures of an .mtl file, sorted.
std::vector<std::string> texturesOfMtl(std::string_view mtl);

/// The textures with options of an .mtl file, by the names of their materials; the last of each.
std::map<std::string, ObjTexture> objTexturesOf(std::string_view mtl);

/// Gives the materials of the OBJ at `path`, which Assimp has read as `scene`, what their textures
/// have options for: Assimp passes -s and -o over, and takes the name for one of three numbers
/// where they have fewer. Material files that are missing are for others to tell of.
void applyObjTextures(const std::string& path, std::string_view obj, const aiScene& scene);

}  // namespace eyrie::import
