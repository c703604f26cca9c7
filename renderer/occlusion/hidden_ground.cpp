// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/hidden_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "fabric/frustum.h"
#include "fabric/simd_clones.h"
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
/// At the edge of the picture, what the source alone would show does not count.
constexpr double kEdgePixels = 1;
constexpr std::int64_t kLargePixels = 4096;

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

/// Horizontal metres for each by which a pixel looks aside per metre of depth, times its reversed
/// depth.
constexpr double kReach = fabric::kNearMetres * (1 + kRasterisationMargin);

/// Where a row of pixels looks: object x and y per metre of depth, of its first and from each to
/// the next.
struct Row {
    double x, y, perPixelX, perPixelY;
};

/// Whether all pixels of a row show what is horizontally less than `reach` times the reciprocal of
/// their depth away. Squares are compared.
EYRIE_SIMD_CLONES bool isRowNearer(const float* __restrict depth, int count, const Row& row,
                                   double reach) {
    int farther = 0;
    for (int i = 0; i < count; ++i) {
        const double x = row.x + i * row.perPixelX;
        const double y = row.y + i * row.perPixelY;
        const double limit = reach * static_cast<double>(depth[i]);
        farther += x * x + y * y < limit * limit ? 0 : 1;
    }
    return farther == 0;
}

/// The square of the farthest that a row of pixels shows, in units of kReach.
double farthestSquared(const float* depth, int count, const Row& row) {
    double farthest = 0;
    for (int i = 0; i < count; ++i) {
        const double x = row.x + i * row.perPixelX;
        const double y = row.y + i * row.perPixelY;
        const double d = static_cast<double>(depth[i]);
        farthest = std::max(farthest, d > 0 ? (x * x + y * y) / (d * d) : kInfinity);
    }
    return farthest;
}

}  // namespace

void HiddenGround::Rect::add(const Vec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
}

HiddenGround::HiddenGround(const lod::ObjectView& view, const PixelViewport& drawn, ReadDepth read,
                           Reading reading)
    : view_(view),
      drawn_(drawn),
      read_(std::move(read)),
      reading_(reading),
      eye_(view.objectFromView()[3]) {
    const Vec3 up(view.viewFromObject()[2]);
    up_ = {up.x, up.y, -up.z};
    const auto horizontal = [&](const Vec3& direction) {
        return Vec2(view.objectFromView() * fabric::Vec4(direction, 0.0));
    };
    const fabric::Frustum& f = view.view().frustum;
    lowerLeft_ = horizontal({f.left, f.bottom, -1});
    const Vec2& focal = view.view().focalPixels;
    perColumn_ = horizontal({1 / focal.x, 0, 0});
    perRow_ = horizontal({0, 1 / focal.y, 0});
    const Vec2 errorFocal = focal * view.view().step;
    shape_ = errorFocal / std::max(errorFocal.x, errorFocal.y);
}

std::optional<PixelViewport> HiddenGround::coverOf(const fabric::Box& bounds, double pixels) {
    Rect rect{Vec2(kInfinity), Vec2(-kInfinity)};
    for (int i = 0; i < 8; ++i)
        if (!project(bounds.corner(i), rect))
            return std::nullopt;
    const Vec2 nearest = glm::clamp(eye_, Vec2(bounds.min), Vec2(bounds.max));
    return coverOf(rect, pixels, glm::distance(eye_, nearest));
}

std::optional<PixelViewport> HiddenGround::coverOf(std::span<const Vec3, 3> corners,
                                                   double pixels) {
    Rect rect{Vec2(kInfinity), Vec2(-kInfinity)};
    for (const Vec3& corner : corners)
        if (!project(corner, rect))
            return std::nullopt;
    rect.low -= pixels / view_.view().step;
    rect.high += pixels / view_.view().step;
    return coverOf(rect, pixels, distanceToTriangle(eye_, corners));
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
    if (!(pixels < kInfinity))
        return false;
    const fabric::Frustum& f = view_.view().frustum;
    const Vec2 reach = pixels / view_.view().step;
    Vec2 least(kInfinity);
    Vec2 most(-kInfinity);
    for (const double x : {rect.low.x, rect.high.x})
        for (const double y : {rect.low.y, rect.high.y}) {
            const Vec2 tangent = Vec2(f.left, f.bottom) + Vec2(x, y) / view_.view().focalPixels;
            const Vec2 up = shape_ * (Vec2(up_) - up_.z * tangent);  // affine over the picture
            if (!(up.y > 0))
                return false;
            least = glm::min(least, glm::normalize(up));
            most = glm::max(most, glm::normalize(up));
        }
    rect.low.x += std::min(0.0, least.x) * reach.x;
    rect.high.x += std::max(0.0, most.x) * reach.x;
    rect.high.y += reach.y;
    return true;
}

/// The pixels of a rectangle, and those up to `pixels` above but for what lies at the very edge of
/// the picture, if all of them show ground at a horizontal distance of less than `nearest`.
std::optional<PixelViewport> HiddenGround::coverOf(const Rect& rect, double pixels,
                                                   double nearest) {
    // What is drawn is seen at pixels' centres.
    Rect covered = clipped(rect, 0.5);
    if (covered.isEmpty())
        return PixelViewport{};
    Rect ofSource = clipped(rect, kEdgePixels);
    if (!ofSource.isEmpty()) {
        if (!raise(ofSource, pixels) || clipped(ofSource, 0) != ofSource)
            return std::nullopt;
        covered.add(ofSource.low);
        covered.add(ofSource.high);
    }
    const lod::View& view = view_.view();
    const auto pixel = [](double at, double margin, int side) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(at + margin), 0.0, static_cast<double>(side)));
    };
    const std::int32_t left = pixel(covered.low.x, -kPixelMargin, view.width);
    const std::int32_t bottom = pixel(covered.low.y, -kPixelMargin, view.height);
    const std::int32_t right = pixel(covered.high.x, 1 + kPixelMargin, view.width);
    const std::int32_t top = pixel(covered.high.y, 1 + kPixelMargin, view.height);
    const PixelViewport part{left, bottom, right - left, top - bottom};
    if (!drawn_.contains(part))
        return std::nullopt;
    // Most of what is seen, and is large, shows in its top row.
    const PixelViewport topRow{part.x, part.y + part.height - 1, part.width, 1};
    if (part.area() > kLargePixels && !seen_.contains(part)) {
        look(topRow);
        if (!allNearer(topRow, nearest))
            return std::nullopt;
    }
    look(part);
    return allNearer(part, nearest) ? std::optional(part) : std::nullopt;
}

/// The part of a rectangle that is `inside` pixels or more from the edge of the picture.
HiddenGround::Rect HiddenGround::clipped(const Rect& rect, double inside) const {
    const Vec2 size(view_.view().width, view_.view().height);
    return {glm::max(rect.low, Vec2(inside)), glm::min(rect.high, size - inside)};
}

/// Makes sure that the depths of `part` are here. One who asks for much gets all of the picture, so
/// that no more is read than that and a quarter.
void HiddenGround::look(const PixelViewport& part) {
    if (seen_.contains(part))
        return;
    pixelsRead_ += part.area();
    const bool isMuch = pixelsRead_ > drawn_.area() / 4;
    seen_ = isMuch || reading_ == Reading::AllAtOnce ? drawn_ : part;
    depth_ = read_(seen_);
}

template <typename Visit>
void HiddenGround::forEachRow(const PixelViewport& part, Visit visit) const {
    for (std::int32_t y = part.y; y < part.y + part.height; ++y) {
        const float* depth =
            depth_.data() + std::ptrdiff_t{y - seen_.y} * seen_.width + (part.x - seen_.x);
        const Vec2 first = lowerLeft_ + (part.x + 0.5) * perColumn_ + (y + 0.5) * perRow_;
        if (!visit(depth, part.width, Row{first.x, first.y, perColumn_.x, perColumn_.y}))
            return;
    }
}

bool HiddenGround::allNearer(const PixelViewport& part, double nearest) {
    bool areNearer = true;
    forEachRow(part, [&](const float* depth, int count, const Row& row) {
        return areNearer = isRowNearer(depth, count, row, nearest / kReach);
    });
    return areNearer;
}

double HiddenGround::reachOf(const PixelViewport& part) {
    if (part.area() == 0)
        return 0;
    look(part);
    double farthest = 0;
    forEachRow(part, [&](const float* depth, int count, const Row& row) {
        farthest = std::max(farthest, farthestSquared(depth, count, row));
        return true;
    });
    return kReach * std::sqrt(farthest);
}

}  // namespace eyrie::occlusion
