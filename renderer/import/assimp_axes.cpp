// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_axes.h"

#include <cmath>
#include <cstdint>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "renderer/import/stated_unit.h"

namespace eyrie::import {
namespace {

/// x stays, y goes to z, z to -y.
const glm::dmat4 kZUpFromYUp(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

/// The axis of an FBX scene that one of its settings names, with its sign.
glm::dvec3 fbxAxis(const aiMetadata& settings, const std::string& name) {
    std::int32_t axis = -1, sign = 1;
    glm::dvec3 result(0);
    if (settings.Get(name, axis) && settings.Get(name + "Sign", sign) && axis >= 0 && axis < 3)
        result[axis] = sign < 0 ? -1 : 1;
    return result;
}

}  // namespace

double metresPerUnitOf(const aiScene& scene, const AssimpFormat& format, std::string_view text,
                       std::vector<std::string>& notes) {
    float centimetres = 0;
    if (format.extension != ".fbx")
        return statedUnitOf(text, format, notes);
    if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UnitScaleFactor", centimetres))
        return 1;
    if (!std::isfinite(centimetres) || centimetres <= 0) {
        notes.push_back(fmt::format(
            "taken to be in metres: the file says that its unit is {:g} cm, which none is",
            centimetres));
        return 1;
    }
    return std::abs(centimetres - 100) < 1e-3F ? 1 : double{centimetres} / 100;
}

glm::dmat4 zUpFromScene(const aiScene& scene, const AssimpFormat& format) {
    if (!format.isYUp)
        return glm::dmat4(1);
    if (format.extension != ".fbx" || scene.mMetaData == nullptr)
        return kZUpFromYUp;
    const glm::dmat3 sceneFromZUp(fbxAxis(*scene.mMetaData, "CoordAxis"),
                                  -fbxAxis(*scene.mMetaData, "FrontAxis"),
                                  fbxAxis(*scene.mMetaData, "UpAxis"));
    const bool areAxes = glm::determinant(sceneFromZUp) != 0;
    return areAxes ? glm::dmat4(glm::transpose(sceneFromZUp)) : kZUpFromYUp;
}

}  // namespace eyrie::import
