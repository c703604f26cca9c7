// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_lights.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <assimp/light.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>

#include "renderer/import/assimp_values.h"
#include "renderer/import/source_lights.h"

namespace eyrie::import {
namespace {

/// Of an angle as Assimp hands it on, what is from the axis to the edge: FBX has it from one edge
/// to the other. 0 of those of which it hands on another angle, or another direction, than
/// the file has (.3ds), and of those that have not been looked at.
double shareFromAxis(std::string_view extension) {
    constexpr std::array<std::string_view, 5> kFromAxis = {".dae", ".glb", ".gltf", ".x3d", ".zae"};
    if (std::ranges::find(kFromAxis, extension) != kFromAxis.end())
        return 1;
    return extension == ".fbx" ? 0.5 : 0;
}

/// Nothing where the file says that it shines all around, as Assimp does where the file says
/// nothing. One wider than half of all directions has that half, which is what a cone can light.
std::optional<fabric::LightCone> coneOf(const aiLight& light, double share,
                                        const glm::dmat4& worldFromNode) {
    const double outer = glm::degrees(share * double{light.mAngleOuterCone});
    if (outer >= 180)
        return std::nullopt;
    const double inner = glm::degrees(share * double{light.mAngleInnerCone});
    fabric::LightCone cone{glm::dmat3(worldFromNode) * toDouble(light.mDirection), inner, outer};
    if (outer > 90)
        cone.outerDegrees = 90;
    if (inner > cone.outerDegrees)
        cone.innerDegrees = cone.outerDegrees;
    const double length = glm::length(cone.axis);
    cone.axis = length > 0 ? cone.axis / length : cone.axis;
    return cone;
}

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

fabric::FileLights lightsOf(const aiScene& scene, std::string_view extension,
                            const glm::dmat4& worldFromScene, double metresPerUnit,
                            std::vector<std::string>& notes) {
    std::vector<SourceLight> lights;
    const double share = shareFromAxis(extension);
    std::size_t spots = 0;  // that shine all around
    std::size_t others = 0;
    for (const aiLight* light : std::span(scene.mLights, scene.mNumLights)) {
        const bool isSpot = light->mType == aiLightSource_SPOT;
        if (!isSpot && light->mType != aiLightSource_POINT &&
            light->mType != aiLightSource_DIRECTIONAL) {
            ++others;
            continue;
        }
        const glm::dmat4 worldFromNode =
            placeOf(scene.mRootNode->FindNode(light->mName), worldFromScene);
        lights.push_back(sourceLight(*light, worldFromNode, metresPerUnit));
        if (isSpot && share > 0)
            lights.back().cone = coneOf(*light, share, worldFromNode);
        else if (isSpot)
            ++spots;
    }
    if (spots > 0)
        notes.push_back(
            fmt::format("{} of {} lights are spots, and shine all around here: what cones {} files "
                        "have is not read; export the mesh as .glb to have them",
                        spots, scene.mNumLights, extension));
    if (others > 0)
        notes.push_back(
            fmt::format("left out {} of {} lights, that are neither distant nor at a place", others,
                        scene.mNumLights));
    return lightsFrom(lights, notes);
}

}  // namespace eyrie::import
