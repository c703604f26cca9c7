// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/terrain_cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eyrie::truth {

using fabric::Camera;
using fabric::Vec3;

Camera TerrainCameras::make(Kind kind) {
    const double extent = std::hypot(bounds_.size().x, bounds_.size().y);
    // Drawn one after the other: the order in which arguments are evaluated is not fixed.
    switch (kind) {
        case Kind::Overview: {
            const double distance = in(0.8, 1.6) * extent;
            return around(distance, in(0.3, 1.2));
        }
        case Kind::Mid: {
            const double distance = in(0.1, 0.4) * extent;
            return around(distance, in(0.2, 1.0));
        }
        case Kind::Close: {
            const double height = in(30, 300);
            return above(height, in(-0.9, -0.25));
        }
        case Kind::Grazing:
            break;
    }
    const double height = in(2, 15);
    return above(height, in(-0.06, 0.02));
}

/// A point of the ground, at a distance from the terrain's edge.
Vec3 TerrainCameras::groundPoint() {
    for (;;) {
        const double x = bounds_.min.x + bounds_.size().x * in(0.15, 0.85);
        const double y = bounds_.min.y + bounds_.size().y * in(0.15, 0.85);
        const auto heights = ground_.heightsAt(x, y);
        if (std::isfinite(heights[0]))
            return {x, y, *std::max_element(heights.begin(), heights.end())};
    }
}

Camera TerrainCameras::around(double distance, double elevation) {
    Camera camera;
    camera.target = groundPoint();
    const double azimuth = in(0, 2 * std::numbers::pi);
    camera.eye = camera.target + distance * Vec3(std::cos(azimuth) * std::cos(elevation),
                                                 std::sin(azimuth) * std::cos(elevation),
                                                 std::sin(elevation));
    const auto heights = ground_.heightsAt(camera.eye.x, camera.eye.y);
    if (std::isfinite(heights[0]))
        camera.eye.z = std::max(camera.eye.z, heights[0] + 50);
    camera.fovYDegrees = in(30, 70);
    return camera;
}

Camera TerrainCameras::above(double height, double pitch) {
    Camera camera;
    camera.eye = groundPoint() + Vec3(0, 0, height);
    const double azimuth = in(0, 2 * std::numbers::pi);
    camera.target =
        camera.eye + 100.0 * Vec3(std::cos(azimuth), std::sin(azimuth), std::tan(pitch));
    camera.fovYDegrees = in(30, 70);
    return camera;
}

}  // namespace eyrie::truth
