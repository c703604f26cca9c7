// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/pinhole.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace eyrie::truth {

using fabric::Vec2;
using fabric::Vec3;

Pinhole::Pinhole(const fabric::Camera& camera, int width, int height)
    : eye_(camera.eye),
      forward_(glm::normalize(camera.target - camera.eye)),
      width_(width),
      height_(height) {
    const double focal = height / (2 * std::tan(camera.fovYDegrees * std::numbers::pi / 360));
    const Vec3 right = glm::normalize(glm::cross(forward_, glm::normalize(camera.up)));
    toNextPixel_ = right / focal;
    toNextRow_ = glm::cross(right, forward_) / focal;
    lowerLeft_ = forward_ - width / 2.0 * toNextPixel_ - height / 2.0 * toNextRow_;
}

Pinhole::Pinhole(const Vec3& eye, const Screen& screen, int width, int height)
    : eye_(eye), width_(width), height_(height) {
    const Vec3 across = screen.lowerRight - screen.lowerLeft;
    const Vec3 up = screen.upperLeft - screen.lowerLeft;
    forward_ = -glm::normalize(glm::cross(across, up));
    const double distance = glm::dot(screen.lowerLeft - eye, forward_);
    lowerLeft_ = (screen.lowerLeft - eye) / distance;
    toNextPixel_ = across / (width * distance);
    toNextRow_ = up / (height * distance);
}

Pinhole Pinhole::sampled(const Vec2& origin, const Vec2& step, int width, int height) const {
    Pinhole other = *this;
    other.lowerLeft_ += origin.x * toNextPixel_ + origin.y * toNextRow_;
    other.toNextPixel_ *= step.x;
    other.toNextRow_ *= step.y;
    other.step_ *= step;
    other.width_ = width;
    other.height_ = height;
    return other;
}

Ray Pinhole::rayThrough(double x, double y) const {
    return {eye_, lowerLeft_ + x * toNextPixel_ + y * toNextRow_};
}

std::optional<Vec2> Pinhole::project(const Vec3& world) const {
    const double z = depth(world);
    if (!(z > 0))
        return std::nullopt;
    const Vec3 onScreen = (world - eye_) / z - lowerLeft_;
    return Vec2(glm::dot(onScreen, toNextPixel_) / glm::dot(toNextPixel_, toNextPixel_),
                glm::dot(onScreen, toNextRow_) / glm::dot(toNextRow_, toNextRow_));
}

double Pinhole::depth(const Vec3& world) const { return glm::dot(world - eye_, forward_); }

double Pinhole::pixelsBetween(const Vec2& a, const Vec2& b) const {
    return glm::distance(step_ * a, step_ * b);
}

double Pinhole::focalPixels() const {
    return 1 / std::max(glm::length(toNextPixel_), glm::length(toNextRow_));
}

}  // namespace eyrie::truth
