// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/vertical_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

namespace eyrie::lod {
namespace {

using fabric::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

struct VerticalError::Extremes {
    double leastDepth = kInfinity;
    double greatestSlantSquared = 0;
};

VerticalError::VerticalError(const ObjectView& view, double error)
    : view_(view), planes_(sidePlanes(view.view().frustum)) {
    const Vec3 up(view.viewFromObject()[2]);
    up_ = {up.x, up.y, -up.z};
    for (Plane& plane : planes_) plane.offset = error * std::abs(glm::dot(plane.normal, up_));
    depthReach_ = error * std::abs(up_.z);
    const double focal = view.view().greatestFocalPixels();
    scale_ = error * focal;
    squeeze_ = view.view().focalPixels / focal;
    leastSlant_ = kLeastSlant * glm::length(up_);
}

/// Slant: how long a unit of height looks at unit depth, in the shorter sides of pixels. It is the
/// norm of a linear map over the depth, so the points where it is below some value are a convex
/// set, and it is greatest at a corner.
void VerticalError::grow(Extremes& extremes, const Polygon& polygon) const {
    for (const Vec3& p : polygon) {
        extremes.leastDepth = std::min(extremes.leastDepth, p.z);
        if (p.z <= 0)
            continue;
        const double x = squeeze_.x * (up_.x - up_.z * p.x / p.z);
        const double y = squeeze_.y * (up_.y - up_.z * p.y / p.z);
        extremes.greatestSlantSquared = std::max(extremes.greatestSlantSquared, x * x + y * y);
    }
}

double VerticalError::bound(const Extremes& extremes) const {
    if (extremes.leastDepth == kInfinity)
        return 0;
    if (extremes.leastDepth <= depthReach_)
        return kInfinity;
    const double slant = std::max(std::sqrt(extremes.greatestSlantSquared), leastSlant_);
    return scale_ * slant / (extremes.leastDepth - depthReach_);
}

/// Whether a corner that the widened planes have in the plane of the eye lies in `bounds`.
bool VerticalError::holdsTheEye(const fabric::Box& bounds) const {
    for (const double x : {-planes_[0].offset, planes_[1].offset})
        for (const double y : {-planes_[2].offset, planes_[3].offset})
            if (bounds.contains(Vec3(view_.objectFromView() * fabric::Vec4(x, y, 0, 1))))
                return true;
    return false;
}

/// What of a box may be visible is a convex body. Its corners lie on the box's faces, but for those
/// where three of the planes meet: these lie behind the eye, and the body then reaches it.
double VerticalError::pixels(const fabric::Box& bounds) const {
    if (scale_ == 0)
        return 0;
    const Corners corners = viewCorners(bounds, view_.viewFromObject());
    int cuts = 0;
    for (const Plane& plane : planes_) {
        const auto outside = std::count_if(corners.begin(), corners.end(),
                                           [&](const Vec3& p) { return plane(p) < 0; });
        if (outside == 8)
            return 0;
        cuts += outside > 0 ? 1 : 0;
    }
    const bool isBeforeTheEye =
        std::all_of(corners.begin(), corners.end(), [](const Vec3& p) { return p.z > 0; });
    if (!isBeforeTheEye && holdsTheEye(bounds))
        return kInfinity;
    Extremes extremes;
    for (const auto& face : kFaces) {
        Polygon polygon;
        for (const std::size_t i : face) polygon.add(corners[i]);
        for (const Plane& plane : planes_)
            if (cuts > 0)
                polygon = clip(polygon, plane);
        grow(extremes, polygon);
    }
    return bound(extremes);
}

double VerticalError::pixels(std::span<const Vec3> triangleCorners) const {
    double worst = 0;
    for (std::size_t i = 0; scale_ > 0 && i + 2 < triangleCorners.size(); i += 3) {
        Polygon polygon;
        for (std::size_t k = i; k < i + 3; ++k)
            polygon.add(viewPoint(triangleCorners[k], view_.viewFromObject()));
        for (const Plane& plane : planes_) {
            const auto outside = std::count_if(polygon.begin(), polygon.end(),
                                               [&](const Vec3& p) { return plane(p) < 0; });
            if (outside == polygon.count)
                polygon.count = 0;
            else if (outside > 0)
                polygon = clip(polygon, plane);
        }
        Extremes extremes;
        grow(extremes, polygon);
        worst = std::max(worst, bound(extremes));
    }
    return worst;
}

}  // namespace eyrie::lod
