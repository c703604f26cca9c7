// SPDX-License-Identifier: Apache-2.0
#include "renderer/pick/line_triangle.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace eyrie::pick {

using fabric::Vec3;

RayFrame::RayFrame(const Vec3& direction) : kz_(0) {
    for (int k = 1; k < 3; ++k)
        if (std::abs(direction[k]) > std::abs(direction[kz_]))
            kz_ = k;
    kx_ = (kz_ + 1) % 3;
    ky_ = (kz_ + 2) % 3;
    perDepth_ = 1 / direction[kz_];
    sx_ = direction[kx_] * perDepth_;
    sy_ = direction[ky_] * perDepth_;
    stretch_ = std::sqrt(1 + sx_ * sx_ + sy_ * sy_);
}

Vec3 RayFrame::seen(const Vec3& p) const {
    return {p[kx_] - sx_ * p[kz_], p[ky_] - sy_ * p[kz_], p[kz_] * perDepth_};
}

bool mayPass(const SeenTriangle& t, double reach) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    return x0 <= reach && x1 >= -reach && y0 <= reach && y1 >= -reach;
}

std::optional<double> meets(const SeenTriangle& t) {
    const auto edge = [](const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; };
    const double u = edge(t[1], t[2]);
    const double v = edge(t[2], t[0]);
    const double w = edge(t[0], t[1]);
    const bool isInside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    const double sum = u + v + w;
    if (!isInside || sum == 0)
        return std::nullopt;
    return u / sum * t[0].z + v / sum * t[1].z + w / sum * t[2].z;
}

Vec3 Passage::normal() const {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

/// The points are in a plate around the triangle's plane, and no farther beyond its sides; of a
/// triangle without area, in its box.
Span within(const Passage& passage, double metres, Span span) {
    const auto& [corners, direction] = passage;
    const Ray ray{Vec3(0.0), direction};
    fabric::Box box;
    for (const Vec3& corner : corners) box.grow(corner);
    span = clip(span, ray, box.grownBy(metres));
    const double area = glm::length(passage.normal());
    if (area == 0)
        return span;
    const Vec3 up = passage.normal() / area;
    span = clip(span, ray, up, glm::dot(up, corners[0]) + metres);
    span = clip(span, ray, -up, -glm::dot(up, corners[0]) + metres);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 out = glm::normalize(glm::cross(corners[(k + 1) % 3] - corners[k], up));
        span = clip(span, ray, out, glm::dot(out, corners[k]) + metres);
    }
    return span;
}

bool meetsAllNear(const Passage& passage, double metres) {
    const auto& [corners, direction] = passage;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 across = glm::cross(direction, corners[(k + 1) % 3] - corners[k]);
        if (!(std::abs(glm::dot(corners[k], across)) > metres * glm::length(across)))
            return false;
    }
    return true;
}

}  // namespace eyrie::pick
