// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/polygon.h"

#include <utility>

#include <glm/common.hpp>

namespace eyrie::import {
namespace {

using fabric::Vec2;
using fabric::Vec3;

/// Twice the signed area of a triangle; positive when counter-clockwise.
double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The corners on the coordinate plane where the polygon's area is largest, turned so that it is
/// counter-clockwise there. Relative to the first corner, which keeps digits far from the origin.
std::vector<Vec2> project(std::span<const Vec3> positions, std::span<const std::uint32_t> corners) {
    const Vec3 origin = positions[corners[0]];
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = positions[corners[i]] - origin;
        const Vec3 b = positions[corners[(i + 1) % corners.size()]] - origin;
        normal +=
            Vec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    const Vec3 size = glm::abs(normal);
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    int u = (dropped + 1) % 3;
    int v = (dropped + 2) % 3;
    if (normal[dropped] < 0)
        std::swap(u, v);
    std::vector<Vec2> points;
    points.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
        const Vec3 relative = positions[corner] - origin;
        points.emplace_back(relative[u], relative[v]);
    }
    return points;
}

bool isConvex(std::span<const Vec2> points) {
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i)
        if (cross(points[i], points[(i + 1) % count], points[(i + 2) % count]) < 0)
            return false;
    return true;
}

/// Clips one ear after another from a ring of corners. A corner's being an ear changes only when a
/// neighbour goes, so each clip asks again for two corners only.
class EarClipper {
public:
    explicit EarClipper(std::span<const Vec2> points) : points_(points) {
        const auto count = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            next_.push_back((i + 1) % count);
            previous_.push_back((i + count - 1) % count);
        }
        isGone_.resize(count, false);
        for (std::uint32_t i = count; i-- > 0;) offer(i);
    }

    std::vector<std::array<std::uint32_t, 3>> clip() {
        std::vector<std::array<std::uint32_t, 3>> triangles;
        std::uint32_t corner = 0;
        for (std::size_t left = points_.size(); left > 3; --left) {
            corner = nextEar(next_[corner]);
            const std::uint32_t before = previous_[corner];
            const std::uint32_t after = next_[corner];
            triangles.push_back({before, corner, after});
            next_[before] = after;
            previous_[after] = before;
            isGone_[corner] = true;
            offer(before);
            offer(after);
            corner = before;
        }
        triangles.push_back({previous_[corner], corner, next_[corner]});
        return triangles;
    }

private:
    void offer(std::uint32_t corner) {
        if (isEar(corner))
            ears_.push_back(corner);
    }

    /// An ear, or `otherwise` when rounding or crossing edges left none.
    std::uint32_t nextEar(std::uint32_t otherwise) {
        while (!ears_.empty()) {
            const std::uint32_t ear = ears_.back();
            ears_.pop_back();
            if (!isGone_[ear] && isEar(ear))
                return ear;
        }
        return otherwise;
    }

    bool isEar(std::uint32_t corner) const {
        const Vec2& a = points_[previous_[corner]];
        const Vec2& b = points_[corner];
        const Vec2& c = points_[next_[corner]];
        if (cross(a, b, c) <= 0)
            return false;
        for (std::uint32_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
            const Vec2& p = points_[i];
            if (p != a && p != b && p != c && cross(a, b, p) >= 0 && cross(b, c, p) >= 0 &&
                cross(c, a, p) >= 0)
                return false;
        }
        return true;
    }

    std::span<const Vec2> points_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::vector<bool> isGone_;
    std::vector<std::uint32_t> ears_;
};

}  // namespace

bool triangulatePolygon(std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
                        std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::vector<Vec2> points = project(positions, corners);
    if (isConvex(points)) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            triangles.push_back({corners[0], corners[i - 1], corners[i]});
        return true;
    }
    if (corners.size() > kMaxConcaveCorners)
        return false;
    for (const auto& [a, b, c] : EarClipper(points).clip())
        triangles.push_back({corners[a], corners[b], corners[c]});
    return true;
}

}  // namespace eyrie::import
