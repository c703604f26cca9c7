// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/backs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::terrain {
namespace {

using fabric::Vec3;

bool isOverACell(const EytIndex& index, const Vec3& eye) {
    const Vec3 post(glm::inverse(index.objectFromLattice) * fabric::Vec4(eye.x, eye.y, 0, 1));
    return post.x >= 0 && post.y >= 0 && post.x <= index.quadtree.columns() - 1 &&
           post.y <= index.quadtree.rows() - 1;
}

/// How far from the eye the near plane cuts, at most.
double nearDistance(const lod::ObjectView& view) {
    const fabric::Frustum& frustum = view.view().frustum;
    const double x = std::max(std::abs(frustum.left), std::abs(frustum.right));
    const double y = std::max(std::abs(frustum.bottom), std::abs(frustum.top));
    double stretch = 0;
    for (int axis = 0; axis < 3; ++axis) stretch += glm::length(Vec3(view.objectFromView()[axis]));
    return fabric::kNearMetres * std::sqrt(1 + x * x + y * y) * stretch;
}

}  // namespace

bool hidesItsBacks(const EytIndex& index, const TerrainCut& drawn, const lod::ObjectView& view) {
    const Vec3 eye(view.objectFromView()[3]);
    if (index.nodataPosts > 0 || !isOverACell(index, eye))
        return false;
    const double reach = nearDistance(view);
    return std::none_of(drawn.tiles.begin(), drawn.tiles.end(), [&](const TileChoice& tile) {
        const fabric::Box box = index.bounds(tile.id).grownBy(reach);
        return eye.x >= box.min.x && eye.x <= box.max.x && eye.y >= box.min.y &&
               eye.y <= box.max.y && eye.z <= box.max.z;
    });
}

}  // namespace eyrie::terrain
