// SPDX-License-Identifier: Apache-2.0
#include "fabric/camera.h"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace eyrie::fabric {
namespace {

bool isWithin(const Vec3& v, double limit) {
    return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
}

/// Whether it can be normalised: shorter ones have squares that are zero, or of a few bits. Where
/// coordinates are large, points are the same before they are so near.
bool hasDirection(const Vec3& v) { return glm::dot(v, v) >= std::numeric_limits<double>::min(); }

absl::Status invalid(std::string_view field, std::string_view found, std::string_view expected) {
    return absl::InvalidArgumentError(
        fmt::format("camera.{} is {}; it must be {}", field, found, expected));
}

}  // namespace

absl::Status validate(const Camera& camera) {
    const std::string inWorld = fmt::format("three numbers (world metres) from {0:g} to {1:g}",
                                            -kMaxCoordinateMetres, kMaxCoordinateMetres);
    if (!isWithin(camera.eye, kMaxCoordinateMetres))
        return invalid("eye", "out of range", inWorld);
    if (!isWithin(camera.target, kMaxCoordinateMetres))
        return invalid("target", "out of range", inWorld);
    if (!isWithin(camera.up, kMaxCoordinateMetres))
        return invalid("up", "out of range", "a direction, such as [0,0,1]");
    if (!(camera.fovYDegrees >= kMinFovYDegrees && camera.fovYDegrees <= kMaxFovYDegrees))
        return invalid("fovyDegrees", fmt::format("{}", camera.fovYDegrees),
                       fmt::format("from {} to {}", kMinFovYDegrees, kMaxFovYDegrees));
    const Vec3 forward = camera.target - camera.eye;
    if (!hasDirection(forward))
        return invalid("target", "equal to camera.eye, or too near to it to give a direction",
                       "another point, farther away");
    if (!hasDirection(camera.up))
        return invalid("up", "zero, or too short to give a direction",
                       "a direction, such as [0,0,1]");
    const double sine = glm::length(glm::cross(glm::normalize(forward), glm::normalize(camera.up)));
    if (!(sine > 1e-9))
        return invalid("up", "parallel to the view direction", "another direction");
    return absl::OkStatus();
}

Mat3 viewFromWorldRotation(const Camera& camera) {
    const Vec3 forward = glm::normalize(camera.target - camera.eye);
    const Vec3 right = glm::normalize(glm::cross(forward, glm::normalize(camera.up)));
    const Vec3 up = glm::cross(right, forward);
    // glm takes columns; the rows of this rotation are right, up and -forward.
    return Mat3(right.x, up.x, -forward.x, right.y, up.y, -forward.y, right.z, up.z, -forward.z);
}

}  // namespace eyrie::fabric
