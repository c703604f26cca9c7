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

constexpr int kTilePixels = 8;                ///< a tile's side
constexpr double kSinglePrecision = 0x1p-24;  ///< a rounding to it, as a share
/// Sixteen of them: of what depths are divided by and of the quotient.
constexpr double kDepthRounding = 16 * kSinglePrecision;

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

double distanceToSide(const Vec2& from, const Vec2& to, const Vec2& point) {
    const Vec2 side = to - from;
    const double length = glm::dot(side, side);
    const double t = length > 0 ? std::clamp(glm::dot(point - from, side) / length, 0.0, 1.0) : 0.0;
    return glm::distance(point, from + t * side);
}

/// How far a picture point is from the nearest side of a triangle, in pixels.
double distanceToSides(const Before& part, const Pinhole& camera, const Vec2& at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < part.count; ++k) {
        const auto from = camera.project(part.corners[k]);
        const auto to = camera.project(part.corners[(k + 1) % part.count]);
        if (from && to)
            least = std::min(least, distanceToSide(*from, *to, at));
    }
    return least;
}

bool isCornerOf(const Triangle& triangle, const Vec3& point) {
    return std::ranges::find(triangle, point) != triangle.end();
}

bool haveACornerInCommon(const Triangle& one, const Triangle& other) {
    return std::ranges::any_of(one, [&](const Vec3& corner) { return isCornerOf(other, corner); });
}

/// How far a picture point is to the left of the line through two others.
double leftOf(const Vec2& from, const Vec2& to, const Vec2& point) {
    const Vec2 along = to - from;
    const Vec2 off = point - from;
    const double length = glm::length(along);
    return length > 0 ? (along.x * off.y - along.y * off.x) / length : 0;
}

/// Whether `other`, which has that side of a triangle too, goes on from it to the other side: on
/// the screen, and by more than corners are rounded.
bool goesOn(const Triangle& triangle, std::size_t side, const Triangle& other,
            const Pinhole& camera) {
    const Vec3& from = triangle[side];
    const Vec3& to = triangle[(side + 1) % 3];
    if (!isCornerOf(other, from) || !isCornerOf(other, to))
        return false;
    const auto third = std::ranges::find_if(
        other, [&](const Vec3& corner) { return corner != from && corner != to; });
    if (third == other.end() || camera.depth(*third) < fabric::kNearMetres)
        return false;
    const auto a = camera.project(from);
    const auto b = camera.project(to);
    const auto own = camera.project(triangle[(side + 2) % 3]);
    const auto its = camera.project(*third);
    if (!a || !b || !own || !its)
        return false;
    const double ownLeft = leftOf(*a, *b, *own);
    const double itsLeft = leftOf(*a, *b, *its);
    return std::min(std::abs(ownLeft), std::abs(itsLeft)) > ShownSurface::kReachPixels &&
           (ownLeft < 0) != (itsLeft < 0);
}

/// What a triangle's plane is, by where on the screen.
class Plane {
public:
    Plane(const Triangle& triangle, const Pinhole& camera)
        : camera_(camera),
          normal_(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0])),
          corner_(triangle[0]),
          inSinglePrecision_(errorInSinglePrecision(triangle, camera)) {}

    double depthAt(double x, double y) const { return 1 / inverseDepthAt(x, y); }

    /// Whether it has the depth, but for what single precision makes of it, somewhere within reach
    /// of a picture point.
    bool hasWithinReach(double x, double y, double depth) const {
        constexpr double kReach = ShownSurface::kReachPixels;
        double least = std::numeric_limits<double>::infinity();
        double most = -least;
        for (const double dy : {-kReach, kReach})
            for (const double dx : {-kReach, kReach}) {
                const double inverse = inverseDepthAt(x + dx, y + dy);
                if (!std::isfinite(inverse))
                    return true;  // it holds the eye
                least = std::min(least, inverse);
                most = std::max(most, inverse);
            }
        const double tested = 1 / depth;
        const double rounding = kDepthRounding * tested + inSinglePrecision_;
        return tested >= least - rounding && tested <= most + rounding;
    }

private:
    /// How far off the inverse depth of a sliver is where its plane is made in single precision.
    /// Of one that reaches behind the near plane nobody says which corners it is drawn by: none.
    static double errorInSinglePrecision(const Triangle& triangle, const Pinhole& camera) {
        constexpr double kRoundings = 88;
        double greatest = 0;
        std::array<Vec2, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const double depth = camera.depth(triangle[k]);
            if (depth < fabric::kNearMetres)
                return 0;
            greatest = std::max(greatest, 1 / depth);
            corners[k] = *camera.project(triangle[k]);
        }
        const Vec2 b = corners[1] - corners[0];
        const Vec2 c = corners[2] - corners[0];
        const double longest =
            std::max({glm::dot(b, b), glm::dot(c, c), glm::dot(c - b, c - b)});  // squared
        return kRoundings * kSinglePrecision * greatest * longest / std::abs(b.x * c.y - b.y * c.x);
    }

    /// On the screen it is linear.
    double inverseDepthAt(double x, double y) const {
        const Ray ray = camera_.rayThrough(x, y);
        return glm::dot(normal_, ray.direction) / glm::dot(normal_, corner_ - ray.origin);
    }

    const Pinhole& camera_;
    const Vec3 normal_;
    const Vec3 corner_;
    const double inSinglePrecision_;
};

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
    std::vector<std::uint32_t> near;
    for (const std::uint32_t index : tiles_[tileOf(x, y)]) {
        const Before part = partBefore(triangles_[index], camera_, fabric::kNearMetres);
        const Beside shown = nearestShown(part, camera_, {x, y});
        if (!(shown.pixels <= kReachPixels))
            continue;
        near.push_back(index);
        const Plane plane(triangles_[index], camera_);
        const bool mayHaveDepth = plane.hasWithinReach(x, y, depth);
        const double off = std::abs(plane.depthAt(x, y) - depth);
        const bool isBetter =
            !best || (mayHaveDepth != best->mayHaveDepth ? mayHaveDepth : off < least);
        if (isBetter) {
            best = Point{shown.point, index, mayHaveDepth};
            least = off;
        }
    }
    if (best)
        best->isAtEnd = std::ranges::any_of(near, [&](std::uint32_t index) {
            return haveACornerInCommon(triangles_[index], triangles_[best->triangle]) &&
                   hasEndAt(x, y, index, near);
        });
    return best;
}

bool ShownSurface::hasEndAt(double x, double y, std::uint32_t triangle,
                            std::span<const std::uint32_t> near) const {
    const Triangle& own = triangles_[triangle];
    const bool isCut = std::ranges::any_of(
        own, [&](const Vec3& corner) { return camera_.depth(corner) < fabric::kNearMetres; });
    if (isCut)  // it ends at the near plane, too
        return distanceToSides(partBefore(own, camera_, fabric::kNearMetres), camera_, {x, y}) <=
               kReachPixels;
    for (std::size_t side = 0; side < 3; ++side) {
        const auto from = camera_.project(own[side]);
        const auto to = camera_.project(own[(side + 1) % 3]);
        if (!from || !to || distanceToSide(*from, *to, {x, y}) > kReachPixels)
            continue;
        const bool isShared = std::ranges::any_of(near, [&](std::uint32_t other) {
            return other != triangle && goesOn(own, side, triangles_[other], camera_);
        });
        if (!isShared)
            return true;
    }
    return false;
}

}  // namespace eyrie::truth
