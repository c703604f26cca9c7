// SPDX-License-Identifier: Apache-2.0
#include "fabric/scene.h"

#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "fabric/scene_reach.h"

namespace eyrie::fabric {
namespace {

/// "scene.objects[2] 'barn'".
std::string nameOf(const SceneObject& object, std::size_t index) {
    return fmt::format("scene.objects[{}] '{}'", index, object.name);
}

absl::Status validateTransform(const SceneObject& object, std::size_t index) {
    const Mat4& m = object.worldFromObject;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!(std::abs(m[column][row]) <= kMaxSceneMetres))
                return absl::InvalidArgumentError(fmt::format(
                    "{}: transform element [{}][{}] is {:.3g}; it must be from {:g} to {:g}",
                    nameOf(object, index), row, column, m[column][row], -kMaxSceneMetres,
                    kMaxSceneMetres));
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
        return absl::InvalidArgumentError(
            fmt::format("{}: the transform's last row must be 0 0 0 1 (an affine transform)",
                        nameOf(object, index)));
    if (std::abs(glm::determinant(Mat3(m))) == 0)
        return absl::InvalidArgumentError(fmt::format(
            "{}: the transform is singular (it flattens the object)", nameOf(object, index)));
    return absl::OkStatus();
}

/// `field` is the cone's.
absl::Status validateCone(const LightCone& cone, const std::string& field) {
    const double length = glm::length(cone.axis);
    if (!(length > 0 && std::isfinite(length)))
        return absl::InvalidArgumentError(
            fmt::format("{}.axis must be three finite numbers, not all 0", field));
    if (!(cone.outerDegrees > 0 && cone.outerDegrees <= 90))
        return absl::InvalidArgumentError(fmt::format(
            "{}.outerDegrees is {}; it must be more than 0 and at most 90, which lights "
            "half of the space; leave the cone out for all of it",
            field, cone.outerDegrees));
    if (!(cone.innerDegrees >= 0 && cone.innerDegrees <= cone.outerDegrees))
        return absl::InvalidArgumentError(
            fmt::format("{}.innerDegrees is {}; it must be from 0 to outerDegrees, {}", field,
                        cone.innerDegrees, cone.outerDegrees));
    return absl::OkStatus();
}

absl::Status validateLights(const Scene& scene) {
    const std::size_t count = scene.lights.size() + scene.pointLights.size();
    if (count > kMaxLights)
        return absl::InvalidArgumentError(
            fmt::format("the scene has {} lights; at most {} are drawn", count, kMaxLights));
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const double length = glm::length(scene.lights[i].direction);
        if (!(length > 0 && std::isfinite(length)))
            return absl::InvalidArgumentError(fmt::format(
                "scene.lights[{}].direction must be three finite numbers, not all 0", i));
    }
    for (std::size_t i = 0; i < scene.pointLights.size(); ++i) {
        const PointLight& light = scene.pointLights[i];
        const std::string field = fmt::format("scene.pointLights[{}]", i);
        if (!(glm::length(light.positionMetres) <= kMaxCoordinateMetres))
            return absl::InvalidArgumentError(
                fmt::format("{}.position must be three finite numbers, at most {} metres away",
                            field, kMaxCoordinateMetres));
        if (!(light.reachMetres >= kLeastReachMetres && light.reachMetres <= kMostReachMetres))
            return absl::InvalidArgumentError(
                fmt::format("{}.reach is {}; it must be from {} to {} metres", field,
                            light.reachMetres, kLeastReachMetres, kMostReachMetres));
        if (light.cone)
            if (absl::Status status = validateCone(*light.cone, field + ".cone"); !status.ok())
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
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        if (object.name.empty() || object.path.empty())
            return absl::InvalidArgumentError(fmt::format("{} lacks its {}", nameOf(object, i),
                                                          object.name.empty() ? "name" : "path"));
        if (absl::Status status = validateTransform(object, i); !status.ok())
            return status;
    }
    return absl::OkStatus();
}

}  // namespace eyrie::fabric
