// SPDX-License-Identifier: Apache-2.0
#include "fabric/lights.h"

#include <cmath>

#include <glm/trigonometric.hpp>

namespace eyrie::fabric {

Vec3 towardsSun(const Sun& sun) {
    const double azimuth = glm::radians(sun.azimuthDegrees);
    const double elevation = glm::radians(sun.elevationDegrees);
    return {std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

Lights lightsOf(const Scene& scene, const Look& look) {
    Lights lights{scene.lights, scene.pointLights, scene.ambient};
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
