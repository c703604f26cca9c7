// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/placed_surfaces.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::truth {
namespace {

using fabric::Mat4;
using fabric::Vec3;
using fabric::Vec4;

Vec3 transformed(const Mat4& matrix, const Vec3& point) { return Vec3(matrix * Vec4(point, 1)); }

/// No vector becomes longer by more.
double stretchOf(const Mat4& matrix) {
    return std::sqrt(glm::dot(matrix[0], matrix[0]) + glm::dot(matrix[1], matrix[1]) +
                     glm::dot(matrix[2], matrix[2]));
}

}  // namespace

PlacedSurfaces::PlacedSurfaces(const std::vector<PlacedSurface>& surfaces) {
    for (const PlacedSurface& one : surfaces)
        placed_.push_back({one.surface, one.worldFromObject == Mat4(1.0), one.worldFromObject,
                           glm::inverse(one.worldFromObject)});
}

ReferenceSurface::HitRange PlacedSurfaces::hitRange(const Ray& ray) const {
    return nearest(ray, [](const ReferenceSurface& surface, const Ray& inObject) {
        return surface.hitRange(inObject);
    });
}

ReferenceSurface::HitRange PlacedSurfaces::throughSeams(const Ray& ray, double reach) const {
    return nearest(ray, [&](const ReferenceSurface& surface, const Ray& inObject) {
        const double scale = glm::length(inObject.direction) / glm::length(ray.direction);
        return surface.throughSeams(inObject, reach * scale);
    });
}

template <typename Cast>
ReferenceSurface::HitRange PlacedSurfaces::nearest(const Ray& ray, const Cast& cast) const {
    HitRange nearest;
    for (const Placed& placed : placed_) {
        // Parameters are the same in either space.
        const Ray inObject{transformed(placed.objectFromWorld, ray.origin),
                           Vec3(placed.objectFromWorld * Vec4(ray.direction, 0))};
        const HitRange hit = cast(*placed.surface, placed.isWhereItIs ? ray : inObject);
        nearest.first = std::min(nearest.first, hit.first);
        nearest.last = std::min(nearest.last, hit.last);
    }
    return nearest;
}

bool PlacedSurfaces::endsWithin(const Placed& placed, const Vec3& point, double reach,
                                const std::function<bool(const Vec3&)>& isThere) {
    const double scale = stretchOf(placed.objectFromWorld);
    return placed.surface->endsWithin(
        transformed(placed.objectFromWorld, point), reach * scale, [&](const Vec3& inObject) {
            return isThere(transformed(placed.worldFromObject, inObject));
        });
}

bool PlacedSurfaces::endsWithin(const Vec3& point, double reach,
                                const std::function<bool(const Vec3&)>& isThere) const {
    return std::ranges::any_of(
        placed_, [&](const Placed& placed) { return endsWithin(placed, point, reach, isThere); });
}

bool PlacedSurfaces::isBesideEndOfOne(const Vec3& point, double reach,
                                      const std::function<bool(const Vec3&)>& isThere) const {
    return std::ranges::any_of(placed_, [&](const Placed& placed) {
        return !placed.surface->counterpart(transformed(placed.objectFromWorld, point)) &&
               endsWithin(placed, point, reach, isThere);
    });
}

std::optional<Vec3> PlacedSurfaces::counterpart(const Vec3& point) const {
    std::optional<Vec3> closest;
    for (const Placed& placed : placed_) {
        const auto inObject = placed.surface->counterpart(
            placed.isWhereItIs ? point : transformed(placed.objectFromWorld, point));
        if (!inObject)
            continue;
        const Vec3 other =
            placed.isWhereItIs ? *inObject : transformed(placed.worldFromObject, *inObject);
        if (!closest || glm::distance(other, point) < glm::distance(*closest, point))
            closest = other;
    }
    return closest;
}

Displacement PlacedSurfaces::displacement(const Placed& placed, const Pinhole& camera,
                                          const Vec3& point) {
    if (placed.isWhereItIs)
        return placed.surface->displacement(camera, point);
    const Vec3 inObject = transformed(placed.objectFromWorld, point);
    const auto other = placed.surface->counterpart(inObject);
    const auto p = camera.project(point);
    const auto q =
        other ? camera.project(transformed(placed.worldFromObject, *other)) : std::nullopt;
    if (!p || !q)
        return {};
    return {camera.pixelsBetween(*p, *q), fabric::Vec2(inObject) == fabric::Vec2(*other),
            inObject.z < other->z};
}

Displacement PlacedSurfaces::displacementFrom(std::size_t source, const Pinhole& camera,
                                              const Vec3& point) const {
    return displacement(placed_[source], camera, point);
}

Displacement PlacedSurfaces::displacement(const Pinhole& camera, const Vec3& point) const {
    Displacement least;
    for (const Placed& placed : placed_) {
        const Displacement one = displacement(placed, camera, point);
        if (one.pixels < least.pixels || std::isnan(least.pixels))
            least = one;
    }
    return least;
}

}  // namespace eyrie::truth
