// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <random>

#include <glm/geometric.hpp>

#include "fabric/camera.h"

namespace eyrie::test {

/// Where a world point falls in the picture, by the textbook and independent of the code under
/// test; empty behind the eye.
inline std::optional<fabric::Vec2> project(const fabric::Camera& camera, int width, int height,
                                           const fabric::Vec3& world) {
    const fabric::Vec3 forward = glm::normalize(camera.target - camera.eye);
    const fabric::Vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const fabric::Vec3 up = glm::cross(right, forward);
    const fabric::Vec3 d = world - camera.eye;
    const double depth = glm::dot(d, forward);
    if (depth <= 0)
        return std::nullopt;
    const double focal = height / (2 * std::tan(camera.fovYDegrees * M_PI / 360));
    return fabric::Vec2(width / 2.0 + focal * glm::dot(d, right) / depth,
                        height / 2.0 + focal * glm::dot(d, up) / depth);
}

inline bool inPicture(const std::optional<fabric::Vec2>& p, int width, int height) {
    return p && p->x >= 0 && p->x <= width && p->y >= 0 && p->y <= height;
}

/// Random numbers from one seed, so that RapidCheck shrinks and prints just that.
class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double in(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    fabric::Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
    fabric::Vec3 direction() {
        fabric::Vec3 v = vector(1);
        while (glm::length(v) < 0.1) v = vector(1);
        return glm::normalize(v);
    }

private:
    std::mt19937 engine_;
};

}  // namespace eyrie::test
