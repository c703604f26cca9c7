// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/holes.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/geometric.hpp>

namespace eyrie::terrain {
namespace {

using fabric::Box;
using fabric::Vec2;

/// What one looks across, seen from above: the triangles of an eye and the sides of a box, as far
/// as they are nearer than the box and than `reach`.
class Outlook {
public:
    Outlook(const Vec2& eye, const Box& target, double reach)
        : eye_(eye),
          target_(cornersOf(target)),
          nearest_(std::min(distanceTo(target), reach)),
          around_(target) {
        around_.grow(fabric::Vec3(eye, target.min.z));
    }

    bool crosses(const Box& area) const {
        if (distanceTo(area) >= nearest_ || area.max.x < around_.min.x ||
            area.min.x > around_.max.x || area.max.y < around_.min.y || area.min.y > around_.max.y)
            return false;
        const auto corners = cornersOf(area);
        return std::none_of(target_.begin(), target_.end(), [&](const Vec2& towards) {
            return isBeyond(corners, towards - eye_) || isBeyond(corners, eye_ - towards);
        });
    }

private:
    using Corners = std::array<Vec2, 4>;
    static constexpr double kRoundingMetres = 1e-6;

    static Corners cornersOf(const Box& box) {
        return {Vec2(box.min), Vec2(box.max.x, box.min.y), Vec2(box.max),
                Vec2(box.min.x, box.max.y)};
    }
    double distanceTo(const Box& box) const {
        return glm::distance(eye_, glm::clamp(eye_, Vec2(box.min), Vec2(box.max)));
    }
    /// Whether all of the target is left of the line from the eye along `direction`, or on it, and
    /// the corners right of it.
    bool isBeyond(const Corners& corners, const Vec2& direction) const {
        const double length = glm::length(direction);
        const auto left = [&](const Vec2& p) {
            const Vec2 d = p - eye_;
            return (direction.x * d.y - direction.y * d.x) / length;
        };
        return length > 0 &&
               std::all_of(target_.begin(), target_.end(),
                           [&](const Vec2& p) { return left(p) >= -kRoundingMetres / 2; }) &&
               std::all_of(corners.begin(), corners.end(),
                           [&](const Vec2& p) { return left(p) < -kRoundingMetres; });
    }

    Vec2 eye_;
    Corners target_;
    double nearest_;
    Box around_;
};

/// Of one of a tile's 4 x 4 parts; heights are of no meaning.
Box boundsOfPart(const EytIndex& index, const TileId& tile, int x, int y) {
    const int posts = Quadtree::side(tile.level) / kTilePartsPerSide;
    Box box;
    for (const int u : {x, x + 1})
        for (const int v : {y, y + 1})
            box.grow(
                fabric::Vec3(index.objectFromLattice *
                             fabric::Vec4(tile.x * Quadtree::side(tile.level) + u * posts,
                                          tile.y * Quadtree::side(tile.level) + v * posts, 0, 1)));
    return box;
}

bool hasHole(const EytIndex& index, const TileId& tile, std::span<const std::uint32_t> blurred,
             const Outlook& outlook) {
    if (!index.quadtree.contains(tile) || index.tile(tile).nodataParts == 0 ||
        !outlook.crosses(index.bounds(tile)))
        return false;
    if (tile.level > 0 && !std::ranges::binary_search(blurred, index.quadtree.tileIndex(tile)))
        return hasHole(index, Quadtree::child(tile, 0), blurred, outlook) ||
               hasHole(index, Quadtree::child(tile, 1), blurred, outlook) ||
               hasHole(index, Quadtree::child(tile, 2), blurred, outlook) ||
               hasHole(index, Quadtree::child(tile, 3), blurred, outlook);
    for (int y = 0; y < kTilePartsPerSide; ++y)
        for (int x = 0; x < kTilePartsPerSide; ++x)
            if (index.tile(tile).hasNodataIn(x, y, 1) &&
                outlook.crosses(boundsOfPart(index, tile, x, y)))
                return true;
    return false;
}

}  // namespace

bool hasHoleBefore(const EytIndex& index, const Vec2& eye, const Box& target,
                   std::span<const std::uint32_t> blurred, double reach) {
    return index.nodataPosts > 0 &&
           hasHole(index, index.quadtree.top(), blurred, Outlook(eye, target, reach));
}

}  // namespace eyrie::terrain
