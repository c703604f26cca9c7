// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/pinhole.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace eyrie::truth {

using fabric::Vec2;
using fabric::Vec3;

Pinhole::Pinhole(const fabric::Camera& camera, int width, int height)
    : eye_(camera.eye),
      forward_(glm::normalize(camera.target - camera.eye)),
      focal_(height / (2 * std::tan(camera.fovYDegrees * std::numbers::pi / 360))),
      width_(width),
      height_(height) {
    right_ = glm::normalize(glm::cross(forward_, glm::normalize(camera.up)));
    up_ = glm::cross(right_, forward_);
}

Ray Pinhole::rayThrough(double x, double y) const {
    return {eye_, forward_ + right_ * ((x - width_ / 2.0) / focal_) +
                      up_ * ((y - height_ / 2.0) / focal_)};
}

std::optional<Vec2> Pinhole::project(const Vec3& world) const {
    const double z = depth(world);
    if (!(z > 0))
        return std::nullopt;
    const Vec3 d = world - eye_;
    return Vec2(width_ / 2.0 + focal_ * glm::dot(d, right_) / z,
                height_ / 2.0 + focal_ * glm::dot(d, up_) / z);
}

double Pinhole::depth(const Vec3& world) const { return glm::dot(world - eye_, forward_); }

}  // namespace eyrie::truth
