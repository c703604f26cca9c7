// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "fabric/look.h"
#include "fabric/scene.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// What a scene is lit by; at most kMaxLights together. None of either kind: one at the camera.
struct Lights {
    std::vector<DirectionalLight> distant;  ///< the first is the key light
    std::vector<PointLight> points;
    double ambient = 0.25;

    bool operator==(const Lights&) const = default;
};

/// World axes, unit: towards the sun, which stands in the north (y) at azimuth 0, in the east (x)
/// at 90, and overhead at elevation 90.
Vec3 towardsSun(const Sun& sun);

/// The scene's lights, with the sun of the look where it has one: the first distant light shines
/// from there. A scene without one gets a white one, in place of its last point light where it has
/// kMaxLights of them.
Lights lightsOf(const Scene& scene, const Look& look);

}  // namespace eyrie::fabric
