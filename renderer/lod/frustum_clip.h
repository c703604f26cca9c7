// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include <glm/geometric.hpp>

#include "fabric/box.h"
#include "fabric/frustum.h"

/// What the bounds of this folder clip against a frustum. Coordinates are (x, y, depth) in view
/// space, depth growing away from the eye.
namespace eyrie::lod {

/// A convex polygon; a quadrilateral cut by four planes has at most eight corners.
struct Polygon {
    std::array<fabric::Vec3, 12> corners;
    int count = 0;

    void add(const fabric::Vec3& corner) { corners[static_cast<std::size_t>(count++)] = corner; }
    const fabric::Vec3* begin() const { return corners.data(); }
    const fabric::Vec3* end() const { return corners.data() + count; }
};

using Corners = std::array<fabric::Vec3, 8>;

inline fabric::Vec3 viewPoint(const fabric::Vec3& point, const fabric::Mat4& viewFromObject) {
    const fabric::Vec3 p(viewFromObject * fabric::Vec4(point, 1.0));
    return {p.x, p.y, -p.z};
}

inline Corners viewCorners(const fabric::Box& bounds, const fabric::Mat4& viewFromObject) {
    Corners corners;
    for (int i = 0; i < 8; ++i)
        corners[static_cast<std::size_t>(i)] = viewPoint(bounds.corner(i), viewFromObject);
    return corners;
}

/// A box's faces by fabric::Box::corner.
inline constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

/// The half-space normal . p + offset >= 0.
struct Plane {
    fabric::Vec3 normal;
    double offset = 0;

    double operator()(const fabric::Vec3& p) const { return glm::dot(normal, p) + offset; }
};

/// The four sides of a frustum: planes through the eye, inward.
inline std::array<Plane, 4> sidePlanes(const fabric::Frustum& f) {
    return {Plane{{1, 0, -f.left}}, Plane{{-1, 0, f.right}}, Plane{{0, 1, -f.bottom}},
            Plane{{0, -1, f.top}}};
}

/// Sutherland and Hodgman 1974, one plane.
inline Polygon clip(const Polygon& polygon, const Plane& plane) {
    Polygon result;
    for (int i = 0; i < polygon.count; ++i) {
        const fabric::Vec3& a = polygon.corners[static_cast<std::size_t>(i)];
        const fabric::Vec3& b = polygon.corners[static_cast<std::size_t>((i + 1) % polygon.count)];
        const double da = plane(a);
        const double db = plane(b);
        if (da >= 0)
            result.add(a);
        if ((da >= 0) != (db >= 0))
            result.add(a + (b - a) * (da / (da - db)));
    }
    return result;
}

}  // namespace eyrie::lod
