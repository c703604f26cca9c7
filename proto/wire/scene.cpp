// SPDX-License-Identifier: Apache-2.0
#include "wire/scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "eyrie/v1/scene.pb.h"
#include "fabric/shown_name.h"
#include "fabric/status.h"
#include "wire/numbers.h"

namespace eyrie::wire {
namespace {

fabric::Vec3 perChannel(const fabric::Vec3& colour, double (*convert)(double)) {
    return {convert(colour.x), convert(colour.y), convert(colour.z)};
}

std::uint8_t toByte(double fraction) {
    return static_cast<std::uint8_t>(std::lround(fraction * 255));
}

absl::StatusOr<fabric::Mat4> matrixFrom(const v1::Transform& message, const std::string& field) {
    if (message.translation_size() != 0 || message.axis_degrees_size() != 0 || message.has_scale())
        return absl::InvalidArgumentError(fmt::format(
            "{} has a matrix besides translation, axisDegrees or scale; give one or the other",
            field));
    RETURN_IF_ERROR(checkNumbers(message.matrix(), 16, field + ".matrix"));
    fabric::Mat4 matrix;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = message.matrix(4 * row + column);
    return matrix;
}

absl::StatusOr<fabric::Mat4> rotationFrom(const Numbers& axisDegrees, const std::string& field) {
    if (axisDegrees.empty())
        return fabric::Mat4(1.0);
    RETURN_IF_ERROR(checkNumbers(axisDegrees, 4, field));
    const fabric::Vec3 axis(axisDegrees[0], axisDegrees[1], axisDegrees[2]);
    const double length = glm::length(axis);
    if (!(length > 0 && std::isfinite(length)))
        return absl::InvalidArgumentError(
            fmt::format("{} has no axis: its first three numbers are a direction", field));
    return glm::rotate(fabric::Mat4(1.0), glm::radians(axisDegrees[3]), axis / length);
}

absl::StatusOr<fabric::Mat4> transformFrom(const v1::Transform& message, const std::string& field) {
    if (message.matrix_size() != 0)
        return matrixFrom(message, field);
    ASSIGN_OR_RETURN(
        const fabric::Vec3 translation,
        threeNumbersOr(message.translation(), fabric::Vec3(0.0), field + ".translation"));
    ASSIGN_OR_RETURN(const fabric::Mat4 rotation,
                     rotationFrom(message.axis_degrees(), field + ".axisDegrees"));
    const double scale = message.has_scale() ? message.scale() : 1;
    if (!std::isfinite(scale) || scale == 0)
        return absl::InvalidArgumentError(
            fmt::format("{}.scale is {}; it must be finite and not 0", field, scale));
    return glm::translate(fabric::Mat4(1.0), translation) * rotation *
           glm::scale(fabric::Mat4(1.0), fabric::Vec3(scale));
}

absl::StatusOr<fabric::SceneObject> objectFrom(const v1::SceneObject& message, int index) {
    const std::string field = fmt::format("objects[{}]", index);
    fabric::SceneObject object;
    object.kind = message.has_terrain() ? fabric::ObjectKind::Terrain : fabric::ObjectKind::Mesh;
    object.path = message.has_terrain() ? message.terrain() : message.mesh();
    if (object.path.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}{} has no data; give it a \"terrain\" or a \"mesh\" file", field,
                        message.name().empty() ? "" : " '" + message.name() + "'"));
    object.name = message.name().empty()
                      ? std::filesystem::path(fabric::shownName(object.path)).filename().string()
                      : message.name();
    if (object.name.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: the path {} ends in a folder, not a file", field, object.path));
    ASSIGN_OR_RETURN(object.worldFromObject,
                     transformFrom(message.transform(), field + ".transform"));
    if (message.colour_size() != 0) {
        ASSIGN_OR_RETURN(const fabric::Vec3 colour,
                         colourFrom(message.colour(), field + ".colour"));
        object.colour = perChannel(colour, linearFromSrgb);
    }
    object.singleSided = message.single_sided();
    if (object.singleSided && object.kind != fabric::ObjectKind::Mesh)
        return absl::InvalidArgumentError(
            fmt::format("{}.singleSided is for meshes; leave it out of a terrain", field));
    object.imagery.assign(message.imagery().begin(), message.imagery().end());
    if (!object.imagery.empty() && object.kind != fabric::ObjectKind::Terrain)
        return absl::InvalidArgumentError(
            fmt::format("{}.imagery is for terrains; leave it out of a mesh", field));
    return object;
}

/// Of a light, white where it is absent.
template <typename Numbers>
absl::StatusOr<fabric::Vec3> lightColour(const Numbers& numbers, const std::string& field) {
    ASSIGN_OR_RETURN(const fabric::Vec3 colour, threeNumbersOr(numbers, fabric::Vec3(1), field));
    for (int i = 0; i < 3; ++i)
        if (colour[i] < 0)
            return absl::InvalidArgumentError(
                fmt::format("{}[{}] is {}; it must be 0 or more", field, i, colour[i]));
    return colour;
}

absl::StatusOr<fabric::DirectionalLight> lightFrom(const v1::DirectionalLight& message, int index) {
    const std::string field = fmt::format("lights[{}]", index);
    fabric::DirectionalLight light;
    ASSIGN_OR_RETURN(light.direction, threeNumbers(message.direction(), field + ".direction"));
    ASSIGN_OR_RETURN(light.colour, lightColour(message.colour(), field + ".colour"));
    return light;
}

absl::StatusOr<fabric::LightCone> coneFrom(const v1::LightCone& message, const std::string& field) {
    fabric::LightCone cone;
    ASSIGN_OR_RETURN(cone.axis, threeNumbers(message.axis(), field + ".axis"));
    cone.innerDegrees = message.inner_degrees();
    if (message.has_outer_degrees())
        cone.outerDegrees = message.outer_degrees();
    return cone;
}

absl::StatusOr<fabric::PointLight> lightFrom(const v1::PointLight& message, int index) {
    const std::string field = fmt::format("pointLights[{}]", index);
    fabric::PointLight light;
    ASSIGN_OR_RETURN(light.positionMetres, threeNumbers(message.position(), field + ".position"));
    ASSIGN_OR_RETURN(light.colour, lightColour(message.colour(), field + ".colour"));
    light.reachMetres = message.reach();
    if (message.has_cone()) {
        ASSIGN_OR_RETURN(light.cone, coneFrom(message.cone(), field + ".cone"));
    }
    return light;
}

void setTransform(const fabric::Mat4& matrix, v1::SceneObject& message) {
    if (matrix == fabric::Mat4(1.0))
        return;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            message.mutable_transform()->add_matrix(matrix[column][row]);
}

void setObject(const fabric::SceneObject& object, v1::SceneObject& message) {
    message.set_name(object.name);
    if (object.kind == fabric::ObjectKind::Terrain)
        message.set_terrain(object.path);
    else
        message.set_mesh(object.path);
    setTransform(object.worldFromObject, message);
    setNumbers(perChannel(object.colour, srgbFromLinear), *message.mutable_colour());
    message.set_single_sided(object.singleSided);
    message.mutable_imagery()->Assign(object.imagery.begin(), object.imagery.end());
}

}  // namespace

double linearFromSrgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgbFromLinear(double linear) {
    const double value = std::clamp(linear, 0.0, 1.0);
    return value <= 0.0031308 ? value * 12.92 : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

v1::Scene toMessage(const fabric::Scene& scene) {
    v1::Scene message;
    for (const fabric::SceneObject& object : scene.objects)
        setObject(object, *message.add_objects());
    for (const fabric::DirectionalLight& light : scene.lights) {
        v1::DirectionalLight& lightMessage = *message.add_lights();
        setNumbers(light.direction, *lightMessage.mutable_direction());
        setNumbers(light.colour, *lightMessage.mutable_colour());
    }
    for (const fabric::PointLight& light : scene.pointLights) {
        v1::PointLight& lightMessage = *message.add_point_lights();
        setNumbers(light.positionMetres, *lightMessage.mutable_position());
        setNumbers(light.colour, *lightMessage.mutable_colour());
        lightMessage.set_reach(light.reachMetres);
        if (!light.cone)
            continue;
        setNumbers(light.cone->axis, *lightMessage.mutable_cone()->mutable_axis());
        lightMessage.mutable_cone()->set_inner_degrees(light.cone->innerDegrees);
        lightMessage.mutable_cone()->set_outer_degrees(light.cone->outerDegrees);
    }
    message.set_ambient(scene.ambient);
    const fabric::Rgba& background = scene.background;
    setNumbers(fabric::Vec3(background.r, background.g, background.b) / 255.0,
               *message.mutable_background());
    return message;
}

absl::StatusOr<fabric::Scene> fromMessage(const v1::Scene& message) {
    fabric::Scene scene;
    for (int i = 0; i < message.objects_size(); ++i) {
        ASSIGN_OR_RETURN(fabric::SceneObject object, objectFrom(message.objects(i), i));
        scene.objects.push_back(std::move(object));
    }
    for (int i = 0; i < message.lights_size(); ++i) {
        ASSIGN_OR_RETURN(const fabric::DirectionalLight light, lightFrom(message.lights(i), i));
        scene.lights.push_back(light);
    }
    for (int i = 0; i < message.point_lights_size(); ++i) {
        ASSIGN_OR_RETURN(const fabric::PointLight light, lightFrom(message.point_lights(i), i));
        scene.pointLights.push_back(light);
    }
    if (message.has_ambient())
        scene.ambient = message.ambient();
    if (message.background_size() != 0) {
        ASSIGN_OR_RETURN(const fabric::Vec3 colour, colourFrom(message.background(), "background"));
        scene.background = {toByte(colour.x), toByte(colour.y), toByte(colour.z), 255};
    }
    RETURN_IF_ERROR(fabric::validate(scene));
    return scene;
}

}  // namespace eyrie::wire
