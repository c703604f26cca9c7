// SPDX-License-Identifier: Apache-2.0
#include "renderer/lod/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "renderer/lod/frustum_clip.h"

namespace eyrie::lod {
namespace {

using fabric::Box;
using fabric::Frustum;
using fabric::Mat3;
using fabric::Mat4;
using fabric::Vec2;
using fabric::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// How far a corner is drawn from where it is, of its distance to the eye: straight ahead, where
/// the object's axes are at right angles (docs/errors.md).
constexpr double kCornerRounding = 9.0 / (1 << 24);
/// To which OpenGL snaps window coordinates.
constexpr double kSnappedPixels = 1.0 / 256;

/// The part of a surface inside a frustum: nearest depth and widest tangent off the axis.
struct VisiblePart {
    double minDepth = kInfinity;
    double maxTangentSquared = 0;

    /// The extremes over a polygon and the frustum lie at corners of their intersection.
    void add(Polygon polygon, const std::array<Plane, 4>& planes) {
        for (const Plane& plane : planes) polygon = clip(polygon, plane);
        for (const Vec3& p : polygon) {
            minDepth = std::min(minDepth, p.z);
            if (p.z > 0)
                maxTangentSquared =
                    std::max(maxTangentSquared, (p.x * p.x + p.y * p.y) / (p.z * p.z));
        }
    }
};

/// Those of a box lie on its faces (the eye itself is excluded by the caller).
VisiblePart visiblePart(const Corners& corners, const Frustum& frustum) {
    VisiblePart part;
    const auto planes = sidePlanes(frustum);
    for (const auto& face : kFaces) {
        Polygon polygon;
        for (const std::size_t i : face) polygon.add(corners[i]);
        part.add(polygon, planes);
    }
    return part;
}

VisiblePart visiblePart(std::span<const Vec3, 3> corners, const Frustum& frustum) {
    VisiblePart part;
    Polygon polygon;
    for (const Vec3& corner : corners) polygon.add(corner);
    part.add(polygon, sidePlanes(frustum));
    return part;
}

double farthest(std::span<const Vec3> viewPoints) {
    double squared = 0;
    for (const Vec3& p : viewPoints) squared = std::max(squared, glm::dot(p, p));
    return std::sqrt(squared);
}

double widestSecantSquared(const Frustum& f) {
    return 1 + std::max(f.left * f.left, f.right * f.right) +
           std::max(f.bottom * f.bottom, f.top * f.top);
}

Frustum widened(const Frustum& f, const Vec2& tangent) {
    return {f.left - tangent.x, f.right + tangent.x, f.bottom - tangent.y, f.top + tangent.y};
}

/// From the eye to a box in the view at least: to the planes of its faces.
double distanceAtLeast(const Corners& corners) {
    double least = 0;
    for (const std::size_t axis : {1, 2, 4}) {
        const std::size_t next = axis == 4 ? 1 : 2 * axis;
        const Vec3 normal =
            glm::cross(corners[next] - corners[0], corners[7 - axis - next] - corners[0]);
        const double low = glm::dot(normal, corners[0]);
        const double high = glm::dot(normal, corners[axis]);
        if (const double length = glm::length(normal); length > 0)
            least = std::max(least, std::max(std::min(low, high), -std::max(low, high)) / length);
    }
    return least;
}

double distanceToEdge(const Vec3& from, const Vec3& to) {
    const Vec3 way = to - from;
    const double length = glm::dot(way, way);
    const double share = length > 0 ? std::clamp(-glm::dot(from, way) / length, 0.0, 1.0) : 0;
    return glm::length(from + share * way);
}

/// From the eye to a triangle in the view: to its inside where that is straight ahead of it, else
/// to an edge. A needle's normal is none to go by, but no inside is farther than its edges.
double distanceTo(std::span<const Vec3, 3> corners) {
    const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    double nearest = kInfinity;
    bool isAbove = glm::dot(normal, normal) > 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& from = corners[i];
        const Vec3& to = corners[(i + 1) % 3];
        nearest = std::min(nearest, distanceToEdge(from, to));
        isAbove = isAbove && glm::dot(glm::cross(to - from, -from), normal) >= 0;
    }
    return isAbove ? std::min(nearest, std::abs(glm::dot(normal, corners[0])) / glm::length(normal))
                   : nearest;
}

/// In pixels, how far apart two points are at most that are `off` apart, when one is `depth` away
/// or more and at most as far off the axis as `secant` says.
double apartPixels(const View& view, double off, double depth, double secant) {
    return depth > off ? off * view.greatestFocalPixels() * (depth * secant + off) /
                             ((depth - off) * (depth - off))
                       : kInfinity;
}

/// How far what is seen of a surface, no nearer to the eye than `distance`, is drawn from where it
/// is, in pixels, when that is up to `off` in space; up to `enough` need not be told apart. A point
/// that is drawn in the picture is of one in a frustum wider by what is known already, the distance
/// alone at first (docs/errors.md#corners-far-away).
template <typename SurfaceCorners>
double displacementPixels(const View& view, const SurfaceCorners& corners, double distance,
                          double off, double enough) {
    const double widest = std::sqrt(widestSecantSquared(view.frustum));
    double known = apartPixels(view, off, (distance - off) / widest, widest);
    while (known > enough && known < kInfinity) {
        const VisiblePart part =
            visiblePart(corners, widened(view.frustum, known / view.focalPixels));
        if (part.minDepth == kInfinity)
            return 0;
        const double before = known;
        known = std::min(
            known, apartPixels(view, off, part.minDepth, std::sqrt(1 + part.maxTangentSquared)));
        if (known > 0.9 * before)
            break;
    }
    return known;
}

/// Of what rounding moves.
template <typename SurfaceCorners>
double roundedPixels(const View& view, const SurfaceCorners& corners, double distance, double off) {
    const double pixels = displacementPixels(view, corners, distance, off, kSnappedPixels);
    return pixels > kSnappedPixels ? pixels : 0;
}

std::array<Vec3, 3> inView(std::span<const Vec3, 3> triangle, const Mat4& viewFromObject) {
    return {viewPoint(triangle[0], viewFromObject), viewPoint(triangle[1], viewFromObject),
            viewPoint(triangle[2], viewFromObject)};
}

/// Of the rows that make clip coordinates, against those of a rotation: longer by as much as the
/// middle of the frustum is off the axis.
double obliqueness(const Frustum& f) {
    const double across = (f.left + f.right) / 2;
    const double up = (f.bottom + f.top) / 2;
    return std::sqrt((3 + across * across + up * up) / 3);
}

bool areAtRightAngles(const Mat3& axes) {
    constexpr double kRounding = 1e-9;
    for (int i = 0; i < 3; ++i) {
        const Vec3& a = axes[i];
        const Vec3& b = axes[(i + 1) % 3];
        if (std::abs(glm::dot(a, b)) > kRounding * glm::length(a) * glm::length(b))
            return false;
    }
    return true;
}

/// Exactly the ends at 0 and 1.
double between(double low, double high, double share) { return low * (1 - share) + high * share; }

}  // namespace

/// The root of the largest eigenvalue of mᵀm, by the trigonometric solution for symmetric 3 x 3
/// matrices (Smith 1961).
double largestStretch(const Mat3& m) {
    const Mat3 a = glm::transpose(m) * m;
    const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3;
    const double offDiagonal = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const Mat3 centred = a - Mat3(mean);
    const double p = std::sqrt((centred[0][0] * centred[0][0] + centred[1][1] * centred[1][1] +
                                centred[2][2] * centred[2][2] + 2 * offDiagonal) /
                               6);
    if (p <= mean * 1e-12)
        return std::sqrt(mean + p);
    const double r = std::clamp(glm::determinant(centred / p) / 2, -1.0, 1.0);
    return std::sqrt(mean + 2 * p * std::cos(std::acos(r) / 3));
}

View::View(const fabric::Camera& camera, int widthPixels, int heightPixels)
    : eye(camera.eye),
      viewFromWorldRotation(fabric::viewFromWorldRotation(camera)),
      cameraFromWorldRotation(viewFromWorldRotation),
      frustum(fabric::symmetricFrustum(camera.fovYDegrees,
                                       static_cast<double>(widthPixels) / heightPixels)),
      width(widthPixels),
      height(heightPixels),
      focalPixels(heightPixels / (frustum.top - frustum.bottom)) {}

View::View(const fabric::Camera& camera, const std::optional<fabric::Sight>& sight, int widthPixels,
           int heightPixels)
    : View(camera, widthPixels, heightPixels) {
    if (!sight)
        return;
    eye += glm::transpose(cameraFromWorldRotation) * sight->eye;
    viewFromWorldRotation = sight->viewFromCamera * cameraFromWorldRotation;
    frustum = sight->frustum;
    focalPixels = {widthPixels / (frustum.right - frustum.left),
                   heightPixels / (frustum.top - frustum.bottom)};
}

double View::greatestFocalPixels() const { return std::max(focalPixels.x, focalPixels.y); }

View rasterView(const View& view, const std::optional<fabric::Raster>& raster) {
    View sampled = view;
    if (!raster)
        return sampled;
    const Vec2 size(raster->width, raster->height);
    const Vec2 low = raster->origin / Vec2(view.width, view.height);
    const Vec2 high = (raster->origin + size * raster->step) / Vec2(view.width, view.height);
    const Frustum& f = view.frustum;
    sampled.frustum = {between(f.left, f.right, low.x), between(f.left, f.right, high.x),
                       between(f.bottom, f.top, low.y), between(f.bottom, f.top, high.y)};
    sampled.width = raster->width;
    sampled.height = raster->height;
    sampled.focalPixels = view.focalPixels / raster->step;
    sampled.step = raster->step;
    return sampled;
}

Vec3 middleDirection(const View& view) {
    const Frustum& f = view.frustum;
    return glm::normalize(glm::transpose(view.viewFromWorldRotation) *
                          Vec3((f.left + f.right) / 2, (f.bottom + f.top) / 2, -1));
}

Frustum subFrustum(const View& view, const fabric::PixelViewport& part) {
    const Frustum& f = view.frustum;
    const double perPixelX = (f.right - f.left) / view.width;
    const double perPixelY = (f.top - f.bottom) / view.height;
    return {f.left + perPixelX * part.x, f.left + perPixelX * (part.x + part.width),
            f.bottom + perPixelY * part.y, f.bottom + perPixelY * (part.y + part.height)};
}

ObjectView::ObjectView(const View& view, const Mat4& worldFromObject)
    : view_(view), metresPerObjectUnit_(largestStretch(Mat3(worldFromObject))) {
    // The eye is subtracted from the translation before anything is rotated, so that two large
    // world coordinates cancel exactly instead of after rounding.
    Mat4 relativeFromObject = worldFromObject;
    relativeFromObject[3] -= fabric::Vec4(view.eye, 0.0);
    viewFromObject_ = Mat4(view.viewFromWorldRotation) * relativeFromObject;
    objectFromView_ = glm::inverse(viewFromObject_);
    leastMetresPerObjectUnit_ = 1 / largestStretch(Mat3(objectFromView_));
    const Mat3 axes(worldFromObject);
    const double sheared =
        areAtRightAngles(axes) ? 1 : metresPerObjectUnit_ / leastMetresPerObjectUnit_;
    rounding_ = kCornerRounding * obliqueness(view.frustum) * sheared;
}

bool ObjectView::isVisible(const Box& bounds, const Frustum& frustum) const {
    const Corners corners = viewCorners(bounds, viewFromObject_);
    const auto allOutside = [&](const Plane& plane) {
        return std::all_of(corners.begin(), corners.end(),
                           [&](const Vec3& p) { return plane(p) < 0; });
    };
    if (allOutside({{0, 0, 1}}))
        return false;
    const auto planes = sidePlanes(frustum);
    return std::none_of(planes.begin(), planes.end(), allOutside);
}

fabric::PixelViewport ObjectView::coveredPixels(const Box& bounds) const {
    const fabric::PixelViewport whole{0, 0, view_.width, view_.height};
    // Of the box, on the plane at unit distance.
    Frustum extent{kInfinity, -kInfinity, kInfinity, -kInfinity};
    for (const Vec3& p : viewCorners(bounds, viewFromObject_)) {
        if (p.z < fabric::kNearMetres)
            return whole;
        extent = {std::min(extent.left, p.x / p.z), std::max(extent.right, p.x / p.z),
                  std::min(extent.bottom, p.y / p.z), std::max(extent.top, p.y / p.z)};
    }
    // One pixel more on each side: vertices are rounded to floats, and lines have a width.
    const auto pixel = [](double fromOrigin, double focal, double margin, int side) {
        const double at = std::floor(fromOrigin * focal + margin);
        return static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(side)));
    };
    const Frustum& f = view_.frustum;
    const Vec2& focal = view_.focalPixels;
    const std::int32_t left = pixel(extent.left - f.left, focal.x, -1, view_.width);
    const std::int32_t right = pixel(extent.right - f.left, focal.x, 2, view_.width);
    const std::int32_t bottom = pixel(extent.bottom - f.bottom, focal.y, -1, view_.height);
    const std::int32_t top = pixel(extent.top - f.bottom, focal.y, 2, view_.height);
    return {left, bottom, right - left, top - bottom};
}

double ObjectView::screenSpaceErrorPixels(double errorMetres, const Box& bounds) const {
    if (errorMetres == 0)
        return 0;
    const Box grown = bounds.grownBy(errorMetres);
    const Corners corners = viewCorners(grown, viewFromObject_);
    if (grown.contains(Vec3(objectFromView_[3])))
        return kInfinity;
    // A visible point may be displaced out of the frustum, so the bound is taken over a frustum
    // wider by a margin; it holds once it is no larger than that margin (docs/errors.md).
    for (const double marginPixels : {16.0, 256.0, 4096.0, 65536.0}) {
        const VisiblePart part =
            visiblePart(corners, widened(view_.frustum, marginPixels / view_.focalPixels));
        if (part.minDepth == kInfinity)
            return 0;
        if (part.minDepth <= 0)
            return kInfinity;
        const double bound = errorMetres * metresPerObjectUnit_ * view_.greatestFocalPixels() *
                             std::sqrt(1 + part.maxTangentSquared) / part.minDepth;
        if (bound <= marginPixels)
            return bound;
    }
    return kInfinity;
}

double ObjectView::looseErrorPixels(double errorMetres, const Box& bounds) const {
    constexpr double kMarginPixels = 16;
    const Box grown = bounds.grownBy(errorMetres);
    const Vec3 eye(objectFromView_[3]);
    const Vec3 near = glm::max(glm::max(grown.min - eye, eye - grown.max), Vec3(0.0));
    const double distance = glm::length(near) * leastMetresPerObjectUnit_;
    const double secantSquared =
        widestSecantSquared(widened(view_.frustum, kMarginPixels / view_.focalPixels));
    const double bound =
        errorMetres * metresPerObjectUnit_ * view_.greatestFocalPixels() * secantSquared;
    return bound <= kMarginPixels * distance ? bound / std::max(distance, 1e-300) : kInfinity;
}

/// Quick, and so of nearly all that is not right before the eye.
bool ObjectView::isRoundedUnseen(const Box& reach, const Box& bounds) const {
    const Vec3 eye(objectFromView_[3]);
    const Vec3 near = glm::max(glm::max(bounds.min - eye, eye - bounds.max), Vec3(0.0));
    const Vec3 far = glm::max(glm::abs(reach.min - eye), glm::abs(reach.max - eye));
    const double off = rounding_ * glm::length(far) * metresPerObjectUnit_;
    return 2 * off * view_.greatestFocalPixels() * widestSecantSquared(view_.frustum) <=
           kSnappedPixels * glm::length(near) * leastMetresPerObjectUnit_;
}

double ObjectView::roundingPixels(const Box& reach, const Box& bounds) const {
    if (isRoundedUnseen(reach, bounds))
        return 0;
    const Corners corners = viewCorners(bounds, viewFromObject_);
    return roundedPixels(view_, corners, distanceAtLeast(corners),
                         rounding_ * farthest(viewCorners(reach, viewFromObject_)));
}

double ObjectView::roundingPixels(std::span<const Vec3, 3> triangle) const {
    Box bounds;
    for (const Vec3& corner : triangle) bounds.grow(corner);
    if (isRoundedUnseen(bounds, bounds))
        return 0;
    const std::array<Vec3, 3> corners = inView(triangle, viewFromObject_);
    return roundedPixels(view_, std::span(corners), distanceTo(corners),
                         rounding_ * farthest(corners));
}

double ObjectView::displacedPixels(double errorMetres, std::span<const Vec3, 3> triangle,
                                   double enoughPixels) const {
    const std::array<Vec3, 3> corners = inView(triangle, viewFromObject_);
    const double off = errorMetres * metresPerObjectUnit_ + rounding_ * farthest(corners);
    return displacementPixels(view_, std::span(corners), distanceTo(corners), off, enoughPixels);
}

}  // namespace eyrie::lod
