// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/screen.h"

#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace eyrie::config {
namespace {

using fabric::Mat4;
using fabric::Vec3;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// Along its lower side, up, and towards the viewer; at right angles however its corners are
/// rounded.
std::array<Vec3, 3> axesOf(const Wall& wall) {
    const Vec3 across = glm::normalize(wall.bottomRight - wall.bottomLeft);
    const Vec3 side = wall.topLeft - wall.bottomLeft;
    const Vec3 upward = glm::normalize(side - glm::dot(side, across) * across);
    return {across, upward, glm::cross(across, upward)};
}

/// On the same lower side, in the same plane, and as high.
Wall squared(const Wall& wall) {
    Wall square = wall;
    square.topLeft =
        wall.bottomLeft + glm::length(wall.topLeft - wall.bottomLeft) * axesOf(wall)[1];
    return square;
}

}  // namespace

double skewOf(const Wall& wall) {
    return glm::dot(glm::normalize(wall.bottomRight - wall.bottomLeft),
                    glm::normalize(wall.topLeft - wall.bottomLeft));
}

Wall wallOf(const Projection& projection) {
    const Vec3& hpr = projection.headingPitchRollDegrees;
    Mat4 turned(1.0);
    turned = glm::rotate(turned, radians(hpr.x), Vec3(0, 1, 0));  // to the left
    turned = glm::rotate(turned, radians(hpr.y), Vec3(1, 0, 0));  // up
    turned = glm::rotate(turned, radians(hpr.z), Vec3(0, 0, 1));  // counter-clockwise
    const double halfWidth = projection.distance * std::tan(radians(projection.fovDegrees.x) / 2);
    const double halfHeight = projection.distance * std::tan(radians(projection.fovDegrees.y) / 2);
    const auto corner = [&](double x, double y) {
        return projection.origin + Vec3(turned * fabric::Vec4(x, y, -projection.distance, 0));
    };
    return {corner(-halfWidth, -halfHeight), corner(halfWidth, -halfHeight),
            corner(-halfWidth, halfHeight), false};
}

std::optional<Wall> wallOf(const Surface& surface) {
    if (const auto* wall = std::get_if<Wall>(&surface))
        return std::abs(skewOf(*wall)) > kRoundedSkew ? squared(*wall) : *wall;
    if (const auto* projection = std::get_if<Projection>(&surface))
        return wallOf(*projection);
    return std::nullopt;
}

Wall part(const Wall& wall, const Viewport& fraction) {
    const Vec3 across = wall.bottomRight - wall.bottomLeft;
    const Vec3 upward = wall.topLeft - wall.bottomLeft;
    const auto corner = [&](double x, double y) {
        return wall.bottomLeft + x * across + y * upward;
    };
    const double right = fraction.x + fraction.width;
    const double top = fraction.y + fraction.height;
    return {corner(fraction.x, fraction.y), corner(right, fraction.y), corner(fraction.x, top),
            wall.movesWithHead};
}

Wall widened(const Wall& wall, double by) { return part(wall, Viewport{(1 - by) / 2, 0, by, 1}); }

Wall scaled(const Wall& wall, const Vec3& from, double by) {
    const auto corner = [&](const Vec3& each) { return from + by * (each - from); };
    return {corner(wall.bottomLeft), corner(wall.bottomRight), corner(wall.topLeft),
            wall.movesWithHead};
}

Wall moved(const Wall& wall, const Mat4& roomFromHead) {
    const auto corner = [&](const Vec3& each) {
        return Vec3(roomFromHead * fabric::Vec4(each, 1));
    };
    return {corner(wall.bottomLeft), corner(wall.bottomRight), corner(wall.topLeft),
            wall.movesWithHead};
}

double distanceAlong(const Wall& wall, const Vec3& from, const Vec3& direction) {
    const Vec3 normal = axesOf(wall)[2];
    const double towards = -glm::dot(direction, normal);
    return towards > 0 ? glm::dot(from - wall.bottomLeft, normal) / towards : 0;
}

std::optional<fabric::Sight> sightThrough(const Wall& wall, const Vec3& eye) {
    const auto [across, upward, towardsViewer] = axesOf(wall);
    const Vec3 corner = wall.bottomLeft - eye;
    const double distance = -glm::dot(corner, towardsViewer);
    if (!(distance > 0))
        return std::nullopt;
    const double left = glm::dot(corner, across) / distance;
    const double bottom = glm::dot(corner, upward) / distance;
    fabric::Sight sight;
    sight.eye = eye;
    sight.viewFromCamera = glm::transpose(fabric::Mat3(across, upward, towardsViewer));
    sight.frustum = {left, left + glm::length(wall.bottomRight - wall.bottomLeft) / distance,
                     bottom, bottom + glm::length(wall.topLeft - wall.bottomLeft) / distance};
    return sight;
}

}  // namespace eyrie::config
