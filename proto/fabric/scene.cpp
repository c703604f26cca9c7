// SPDX-License-Identifier: Apache-2.0
#include "fabric/scene.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/scene_reach.h"

namespace eyrie::fabric {
namespace {

absl::Status validateTransform(const SceneObject& object) {
    const Mat4& m = object.worldFromObject;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!(std::abs(m[column][row]) <= kMaxSceneMetres))
                return absl::InvalidArgumentError(fmt::format(
                    "object '{}': transform element [{}][{}] is {:.3g}; it must be from {:g} to "
                    "{:g}",
                    object.name, row, column, m[column][row], -kMaxSceneMetres, kMaxSceneMetres));
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
        return absl::InvalidArgumentError(fmt::format(
            "object '{}': the transform's last row must be 0 0 0 1 (an affine transform)",
            object.name));
    if (std::abs(glm::determinant(Mat3(m))) == 0)
        return absl::InvalidArgumentError(fmt::format(
            "object '{}': the transform is singular (it flattens the object)", object.name));
    return absl::OkStatus();
}

absl::Status validateCone(const LightCone& cone) {
    const double length = glm::length(cone.axis);
    if (!(length > 0 && std::isfinite(length)))
        return absl::InvalidArgumentError(
            "scene.pointLights.cone.axis must be three finite numbers, not all 0");
    if (!(cone.outerDegrees > 0 && cone.outerDegrees <= 90))
        return absl::InvalidArgumentError(
            fmt::format("scene.pointLights.cone.outerDegrees is {}; it must be more than 0 and at "
                        "most 90, which lights half of the space; leave the cone out for all of it",
                        cone.outerDegrees));
    if (!(cone.innerDegrees >= 0 && cone.innerDegrees <= cone.outerDegrees))
        return absl::InvalidArgumentError(fmt::format(
            "scene.pointLights.cone.innerDegrees is {}; it must be from 0 to outerDegrees, {}",
            cone.innerDegrees, cone.outerDegrees));
    return absl::OkStatus();
}

absl::Status validateLights(const Scene& scene) {
    const std::size_t count = scene.lights.size() + scene.pointLights.size();
    if (count > kMaxLights)
        return absl::InvalidArgumentError(
            fmt::format("the scene has {} lights; at most {} are drawn", count, kMaxLights));
    for (const DirectionalLight& light : scene.lights) {
        const double length = glm::length(light.direction);
        if (!(length > 0 && std::isfinite(length)))
            return absl::InvalidArgumentError(
                "scene.lights.direction must be three finite numbers, not all 0");
    }
    for (const PointLight& light : scene.pointLights) {
        if (!(glm::length(light.positionMetres) <= kMaxCoordinateMetres))
            return absl::InvalidArgumentError(fmt::format(
                "scene.pointLights.position must be three finite numbers, at most {} metres away",
                kMaxCoordinateMetres));
        if (!(light.reachMetres >= kLeastReachMetres && light.reachMetres <= kMostReachMetres))
            return absl::InvalidArgumentError(
                fmt::format("scene.pointLights.reach is {}; it must be from {} to {} metres",
                            light.reachMetres, kLeastReachMetres, kMostReachMetres));
        if (light.cone)
            if (absl::Status status = validateCone(*light.cone); !status.ok())
                return status;
    }
    return absl::OkStatus();
}

}  // namespace

absl::Status validate(const Scene& scene) {
    if (absl::Status status = validateLights(scene); !status.ok())
        return status;
    if (!(scene.ambient >= 0 && scene.ambient <= 1))
        return absl::InvalidArgumentError(
            fmt::format("scene.ambient is {}; it must be from 0 to 1", scene.ambient));
    for (const SceneObject& object : scene.objects) {
        if (object.name.empty() || object.path.empty())
            return absl::InvalidArgumentError(fmt::format("an object of the scene lacks its {}",
                                                          object.name.empty() ? "name" : "path"));
        if (absl::Status status = validateTransform(object); !status.ok())
            return status;
    }
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
