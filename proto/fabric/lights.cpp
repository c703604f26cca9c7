// SPDX-License-Identifier: Apache-2.0
#include "fabric/lights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace eyrie::fabric {
namespace {

double brightnessOf(const Vec3& colour) { return std::max({colour.x, colour.y, colour.z}); }

}  // namespace

Vec3 towardsSun(const Sun& sun) {
    const double azimuth = glm::radians(sun.azimuthDegrees);
    const double elevation = glm::radians(sun.elevationDegrees);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

void append(FileLights& lights, const FileLights& more, const Mat4& worldFromFile) {
    const Mat3 turn(worldFromFile);
    const double scale = std::cbrt(std::abs(glm::determinant(turn)));
    for (const DirectionalLight& light : more.distant)
        lights.distant.push_back({glm::normalize(turn * light.direction), light.colour});
    for (PointLight light : more.points) {
        light.positionMetres = Vec3(worldFromFile * Vec4(light.positionMetres, 1));
        light.reachMetres *= scale;
        if (light.cone)
            light.cone->axis = glm::normalize(turn * light.cone->axis);
        lights.points.push_back(light);
    }
}

void keepBrightest(FileLights& lights, const Vec3& point) {
    if (lights.count() <= kMaxLights)
        return;
    std::vector<double> arriving;
    for (const DirectionalLight& light : lights.distant)
        arriving.push_back(brightnessOf(light.colour));
    for (const PointLight& light : lights.points) {
        const double part = glm::distance(point, light.positionMetres) / light.reachMetres;
        arriving.push_back(brightnessOf(light.colour) / (1 + part * part));
    }
    std::vector<std::size_t> order(arriving.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return arriving[i]; });
    order.resize(kMaxLights);
    std::ranges::sort(order);
    FileLights kept;
    for (const std::size_t i : order)
        if (i < lights.distant.size())
            kept.distant.push_back(lights.distant[i]);
        else
            kept.points.push_back(lights.points[i - lights.distant.size()]);
    lights = std::move(kept);
}

Lights lightsOf(const Scene& scene, const FileLights& ofFiles, const Look& look) {
    const bool isLit = !scene.lights.empty() || !scene.pointLights.empty();
    Lights lights{isLit ? scene.lights : ofFiles.distant,
                  isLit ? scene.pointLights : ofFiles.points, scene.ambient};
    if (!look.sun)
        return lights;
    if (lights.distant.empty())
        lights.distant.emplace_back();
    lights.distant.front().direction = -towardsSun(*look.sun);
    if (lights.points.size() == kMaxLights)
        lights.points.pop_back();
    return lights;
}

}  // namespace eyrie::fabric
