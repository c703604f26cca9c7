// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "fabric/lights.h"

struct aiScene;

namespace eyrie::import {

/// The lights of what Assimp has read, placed by their nodes, of which `worldFromScene` places the
/// root (source_lights.h); how they fade is in units of `metresPerUnit`. Spots shine all around,
/// and what has neither a place nor a way is left out: `notes` says how many.
fabric::FileLights lightsOf(const aiScene& scene, const glm::dmat4& worldFromScene,
                            double metresPerUnit, std::vector<std::string>& notes);

}  // namespace eyrie::import
