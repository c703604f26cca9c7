// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_faces.h"

#include <algorithm>
#include <array>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "fabric/box.h"
#include "renderer/mesh/back_columns.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

using fabric::Box;

/// Pockets of a node that are told apart.
constexpr std::size_t kMostPockets = 64;

bool touch(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

std::array<std::uint64_t, 3> positionsOf(const Surface& mesh, const Triangle& triangle) {
    return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

ColumnGrid gridOf(const Surface& mesh) {
    glm::ivec3 least(static_cast<int>(kMaxLatticeCoordinate));
    glm::ivec3 most(0);
    for (const std::uint64_t position : mesh.positions) {
        least = glm::min(least, glm::ivec3(unpackPosition(position)));
        most = glm::max(most, glm::ivec3(unpackPosition(position)));
    }
    return {least, most, mesh.triangles.size()};
}

}  // namespace

std::optional<std::vector<std::uint32_t>> seenFromBehind(const PackedMesh& mesh, const Lids& lids) {
    if (mesh.triangles.empty())
        return std::nullopt;
    std::vector<Triangle> both;
    if (!lids.triangles.empty()) {
        both = mesh.triangles;
        both.insert(both.end(), lids.triangles.begin(), lids.triangles.end());
    }
    const Surface surface{mesh.positions, both.empty() ? mesh.triangles : both};
    const ColumnGrid grid = gridOf(surface);
    std::uint64_t entries = 0;
    for (const Triangle& triangle : surface.triangles)
        if (const auto reach = grid.reachOf(cornersOf(positionsOf(surface, triangle))))
            entries += reach->columns();
    if (grid.isTooMuch(entries, 0))
        return std::nullopt;
    double comparisons = 0;
    auto found = seenFromBehind(surface, grid, {0, grid.rows}, comparisons);
    if (found)
        std::erase_if(*found, [&](std::uint32_t i) { return i >= mesh.triangles.size(); });
    return found;
}

Box boxOf(const PackedMesh& mesh, const Triangle& triangle) {
    Box box;
    for (const std::uint32_t corner : triangle)
        box.grow(fabric::Vec3(unpackPosition(mesh.positions[corner])));
    return box;
}

void Pockets::addAll() {
    isEverywhere_ = true;
    boxes_.clear();
}

void Pockets::add(Box box) {
    if (isEverywhere_)
        return;
    for (std::size_t i = 0; i < boxes_.size();) {
        if (!touch(box.grownBy(glm::length(box.size()) + glm::length(boxes_[i].size())), boxes_[i]))
            ++i;
        else {
            box.grow(std::exchange(boxes_[i], boxes_.back()));
            boxes_.pop_back();
            i = 0;
        }
    }
    if (boxes_.size() < kMostPockets)
        boxes_.push_back(box);
    else
        nearest(box).grow(box);
}

/// That which takes the box in and grows least by it.
Box& Pockets::nearest(const Box& box) {
    const auto growth = [&](Box pocket) {
        const double before = glm::length(pocket.size());
        pocket.grow(box);
        return glm::length(pocket.size()) - before;
    };
    return *std::min_element(boxes_.begin(), boxes_.end(),
                             [&](const Box& a, const Box& b) { return growth(a) < growth(b); });
}

void Pockets::add(const Pockets& others) {
    if (others.isEverywhere_)
        addAll();
    for (const Box& box : others.boxes_) add(box);
}

bool Pockets::reach(const Box& box, double steps) const {
    return isEverywhere_ || std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& pocket) {
               return touch(pocket.grownBy(steps), box);
           });
}

std::vector<Pockets> gatherPockets(const PackedMesh& mesh, const KdTree& tree,
                                   const std::vector<bool>& isBehind) {
    std::vector<Pockets> pockets(tree.nodes.size());
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {  // children come after their parent
        const KdNode& node = tree.nodes[i];
        if (!node.isLeaf()) {
            pockets[i].add(pockets[static_cast<std::size_t>(node.left)]);
            pockets[i].add(pockets[static_cast<std::size_t>(node.right)]);
            continue;
        }
        for (std::uint64_t k = node.triangleBegin; k < node.triangleEnd; ++k)
            if (isBehind[tree.order[k]])
                pockets[i].add(boxOf(mesh, mesh.triangles[tree.order[k]]));
    }
    return pockets;
}

std::vector<Pockets> pocketsEverywhere(const KdTree& tree) {
    std::vector<Pockets> pockets(tree.nodes.size());
    for (Pockets& node : pockets) node.addAll();
    return pockets;
}

std::vector<Pockets> findPockets(const PackedMesh& mesh, const std::optional<Lids>& lids,
                                 const KdTree& tree) {
    const bool isSeeThrough = std::ranges::any_of(mesh.materials, &Material::isSeeThrough);
    const auto behind = lids && !isSeeThrough ? seenFromBehind(mesh, *lids) : std::nullopt;
    if (!behind)
        return pocketsEverywhere(tree);
    std::vector<bool> isBehind(mesh.triangles.size(), false);
    for (const std::uint32_t triangle : *behind) isBehind[triangle] = true;
    return gatherPockets(mesh, tree, isBehind);
}

Backs findBacks(const PackedMesh& mesh, const KdTree& tree) {
    std::optional<Lids> lids = findLids(mesh);
    Backs backs{findPockets(mesh, lids, tree), {}};
    if (lids)
        backs.lids = std::move(lids->boxes);
    return backs;
}

}  // namespace eyrie::mesh
