// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "fabric/camera.h"
#include "fabric/sight.h"
#include "tests/renderer/lod/textbook.h"

namespace eyrie::test {

/// A rectangle that is looked through, by three corners.
struct Wall {
    fabric::Vec3 lowerLeft;
    fabric::Vec3 lowerRight;
    fabric::Vec3 upperLeft;
};

/// What an eye sees of a wall, both in a camera's axes (R. Kooima, "Generalized Perspective
/// Projection", 2009).
inline fabric::Sight sightThrough(const Wall& wall, const fabric::Vec3& eye) {
    const fabric::Vec3 right = glm::normalize(wall.lowerRight - wall.lowerLeft);
    const fabric::Vec3 up = glm::normalize(wall.upperLeft - wall.lowerLeft);
    const fabric::Vec3 back = glm::cross(right, up);
    const fabric::Vec3 corner = wall.lowerLeft - eye;
    const double distance = -glm::dot(back, corner);
    const double left = glm::dot(right, corner) / distance;
    const double bottom = glm::dot(up, corner) / distance;
    return {eye,
            glm::transpose(fabric::Mat3(right, up, back)),
            {left, left + glm::length(wall.lowerRight - wall.lowerLeft) / distance, bottom,
             bottom + glm::length(wall.upperLeft - wall.lowerLeft) / distance}};
}

/// About straight ahead of a camera, some metres wide and high, turned by up to 60 degrees about
/// any axis.
inline Wall randomWall(Dice& dice) {
    const double distance = dice.in(1, 3);
    const fabric::Mat3 turned(
        glm::rotate(glm::rotate(fabric::Mat4(1.0), dice.in(0, 1.05),
                                glm::normalize(fabric::Vec3(dice.in(-1, 1), dice.in(-1, 1), 0.01))),
                    dice.in(-0.3, 0.3), fabric::Vec3(0, 0, 1)));
    const fabric::Vec3 right = turned[0] * distance * dice.in(0.1, 0.7);
    const fabric::Vec3 up = turned[1] * distance * dice.in(0.1, 0.7);
    const fabric::Vec3 centre = distance * fabric::Vec3(dice.in(-0.1, 0.1), dice.in(-0.1, 0.1), -1);
    return {centre - right - up, centre + right - up, centre - right + up};
}

/// Beside the camera, before any of the walls above.
inline fabric::Vec3 randomEye(Dice& dice) { return dice.vector(0.1); }

/// A point of a camera's axes in the world.
inline fabric::Vec3 inWorld(const fabric::Camera& camera, const fabric::Vec3& point) {
    const fabric::Vec3 forward = glm::normalize(camera.target - camera.eye);
    const fabric::Vec3 right = glm::normalize(glm::cross(forward, camera.up));
    return camera.eye + point.x * right + point.y * glm::cross(right, forward) - point.z * forward;
}

inline Wall inWorld(const fabric::Camera& camera, const Wall& wall) {
    return {inWorld(camera, wall.lowerLeft), inWorld(camera, wall.lowerRight),
            inWorld(camera, wall.upperLeft)};
}

/// Where a world point falls in a picture that fills a wall in the world: where the line to it from
/// the eye meets the wall. Empty beside or behind the eye.
inline std::optional<fabric::Vec2> project(const fabric::Vec3& eye, const Wall& wall, int width,
                                           int height, const fabric::Vec3& world) {
    const fabric::Vec3 across = wall.lowerRight - wall.lowerLeft;
    const fabric::Vec3 up = wall.upperLeft - wall.lowerLeft;
    const fabric::Vec3 normal = glm::cross(across, up);
    const double share = glm::dot(normal, wall.lowerLeft - eye) / glm::dot(normal, world - eye);
    if (!(share > 0))
        return std::nullopt;
    const fabric::Vec3 onWall = eye + share * (world - eye) - wall.lowerLeft;
    return fabric::Vec2(width * glm::dot(onWall, across) / glm::dot(across, across),
                        height * glm::dot(onWall, up) / glm::dot(up, up));
}

}  // namespace eyrie::test
