// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_lights.h"

#include <span>

#include <assimp/light.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/mat3x3.hpp>

#include "renderer/import/assimp_values.h"
#include "renderer/import/source_lights.h"

namespace eyrie::import {
namespace {

glm::dmat4 placeOf(const aiNode* node, const glm::dmat4& worldFromScene) {
    glm::dmat4 sceneFromNode(1);
    for (; node != nullptr; node = node->mParent)
        sceneFromNode = toDouble(node->mTransformation) * sceneFromNode;
    return worldFromScene * sceneFromNode;
}

/// Its colour is taken for linear: in most formats the strength has been multiplied into it.
SourceLight sourceLight(const aiLight& light, const glm::dmat4& worldFromNode,
                        double metresPerUnit) {
    SourceLight result;
    result.colour = {light.mColorDiffuse.r, light.mColorDiffuse.g, light.mColorDiffuse.b};
    if (light.mType == aiLightSource_DIRECTIONAL) {
        result.kind = SourceLight::Kind::Distant;
        result.place = glm::dmat3(worldFromNode) * toDouble(light.mDirection);
        return result;
    }
    result.place = fabric::Vec3(worldFromNode * glm::dvec4(toDouble(light.mPosition), 1));
    // The linear part is 1 where none of Assimp's readers has said anything, and means nothing
    // then.
    if (light.mAttenuationLinear != 1 || light.mAttenuationQuadratic != 0) {
        result.constant = double{light.mAttenuationConstant};
        result.linear = double{light.mAttenuationLinear} / metresPerUnit;
        result.quadratic = double{light.mAttenuationQuadratic} / (metresPerUnit * metresPerUnit);
    }
    return result;
}

}  // namespace

fabric::FileLights lightsOf(const aiScene& scene, const glm::dmat4& worldFromScene,
                            double metresPerUnit, std::vector<std::string>& notes) {
    std::vector<SourceLight> lights;
    std::size_t spots = 0;
    std::size_t others = 0;
    for (const aiLight* light : std::span(scene.mLights, scene.mNumLights)) {
        const bool isSpot = light->mType == aiLightSource_SPOT;
        spots += isSpot ? 1 : 0;
        if (isSpot || light->mType == aiLightSource_POINT ||
            light->mType == aiLightSource_DIRECTIONAL)
            lights.push_back(sourceLight(
                *light, placeOf(scene.mRootNode->FindNode(light->mName), worldFromScene),
                metresPerUnit));
        else
            ++others;
    }
    if (spots > 0)
        notes.push_back(fmt::format("{} of {} lights are spots, and shine all around here", spots,
                                    scene.mNumLights));
    if (others > 0)
        notes.push_back(
            fmt::format("left out {} of {} lights, that are neither distant nor at a place", others,
                        scene.mNumLights));
    return lightsFrom(lights, notes);
}

}  // namespace eyrie::import
