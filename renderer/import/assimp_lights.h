// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "fabric/lights.h"

struct aiScene;

namespace eyrie::import {

/// The lights of what Assimp has read from a file with that extension, placed by their nodes, of
/// which `worldFromScene` places the root (source_lights.h); how they fade is in units of
/// `metresPerUnit`. `notes` says of how many spots it is not known into what they shine: these
/// shine all around; and how many lights have neither a place nor a way: these are left out.
fabric::FileLights lightsOf(const aiScene& scene, std::string_view extension,
                            const glm::dmat4& worldFromScene, double metresPerUnit,
                            std::vector<std::string>& notes);

}  // namespace eyrie::import
