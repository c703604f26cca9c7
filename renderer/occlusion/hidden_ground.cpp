// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/hidden_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "fabric/frustum.h"
#include "renderer/lod/frustum_clip.h"

namespace eyrie::occlusion {
namespace {

using fabric::PixelViewport;
using fabric::Vec2;
using fabric::Vec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of a pixel's depth: see nearestReversedDepth in depth_pyramid.h.
constexpr double kRasterisationMargin = 1.0 / 512;
/// Around what is asked about: the pixels on both sides of a point, and what rasterisation moves.
constexpr double kPixelMargin = 1;
constexpr int kReadAhead = 16;  ///< pixels around a rectangle that are read with it

double distanceToSegment(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 side = b - a;
    const double length = glm::dot(side, side);
    const double t = length > 0 ? std::clamp(glm::dot(p - a, side) / length, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + t * side);
}

double distanceToTriangle(const Vec2& p, std::span<const Vec3, 3> corners) {
    const auto side = [&](std::size_t i, std::size_t j) {
        const Vec2 a(corners[i]);
        const Vec2 b(corners[j]);
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    const double ab = side(0, 1);
    const double bc = side(1, 2);
    const double ca = side(2, 0);
    if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))
        return 0;
    return std::min({distanceToSegment(p, Vec2(corners[0]), Vec2(corners[1])),
                     distanceToSegment(p, Vec2(corners[1]), Vec2(corners[2])),
                     distanceToSegment(p, Vec2(corners[2]), Vec2(corners[0]))});
}

}  // namespace

void HiddenGround::Rect::add(const Vec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
}

HiddenGround::HiddenGround(const lod::ObjectView& view, const PixelViewport& drawn, ReadDepth read)
    : view_(view),
      drawn_(drawn),
      read_(std::move(read)),
      eye_(view.objectFromView()[3]),
      pixelsLeft_(std::int64_t{view.view().width} * view.view().height) {
    const Vec3 up(view.viewFromObject()[2]);
    up_ = {up.x, up.y, -up.z};
    const auto horizontal = [&](const Vec3& direction) {
        return Vec2(view.objectFromView() * fabric::Vec4(direction, 0.0));
    };
    const fabric::Frustum& f = view.view().frustum;
    lowerLeft_ = horizontal({f.left, f.bottom, -1});
    perColumn_ = horizontal({1 / view.view().focalPixels, 0, 0});
    perRow_ = horizontal({0, 1 / view.view().focalPixels, 0});
}

bool HiddenGround::hides(const fabric::Box& bounds, double pixels) {
    Rect rect{Vec2(kInfinity), Vec2(-kInfinity)};
    for (int i = 0; i < 8; ++i)
        if (!project(bounds.corner(i), rect))
            return false;
    const Vec2 nearest = glm::clamp(eye_, Vec2(bounds.min), Vec2(bounds.max));
    return isCovered(rect, pixels, glm::distance(eye_, nearest));
}

bool HiddenGround::hidesTriangle(std::span<const Vec3, 3> corners, double pixels) {
    Rect rect{Vec2(kInfinity), Vec2(-kInfinity)};
    for (const Vec3& corner : corners)
        if (!project(corner, rect))
            return false;
    rect.low -= pixels;
    rect.high += pixels;
    return isCovered(rect, pixels, distanceToTriangle(eye_, corners));
}

/// False for what is not clearly before the eye.
bool HiddenGround::project(const Vec3& point, Rect& rect) const {
    const Vec3 p = lod::viewPoint(point, view_.viewFromObject());
    if (!(p.z >= fabric::kNearMetres))
        return false;
    const fabric::Frustum& f = view_.view().frustum;
    rect.add(Vec2(p.x / p.z - f.left, p.y / p.z - f.bottom) * view_.view().focalPixels);
    return true;
}

/// Adds what lies up to `pixels` higher in the object. False where that is not to the same side,
/// within a half turn, all over the rectangle: around the zenith, or the nadir.
bool HiddenGround::raise(Rect& rect, double pixels) const {
    const fabric::Frustum& f = view_.view().frustum;
    Vec2 least(kInfinity);
    Vec2 most(-kInfinity);
    for (const double x : {rect.low.x, rect.high.x})
        for (const double y : {rect.low.y, rect.high.y}) {
            const Vec2 tangent = Vec2(f.left, f.bottom) + Vec2(x, y) / view_.view().focalPixels;
            const Vec2 up = Vec2(up_) - up_.z * tangent;  // affine over the picture
            if (!(up.y > 0))
                return false;
            least = glm::min(least, glm::normalize(up));
            most = glm::max(most, glm::normalize(up));
        }
    rect.low.x += std::min(0.0, least.x) * pixels;
    rect.high.x += std::max(0.0, most.x) * pixels;
    rect.high.y += pixels;
    return true;
}

/// Whether all pixels of a rectangle, and of `pixels` above, show ground at a horizontal distance
/// of less than `nearest`.
bool HiddenGround::isCovered(Rect rect, double pixels, double nearest) {
    const lod::View& view = view_.view();
    // What is seen is seen at pixels' centres.
    rect.low = glm::max(rect.low, Vec2(0.5));
    rect.high = glm::min(rect.high, Vec2(view.width - 0.5, view.height - 0.5));
    if (!(rect.low.x <= rect.high.x && rect.low.y <= rect.high.y))
        return true;
    if (!(pixels < kInfinity) || !raise(rect, pixels) || rect.low.x < 0 ||
        rect.high.x > view.width || rect.high.y > view.height)
        return false;
    const auto pixel = [](double at, double margin, int side) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(at + margin), 0.0, static_cast<double>(side)));
    };
    const std::int32_t left = pixel(rect.low.x, -kPixelMargin, view.width);
    const std::int32_t bottom = pixel(rect.low.y, -kPixelMargin, view.height);
    const PixelViewport part{left, bottom, pixel(rect.high.x, 1 + kPixelMargin, view.width) - left,
                             pixel(rect.high.y, 1 + kPixelMargin, view.height) - bottom};
    return drawn_.contains(part) && look(part) && allNearer(part, nearest);
}

/// Makes sure that the depths of `part` are here. False when enough has been read.
bool HiddenGround::look(const PixelViewport& part) {
    if (seen_.contains(part))
        return true;
    const PixelViewport wide =
        intersection({part.x - kReadAhead, part.y - kReadAhead, part.width + 2 * kReadAhead,
                      part.height + 2 * kReadAhead},
                     drawn_);
    if (wide.area() > pixelsLeft_)
        return false;
    pixelsLeft_ -= wide.area();
    read_(wide, depth_);
    seen_ = wide;
    return true;
}

bool HiddenGround::allNearer(const PixelViewport& part, double nearest) const {
    const double scale = fabric::kNearMetres * (1 + kRasterisationMargin);
    for (std::int32_t y = part.y; y < part.y + part.height; ++y) {
        const Vec2 row = lowerLeft_ + (y + 0.5) * perRow_;
        const float* depth =
            depth_.data() + std::ptrdiff_t{y - seen_.y} * seen_.width + (part.x - seen_.x);
        for (std::int32_t x = part.x; x < part.x + part.width; ++x) {
            // Squares of the distance of what the pixel shows and of `nearest`, times its depth's
            // reciprocal.
            const Vec2 across = scale * (row + (x + 0.5) * perColumn_);
            const double reach = nearest * static_cast<double>(depth[x - part.x]);
            if (!(glm::dot(across, across) < reach * reach))
                return false;
        }
    }
    return true;
}

}  // namespace eyrie::occlusion
