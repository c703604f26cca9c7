// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/home_camera.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace eyrie::stream {
namespace {

constexpr double kAspect = 4.0 / 3.0;
constexpr double kMargin = 1.04;

/// From the target to the eye.
fabric::Vec3 viewingDirection(const fabric::Vec3& size) {
    const bool isFlat = size.z < std::max(size.x, size.y) / 3;
    const double elevation = glm::radians(isFlat ? 30.0 : 20.0);
    const double southWest = -std::sqrt(0.5) * std::cos(elevation);
    return {southWest, southWest, std::sin(elevation)};
}

}  // namespace

fabric::Camera homeCamera(const fabric::Box& bounds) {
    fabric::Camera camera;
    camera.target = bounds.centre();
    const fabric::Vec3 back = viewingDirection(bounds.size());
    camera.eye = camera.target + back;
    const fabric::Mat3 viewFromWorld = fabric::viewFromWorldRotation(camera);
    const double tanVertical = std::tan(glm::radians(camera.fovYDegrees / 2));
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const fabric::Vec3 corner = viewFromWorld * (bounds.corner(i) - camera.target);
        const double across = std::abs(corner.x) / (tanVertical * kAspect);
        const double upwards = std::abs(corner.y) / tanVertical;
        distance = std::max(distance, std::max(across, upwards) + corner.z);
    }
    // A scene of a single point still needs an eye beside it; far from the origin a metre is lost
    // in the rounding of the coordinates.
    const double smallest = 1e-6 * std::max(1.0, glm::length(camera.target));
    camera.eye = camera.target + back * std::max(distance * kMargin, smallest);
    return camera;
}

}  // namespace eyrie::stream
