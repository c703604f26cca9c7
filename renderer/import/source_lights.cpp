// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/source_lights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "fabric/box.h"
#include "fabric/camera.h"

namespace eyrie::import {
namespace {

constexpr double kBlack = 1e-12;  ///< what is darker, of the brightest

double brightnessOf(const fabric::Vec3& colour) { return std::max({colour.x, colour.y, colour.z}); }

bool isSound(const SourceLight& light) {
    const double away = glm::length(light.place);
    const bool isPlaced = away <= fabric::kMaxCoordinateMetres &&
                          (light.kind == SourceLight::Kind::Point || away > 0);
    const auto isPart = [](double value) { return value >= 0 && std::isfinite(value); };
    if (light.cone) {
        const double length = glm::length(light.cone->axis);
        const double outer = light.cone->outerDegrees;
        if (!(length > 0 && std::isfinite(length) && outer > 0 && outer <= 90 &&
              light.cone->innerDegrees >= 0 && light.cone->innerDegrees <= outer))
            return false;
    }
    return isPlaced && isPart(light.colour.x) && isPart(light.colour.y) && isPart(light.colour.z) &&
           isPart(light.constant) && isPart(light.linear) && isPart(light.quadratic);
}

/// Colour and reach of one at a place; `scale` is what all are darker by.
fabric::PointLight pointLight(const SourceLight& light, double scale) {
    const double constant = light.constant > 0 ? light.constant : 1;
    fabric::Vec3 colour = light.colour * (scale / constant);
    double reach = fabric::kMostReachMetres;  // it arrives everywhere alike
    if (light.quadratic > 0)
        reach = std::sqrt(constant / light.quadratic);
    else if (light.linear > 0)
        reach = constant / light.linear;
    const double brightness = brightnessOf(colour);
    const bool isEndless = light.constant == 0 && light.quadratic > 0;  // where it is
    if (isEndless || brightness > 1) {
        colour /= brightness;
        reach *= std::sqrt(brightness);  // as bright far away: colour * reach^2 stays
    }
    return {light.place, colour,
            std::clamp(reach, fabric::kLeastReachMetres, fabric::kMostReachMetres), light.cone};
}

}  // namespace

fabric::FileLights lightsFrom(std::span<const SourceLight> lights,
                              std::vector<std::string>& notes) {
    double brightest = 1;
    for (const SourceLight& light : lights)
        if (light.kind == SourceLight::Kind::Distant && isSound(light))
            brightest = std::max(brightest, brightnessOf(light.colour));
    fabric::FileLights result;
    std::size_t unsound = 0;
    for (const SourceLight& light : lights) {
        if (!isSound(light))
            ++unsound;
        else if (brightnessOf(light.colour) < kBlack * brightest)
            continue;
        else if (light.kind == SourceLight::Kind::Distant)
            result.distant.push_back({glm::normalize(light.place), light.colour / brightest});
        else
            result.points.push_back(pointLight(light, 1 / brightest));
    }
    if (unsound > 0)
        notes.push_back(
            fmt::format("left out {} of {} lights, whose numbers make no light: export them again",
                        unsound, lights.size()));
    return result;
}

void limitLights(TriangleMesh& mesh) {
    const std::size_t count = mesh.lights.count();
    if (count <= fabric::kMaxLights)
        return;
    fabric::Box box;
    for (const fabric::Vec3& position : mesh.positions) box.grow(position);
    fabric::keepBrightest(mesh.lights, box.centre());
    mesh.notes.push_back(
        fmt::format("left out {} of {} lights, and kept those that are brightest in the middle",
                    count - mesh.lights.count(), count));
}

}  // namespace eyrie::import
