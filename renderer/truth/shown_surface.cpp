// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/shown_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>

#include "fabric/frustum.h"

namespace eyrie::truth {
namespace {

using fabric::Vec2;
using fabric::Vec3;

constexpr int kTilePixels = 8;  ///< a tile's side

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

/// What of a triangle lies before the plane that is `nearMetres` from the eye: a polygon of up to
/// four corners, none where nothing does.
struct Before {
    std::array<Vec3, 4> corners{};
    std::size_t count = 0;
};

Before partBefore(const Triangle& triangle, const Pinhole& camera, double nearMetres) {
    Before part;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = triangle[k];
        const Vec3& to = triangle[(k + 1) % 3];
        const double beyond = camera.depth(from) - nearMetres;
        const double beyondNext = camera.depth(to) - nearMetres;
        if (beyond >= 0)
            part.corners[part.count++] = from;
        if ((beyond < 0) != (beyondNext < 0))
            part.corners[part.count++] = from + beyond / (beyond - beyondNext) * (to - from);
    }
    return part;
}

/// A point of what is drawn, and how far it is from a picture point on the screen, in pixels.
struct Beside {
    Vec3 point{};
    double pixels = std::numeric_limits<double>::infinity();
};

/// The point of `triangle`, which lies before the eye, that is nearest to a picture point on the
/// screen.
Beside nearestShown(const Triangle& triangle, const Pinhole& camera, const Vec2& at) {
    std::array<Vec2, 3> projected;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto p = camera.project(triangle[k]);
        if (!p)
            return {};
        projected[k] = *p;
    }
    const Vec3 weights = nearestWeights(projected, at);
    const Vec2 nearest =
        weights.x * projected[0] + weights.y * projected[1] + weights.z * projected[2];
    // Weights on the screen to weights in space.
    Vec3 inSpace;
    for (int k = 0; k < 3; ++k)
        inSpace[k] = weights[k] / camera.depth(triangle[static_cast<std::size_t>(k)]);
    inSpace /= inSpace.x + inSpace.y + inSpace.z;
    return {inSpace.x * triangle[0] + inSpace.y * triangle[1] + inSpace.z * triangle[2],
            glm::distance(nearest, at)};
}

/// The same of a part of one.
Beside nearestShown(const Before& part, const Pinhole& camera, const Vec2& at) {
    Beside nearest;
    for (std::size_t k = 2; k < part.count; ++k) {
        const Beside found = nearestShown(
            Triangle{part.corners[0], part.corners[k - 1], part.corners[k]}, camera, at);
        if (found.pixels < nearest.pixels)
            nearest = found;
    }
    return nearest;
}

}  // namespace

ShownSurface::ShownSurface(std::span<const Triangle> triangles, const Pinhole& camera)
    : triangles_(triangles),
      camera_(camera),
      columns_((camera.width() - 1) / kTilePixels + 1),
      rows_((camera.height() - 1) / kTilePixels + 1),
      tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
    for (std::size_t i = 0; i < triangles.size(); ++i) add(static_cast<std::uint32_t>(i));
}

/// Picture points outside the picture count to the tiles at its border.
std::size_t ShownSurface::tileOf(double x, double y) const {
    const auto along = [](double pixels, int tiles) {
        return static_cast<std::size_t>(
            std::clamp(std::floor(pixels / kTilePixels), 0.0, static_cast<double>(tiles - 1)));
    };
    return along(y, rows_) * static_cast<std::size_t>(columns_) + along(x, columns_);
}

void ShownSurface::add(std::uint32_t triangle) {
    const Before part = partBefore(triangles_[triangle], camera_, fabric::kNearMetres);
    if (part.count == 0)
        return;
    Vec2 low(std::numeric_limits<double>::infinity());
    Vec2 high(-std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < part.count; ++k)
        if (const auto p = camera_.project(part.corners[k])) {
            low = glm::min(low, *p);
            high = glm::max(high, *p);
        }
    const auto columns = static_cast<std::size_t>(columns_);
    const std::size_t first = tileOf(low.x - kReachPixels, low.y - kReachPixels);
    const std::size_t last = tileOf(high.x + kReachPixels, high.y + kReachPixels);
    for (std::size_t row = first / columns; row <= last / columns; ++row)
        for (std::size_t column = first % columns; column <= last % columns; ++column)
            tiles_[row * columns + column].push_back(triangle);
}

std::optional<ShownSurface::Point> ShownSurface::at(double x, double y, double depth) const {
    std::optional<Point> best;
    double least = std::numeric_limits<double>::infinity();
    const Ray ray = camera_.rayThrough(x, y);
    for (const std::uint32_t index : tiles_[tileOf(x, y)]) {
        const Triangle& triangle = triangles_[index];
        const Beside shown =
            nearestShown(partBefore(triangle, camera_, fabric::kNearMetres), camera_, {x, y});
        if (!(shown.pixels <= kReachPixels))
            continue;
        const Vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
        const double atCentre =
            glm::dot(normal, triangle[0] - ray.origin) / glm::dot(normal, ray.direction);
        if (!best || std::abs(atCentre - depth) < least) {
            best = Point{shown.point, index};
            least = std::abs(atCentre - depth);
        }
    }
    return best;
}

}  // namespace eyrie::truth
