// SPDX-License-Identifier: Apache-2.0
// Intersection: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", 2013, in
// double precision throughout, where their fallback from float is not needed; without culling.
// Closest point: C. Ericson, "Real-Time Collision Detection", 2004, section 5.1.5.
#include "renderer/truth/triangle.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace eyrie::truth {

using fabric::Vec3;

WatertightRay::WatertightRay(const Ray& ray) : origin_(ray.origin) {
    const Vec3& d = ray.direction;
    int z = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(d[axis]) > std::abs(d[z]))
            z = axis;
    int x = (z + 1) % 3;
    int y = (z + 2) % 3;
    axes_ = {x, y, z};
    shear_ = {d[x] / d[z], d[y] / d[z], 1 / d[z]};
}

double WatertightRay::hit(const Triangle& triangle) const {
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 q = triangle[i] - origin_;
        p[i] = {q[axes_[0]] - shear_.x * q[axes_[2]], q[axes_[1]] - shear_.y * q[axes_[2]],
                shear_.z * q[axes_[2]]};
    }
    const double u = p[2].x * p[1].y - p[2].y * p[1].x;
    const double v = p[0].x * p[2].y - p[0].y * p[2].x;
    const double w = p[1].x * p[0].y - p[1].y * p[0].x;
    const bool mixedSigns = (u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0);
    const double determinant = u + v + w;
    if (mixedSigns || determinant == 0)
        return std::numeric_limits<double>::infinity();
    const double t = (u * p[0].z + v * p[1].z + w * p[2].z) / determinant;
    return t >= 0 ? t : std::numeric_limits<double>::infinity();
}

Vec3 closestPoint(const Triangle& triangle, const Vec3& point) {
    const auto& [a, b, c] = triangle;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double d1 = glm::dot(ab, point - a);
    const double d2 = glm::dot(ac, point - a);
    if (d1 <= 0 && d2 <= 0)
        return a;
    const double d3 = glm::dot(ab, point - b);
    const double d4 = glm::dot(ac, point - b);
    if (d3 >= 0 && d4 <= d3)
        return b;
    const double d5 = glm::dot(ab, point - c);
    const double d6 = glm::dot(ac, point - c);
    if (d6 >= 0 && d5 <= d6)
        return c;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return a + ab * (d1 / (d1 - d3));
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return a + ac * (d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    const double sum = va + vb + vc;
    return a + ab * (vb / sum) + ac * (vc / sum);
}

}  // namespace eyrie::truth
