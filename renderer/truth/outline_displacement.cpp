// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/outline_displacement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace eyrie::truth {
namespace {

using fabric::Vec2;
using fabric::Vec3;

/// Half posts away from a point, seen from above, within which the other surface is looked for.
constexpr int kFarthest = 64;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Into each of the half cells that may meet in a point, in half posts.
constexpr std::array<Vec2, 8> kAround = {{{2e-6, 1e-6},
                                          {1e-6, 2e-6},
                                          {-1e-6, 2e-6},
                                          {-2e-6, 1e-6},
                                          {-2e-6, -1e-6},
                                          {-1e-6, -2e-6},
                                          {1e-6, -2e-6},
                                          {2e-6, -1e-6}}};

/// Calls visit(x, y) for the points of the square ring at a distance from (x0, y0).
template <typename Visit>
void forEachOfRing(int x0, int y0, int distance, Visit visit) {
    for (int x = x0 - distance; x <= x0 + distance; ++x) {
        visit(x, y0 - distance);
        visit(x, y0 + distance);
    }
    for (int y = y0 - distance + 1; y < y0 + distance; ++y) {
        visit(x0 - distance, y);
        visit(x0 + distance, y);
    }
}

}  // namespace

OutlineDisplacement::OutlineDisplacement(const terrain::Quadtree& quadtree,
                                         const fabric::Mat4& objectFromPosts,
                                         const TerrainRayCaster& source)
    : objectFromPosts_(objectFromPosts),
      source_(source),
      width_(2 * quadtree.columns() - 1),
      height_(2 * quadtree.rows() - 1) {
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const auto [any, all] = heightsAt(x, y);
            any_.push_back(static_cast<float>(any));
            all_.push_back(static_cast<float>(all));
        }
}

/// By some reading of some cell that meets there, and by all readings of one.
std::pair<double, double> OutlineDisplacement::heightsAt(double x, double y) const {
    double any = kNaN;
    for (const Vec2& aside : kAround) {
        const Vec3 column(objectFromPosts_ *
                          fabric::Vec4((x + aside.x) / 2, (y + aside.y) / 2, 0, 1));
        bool isWhole = true;
        for (const double height : source_.heightsAt(column.x, column.y)) {
            isWhole = isWhole && !std::isnan(height);
            any = std::isnan(height) ? any : height;
        }
        if (isWhole)
            return {any, any};
    }
    return {any, kNaN};
}

Vec3 OutlineDisplacement::pointAt(int x, int y, const Heights& heights) const {
    const Vec3 column(objectFromPosts_ * fabric::Vec4(x / 2.0, y / 2.0, 0, 1));
    return {column.x, column.y, heights[at(x, y)]};
}

/// In the picture from `from` to the surface around half post (x, y); 0 where none is near enough
/// to tell.
double OutlineDisplacement::leastPixels(const Pinhole& camera, const Vec2& from, int x, int y,
                                        const Heights& heights) const {
    double least = std::numeric_limits<double>::infinity();
    int last = kFarthest;
    for (int distance = 1; distance <= last; ++distance)
        forEachOfRing(x, y, distance, [&](int u, int v) {
            if (u < 0 || v < 0 || u >= width_ || v >= height_ || std::isnan(heights[at(u, v)]))
                return;
            last = std::min(last, distance + distance / 2 + 1);
            if (const auto other = camera.project(pointAt(u, v, heights)))
                least = std::min(least, camera.pixelsBetween(from, *other));
        });
    return std::isfinite(least) ? least : 0;
}

void OutlineDisplacement::addMissing(const Pinhole& camera, const Heights& there,
                                     const Heights& lacking, double atLeast,
                                     std::vector<Candidate>& candidates) const {
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            if (std::isnan(there[at(x, y)]) || !std::isnan(lacking[at(x, y)]))
                continue;
            const Vec3 point = pointAt(x, y, there);
            const auto p = camera.project(point);
            if (!p || p->x < 0 || p->y < 0 || p->x >= camera.width() || p->y >= camera.height())
                continue;
            if (const double pixels = leastPixels(camera, *p, x, y, lacking); pixels > atLeast)
                candidates.push_back({pixels, point});
        }
}

double OutlineDisplacement::farthestSeen(const Pinhole& camera, const DrawnTerrain& drawn,
                                         std::span<const float> depth, double atLeast) const {
    const Heights heights = drawn.heightsAtHalfPosts(width_, height_);
    std::vector<Candidate> overNodata, missing;
    addMissing(camera, heights, any_, atLeast, overNodata);
    addMissing(camera, all_, heights, atLeast, missing);

    constexpr double kSamePoint = 1e-9;
    constexpr double kWithinAPixel = 0.02;  // of the depth
    const auto isHiddenInSource = [&](const Candidate& c) {
        const auto p = camera.project(c.point);
        return source_.hitRange(camera.rayThrough(p->x, p->y)).first <
               camera.depth(c.point) * (1 - kSamePoint);
    };
    const auto isHiddenInPicture = [&](const Candidate& c) {
        const auto p = camera.project(c.point);
        const auto pixel =
            static_cast<std::size_t>(p->y) * static_cast<std::size_t>(camera.width()) +
            static_cast<std::size_t>(p->x);
        return depth[pixel] < camera.depth(c.point) * (1 - kWithinAPixel);
    };
    const auto raise = [&](std::vector<Candidate>& all, const auto& isHidden) {
        std::sort(all.begin(), all.end(),
                  [](const Candidate& a, const Candidate& b) { return a.pixels > b.pixels; });
        const auto seen = std::find_if_not(all.begin(), all.end(), isHidden);
        atLeast = seen == all.end() ? atLeast : std::max(atLeast, seen->pixels);
    };
    raise(missing, isHiddenInSource);
    raise(overNodata,
          [&](const Candidate& c) { return isHiddenInPicture(c) || isHiddenInSource(c); });
    return atLeast;
}

}  // namespace eyrie::truth
