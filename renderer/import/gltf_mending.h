// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "renderer/import/gltf_json.h"

namespace eyrie::import {

/// Says in a glTF's JSON what Assimp 5.2 takes for what is meant, and returns whether anything had
/// to change. It has each light once, where the last of its nodes is or the first of that node's
/// name, so each node of the scene gets a light and a name of its own; and it passes over another
/// set of texture coordinates that KHR_texture_transform may give a colour's texture. Primitives
/// without positions, for which it refuses the file, are left out, as the format wants it, and
/// counted in `notes`.
bool mendGltf(Json& root, std::vector<std::string>& notes);

}  // namespace eyrie::import
