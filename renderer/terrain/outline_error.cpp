// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/outline_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "renderer/terrain/triangle_cells.h"

namespace eyrie::terrain {
namespace {

/// Posts of a cell by number: i, then j. The opposite of k is 3 - k.
constexpr std::size_t kCellPosts = 4;
/// Neighbours: the posts of the quarters.
constexpr std::array<std::array<std::size_t, 2>, 4> kQuarters = {{{0, 1}, {1, 3}, {3, 2}, {2, 0}}};

/// The quarters of a cell that lie in a triangle, of one that leaves parts of cells all that touch
/// it.
std::array<bool, 4> quartersIn(const Triangle& triangle, const Overlap& overlap, std::int32_t i,
                               std::int32_t j) {
    if (!crossesCellsAtPosts(triangle)) {
        const bool meets = overlap.meets(i, j, 1);
        return {meets, meets, meets, meets};
    }
    std::array<bool, kCellPosts> has{};
    for (std::size_t k = 0; k < kCellPosts; ++k)
        has[k] =
            overlap.has(i + static_cast<std::int32_t>(k % 2), j + static_cast<std::int32_t>(k / 2));
    std::array<bool, 4> quarters{};
    if (std::ranges::count(has, true) >= 3)  // with two it is beside the triangle
        for (std::size_t q = 0; q < quarters.size(); ++q)
            quarters[q] = has[kQuarters[q][0]] && has[kQuarters[q][1]];
    return quarters;
}

/// A few points of one hull.
template <typename Point>
struct Few {
    std::array<Point, kCellPosts> points;
    std::size_t count = 0;

    void add(const Point& point) { points[count++] = point; }
    std::span<const Point> all() const& { return {points.data(), count}; }
    void all() && = delete;  // the span would outlive it
};

}  // namespace

struct OutlineError::Cell {
    std::array<Point, kCellPosts> posts;
    std::array<bool, kCellPosts> hasData;
    int data = 0;

    /// Three posts with data make half a cell of ground: two quarters.
    bool hasGround(std::size_t quarter) const {
        const auto [a, b] = kQuarters[quarter];
        return data >= 3 && hasData[a] && hasData[b];
    }
    Point middle(std::size_t k) const { return (posts[k] + posts[3 - k]) * 0.5; }

    Few<Point> ground(std::size_t quarter) const {
        const auto [a, b] = kQuarters[quarter];
        Few<Point> hull;
        for (const std::size_t k : {a, b}) {
            hull.add(posts[k]);
            if (hasData[3 - k])
                hull.add(middle(k));
        }
        return hull;
    }
};

OutlineError::Point OutlineError::place(double i, double j, double z) const {
    const GridFrame& frame = surface_.frame();
    return {frame.perColumn * i + frame.perRow * j, z};
}

OutlineError::Cell OutlineError::cellAt(std::int32_t i, std::int32_t j) {
    Cell cell;
    for (std::size_t k = 0; k < kCellPosts; ++k) {
        const std::int32_t column = i + static_cast<std::int32_t>(k % 2);
        const std::int32_t row = j + static_cast<std::int32_t>(k / 2);
        const auto height = static_cast<double>(surface_.heightAt(column, row));
        cell.posts[k] = place(column, row, height);
        cell.hasData[k] = !std::isnan(height);
        cell.data += cell.hasData[k] ? 1 : 0;
    }
    return cell;
}

void OutlineError::setLines(std::span<const DrawnSide> sides) {
    lines_.clear();
    for (const DrawnSide& side : sides) {
        const Point from = place(side.from.i, side.from.j, side.from.z);
        const Point along = place(side.to.i, side.to.j, side.to.z) - from;
        const double length = glm::dot(along, along);
        lines_.push_back({from, along, length > 0 ? 1 / length : 0});
    }
}

double OutlineError::ofDropped(const Triangle& triangle, std::span<const DrawnSide> drawn,
                               double atLeast) {
    setLines(drawn);
    const PostBounds box(triangle);
    const Overlap overlap(triangle);
    double farthest = atLeast * atLeast;  // squares, as all distances here
    std::size_t last = 0;                 // near one piece of ground, and mostly near the next
    const auto farthestOf = [&](std::span<const Point> points, const Line& line) {
        double greatest = 0;
        for (const Point& point : points) {
            const Point from = point - line.from;
            const double at = std::clamp(glm::dot(from, line.along) * line.perLength, 0.0, 1.0);
            const Point off = from - line.along * at;
            greatest = std::max(greatest, glm::dot(off, off));
        }
        return greatest;
    };
    for (std::int32_t j = box.j0; j < box.j1; ++j)
        for (std::int32_t i = box.i0; i < box.i1; ++i) {
            const std::array<bool, 4> isIn = quartersIn(triangle, overlap, i, j);
            if (std::ranges::count(isIn, true) == 0)
                continue;
            const Cell cell = cellAt(i, j);
            for (std::size_t quarter = 0; quarter < isIn.size(); ++quarter) {
                if (!isIn[quarter] || !cell.hasGround(quarter))
                    continue;
                const Few<Point> ground = cell.ground(quarter);
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t k = 0; k < lines_.size() && nearest > farthest; ++k) {
                    const std::size_t at = (last + k) % lines_.size();
                    if (const double square = farthestOf(ground.all(), lines_[at]);
                        square < nearest) {
                        nearest = square;
                        if (square <= farthest)
                            last = at;
                    }
                }
                farthest = std::max(farthest, nearest);
            }
        }
    return std::max(atLeast, std::sqrt(farthest));
}

double OutlineError::ofDrawn(const Triangle& triangle, double atLeast) {
    std::array<DrawnSide, 3> sides;
    // No point of a triangle is farther from all three corners than its longest side / sqrt(3): the
    // sides seen from it make a full turn, so one of them is seen under 120 degrees or more.
    double rounded = 0;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Corner& corner = triangle[k];
        const Corner& next = triangle[(k + 1) % 3];
        sides[k] = {corner, next};
        const auto height = static_cast<double>(surface_.heightAt(corner.i, corner.j));
        rounded = std::max(rounded, std::abs(height - corner.z));
        longest =
            std::max(longest, std::hypot(surface_.metresAside(corner, next), corner.z - next.z));
    }
    const double worst = ofDropped(triangle, sides, atLeast);
    const double toCorners = longest / std::numbers::sqrt3 + rounded;
    if (toCorners <= worst)
        return worst;
    return crossesCellsAtPosts(triangle) ? farthestDrawn(triangle, worst, toCorners) : toCorners;
}

/// What a triangle draws, from the ground right above or below or from the nearest posts with data.
double OutlineError::farthestDrawn(const Triangle& triangle, double atLeast, double atMost) {
    const PostBounds box(triangle);
    const Overlap overlap(triangle);
    const Point corner = place(triangle[0].i, triangle[0].j, triangle[0].z);
    const Point normal = glm::cross(place(triangle[1].i, triangle[1].j, triangle[1].z) - corner,
                                    place(triangle[2].i, triangle[2].j, triangle[2].z) - corner);
    /// What is drawn right above or below.
    const auto drawnAt = [&](const Point& point) {
        const Point aside = point - corner;
        const double z = corner.z - (normal.x * aside.x + normal.y * aside.y) / normal.z;
        return Point(point.x, point.y, z);
    };
    double farthest = atLeast;
    for (std::int32_t j = box.j0; j < box.j1; ++j)
        for (std::int32_t i = box.i0; i < box.i1; ++i) {
            const std::array<bool, 4> isIn = quartersIn(triangle, overlap, i, j);
            const Cell cell = cellAt(i, j);
            for (std::size_t quarter = 0; quarter < isIn.size(); ++quarter) {
                if (!isIn[quarter])
                    continue;
                double most = atMost;
                if (cell.hasGround(quarter)) {
                    // Heights above a plane are linear, too: greatest at the hull's points.
                    const Few<Point> ground = cell.ground(quarter);
                    double upright = 0;
                    for (const Point& point : ground.all())
                        upright = std::max(upright, std::abs(point.z - drawnAt(point).z));
                    most = std::min(most, upright);
                }
                if (most <= farthest)
                    continue;
                const auto [a, b] = kQuarters[quarter];
                const std::array<Point, 3> drawn = {drawnAt(cell.posts[a]), drawnAt(cell.posts[b]),
                                                    drawnAt(place(i + 0.5, j + 0.5, 0))};
                farthest = std::max(farthest, nearestPost(triangle, i, j, drawn, farthest, most));
            }
        }
    return farthest;
}

/// How near the post with data is that `points` are nearest to, of those around a cell; `atMost`
/// where none is nearer, anything up to `enough` where one is as near as that.
double OutlineError::nearestPost(const Triangle& triangle, std::int32_t i, std::int32_t j,
                                 std::span<const Point> points, double enough, double atMost) {
    constexpr std::int32_t kMostAround = 8;  // posts
    const PostBounds box(triangle);          // what lies in it has been read
    double nearest = atMost;
    for (std::int32_t r = 0; r <= kMostAround && nearest > enough; ++r)
        for (std::int32_t row = std::max(box.j0, j - r); row <= std::min(box.j1, j + 1 + r); ++row)
            for (std::int32_t column = std::max(box.i0, i - r);
                 column <= std::min(box.i1, i + 1 + r); ++column) {
                const bool isNew =
                    row == j - r || row == j + 1 + r || column == i - r || column == i + 1 + r;
                if (!isNew)
                    continue;
                const auto height = static_cast<double>(surface_.heightAt(column, row));
                if (std::isnan(height))
                    continue;
                const Point post = place(column, row, height);
                double greatest = 0;
                for (const Point& point : points)
                    greatest = std::max(greatest, glm::distance(point, post));
                nearest = std::min(nearest, greatest);
            }
    return nearest;
}

double OutlineError::around(const Triangle& triangle) {
    const PostBounds box(triangle);
    const GridFrame& frame = surface_.frame();
    const std::int32_t around = std::max(box.i1 - box.i0, box.j1 - box.j0);
    float lowest = std::numeric_limits<float>::infinity();
    float highest = -lowest;
    for (std::int32_t j = std::max(0, box.j0 - around);
         j <= std::min(frame.rows - 1, box.j1 + around); ++j)
        for (std::int32_t i = std::max(0, box.i0 - around);
             i <= std::min(frame.columns - 1, box.i1 + around); ++i) {
            const float height = surface_.heightAt(i, j);
            lowest = height < lowest ? height : lowest;
            highest = height > highest ? height : highest;
        }
    const double aside = 2 * surface_.longestEdgeMetres(triangle);
    return highest > lowest
               ? std::hypot(aside, static_cast<double>(highest) - static_cast<double>(lowest))
               : aside;
}

}  // namespace eyrie::terrain
