// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/drawn_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>

namespace eyrie::truth {
namespace {

using fabric::Vec2;
using fabric::Vec3;

/// Weights of the point of a plane triangle that is nearest to `point`.
Vec3 nearestWeights(const std::array<Vec2, 3>& corners, const Vec2& point) {
    const auto cross = [](const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vec3 inside = Vec3(cross(corners[1] - point, corners[2] - point),
                             cross(corners[2] - point, corners[0] - point),
                             cross(corners[0] - point, corners[1] - point)) /
                        area;
    if (area != 0 && inside.x >= 0 && inside.y >= 0 && inside.z >= 0)
        return inside;
    Vec3 best(0);
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec2 a = corners[static_cast<std::size_t>(k)];
        const Vec2 side = corners[static_cast<std::size_t>((k + 1) % 3)] - a;
        const double length = glm::dot(side, side);
        const double t =
            length > 0 ? std::clamp(glm::dot(point - a, side) / length, 0.0, 1.0) : 0.0;
        if (const double distance = glm::distance(point, a + t * side); distance < least) {
            least = distance;
            best = Vec3(0);
            best[k] = 1 - t;
            best[(k + 1) % 3] = t;
        }
    }
    return best;
}

}  // namespace

std::optional<ShownPlace> shownAt(std::span<const Triangle> triangles, const Pinhole& camera,
                                  double x, double y, double depth, double reachPixels) {
    std::optional<ShownPlace> best;
    const Ray ray = camera.rayThrough(x, y);
    for (const Triangle& triangle : triangles) {
        std::array<Vec2, 3> projected;
        bool isBefore = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto p = camera.project(triangle[k]);
            isBefore = isBefore && p;
            projected[k] = p.value_or(Vec2(0));
        }
        if (!isBefore)
            continue;  // reaches behind the eye: never edge-on and far away
        const Vec3 weights = nearestWeights(projected, {x, y});
        const Vec2 nearest =
            weights.x * projected[0] + weights.y * projected[1] + weights.z * projected[2];
        const double aside = glm::distance(nearest, {x, y});
        if (!(aside <= reachPixels))
            continue;
        const Vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const double atCentre =
            glm::dot(normal, triangle[0] - ray.origin) / glm::dot(normal, ray.direction);
        if (best && !(std::abs(atCentre - depth) < std::abs(best->depthAtPoint - depth)))
            continue;
        // Weights on the screen to weights in space.
        Vec3 inSpace;
        for (int k = 0; k < 3; ++k)
            inSpace[k] = weights[k] / camera.depth(triangle[static_cast<std::size_t>(k)]);
        inSpace /= inSpace.x + inSpace.y + inSpace.z;
        best = {inSpace.x * triangle[0] + inSpace.y * triangle[1] + inSpace.z * triangle[2],
                atCentre};
    }
    return best;
}

}  // namespace eyrie::truth
