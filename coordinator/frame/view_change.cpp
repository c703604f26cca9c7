// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/view_change.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace eyrie::coordinator {
namespace {

constexpr double kLeast = 0.35;     ///< of a cut: 20 degrees, or a third of the way to the target
constexpr double kBeyondUsual = 4;  ///< times the usual change
constexpr double kLatest = 0.5;     ///< share of the latest change in the usual one

double halfHeight(const fabric::Camera& camera) {
    return std::tan(0.5 * camera.fovYDegrees * std::numbers::pi / 180);
}

/// About: turns in radians, ways as the angle they are seen at from the target, and zooms as the
/// logarithm of how much larger things look.
double changeBetween(const fabric::Camera& from, const fabric::Camera& to) {
    const fabric::Vec3 before = from.target - from.eye;
    const fabric::Vec3 after = to.target - to.eye;
    const double cosine = glm::dot(glm::normalize(before), glm::normalize(after));
    return std::acos(std::clamp(cosine, -1.0, 1.0)) +
           glm::length(to.eye - from.eye) / std::max(glm::length(before), glm::length(after)) +
           std::abs(std::log(halfHeight(to) / halfHeight(from)));
}

}  // namespace

bool ViewChange::isCut(const fabric::Camera& camera) const {
    if (!last_)
        return true;
    const double change = changeBetween(*last_, camera);
    return change > kLeast && change > kBeyondUsual * usual_;
}

void ViewChange::follow(const fabric::Camera& camera) {
    if (last_)
        usual_ += kLatest * (changeBetween(*last_, camera) - usual_);
    last_ = camera;
}

}  // namespace eyrie::coordinator
