// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// The lights that a data file brings along, in its own space.
struct FileLights {
    std::vector<DirectionalLight> distant;
    std::vector<PointLight> points;

    std::size_t count() const { return distant.size() + points.size(); }
    bool operator==(const FileLights&) const = default;
};

/// Adds `more`, placed by the affine, not singular `worldFromFile`: where it scales unevenly, a
/// reach grows by the cube root of what a volume does, and a cone keeps its angles.
void append(FileLights& lights, const FileLights& more, const Mat4& worldFromFile = Mat4(1.0));

/// Leaves the kMaxLights that are brightest at a point, in their order; spots as if they shone
/// there.
void keepBrightest(FileLights& lights, const Vec3& point);

/// World axes, unit: towards the sun, which stands in the north (y) at azimuth 0, in the east (x)
/// at 90, and overhead at elevation 90.
Vec3 towardsSun(const Sun& sun);

/// The scene's lights, or, where it has none, those of its files (world axes, at most kMaxLights).
/// With the sun of the look where it has one: the first distant light shines from there. Without a
/// distant light there is a white one then, in place of the last point light where there are
/// kMaxLights of them.
Lights lightsOf(const Scene& scene, const FileLights& ofFiles, const Look& look);

}  // namespace eyrie::fabric
