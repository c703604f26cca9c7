// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

struct aiScene;

namespace eyrie::import {

/// The names of the material files that the OBJ at `path` is read with, as findTexture() takes
/// them: those that it names, and NAME.mtl, which Assimp takes instead, for those that are missing.
std::vector<std::string> materialFilesOf(std::string_view obj, const std::string& path);

/// Gives the materials of the OBJ at `path`, which Assimp has read as `scene`, what their files say
/// and Assimp has not got: it passes -s and -o of textures over, takes their name for one of three
/// numbers where they have fewer, and darkens textures where no colour is given. Returns what is to
/// be said of material files that are missing and of materials that are in none.
std::vector<std::string> applyObjMaterials(const std::string& path, std::string_view obj,
                                           const aiScene& scene);

}  // namespace eyrie::import
