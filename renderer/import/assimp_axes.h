// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "renderer/import/assimp_formats.h"

struct aiScene;

/// What a file says of its axes and its unit, where Assimp hands that on without applying it.
namespace eyrie::import {

/// FBX says what its unit is, in centimetres, AMF and X3D in their `text` (stated_unit.h);
/// COLLADA's Assimp applies, and others are taken as they are. 1 of a unit that cannot be, which
/// `notes` then says.
double metresPerUnitOf(const aiScene& scene, const AssimpFormat& format, std::string_view text,
                       std::vector<std::string>& notes);

/// So that z is up, and y away from who looks from the front.
glm::dmat4 zUpFromScene(const aiScene& scene, const AssimpFormat& format);

}  // namespace eyrie::import
