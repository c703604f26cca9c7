// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/back_faces.h"

#include <algorithm>
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

/// The finalizer of Austin Appleby's MurmurHash3.
std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 33) * 0xFF51AFD7ED558CCDULL;
    value = (value ^ value >> 33) * 0xC4CEB9FE1A85EC53ULL;
    return value ^ value >> 33;
}

bool touch(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

std::array<std::uint64_t, 3> positionsOf(const PackedMesh& mesh, const Triangle& triangle) {
    return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

ColumnGrid gridOf(const PackedMesh& mesh) {
    glm::ivec3 least(static_cast<int>(kMaxLatticeCoordinate));
    glm::ivec3 most(0);
    for (const std::uint64_t position : mesh.positions) {
        least = glm::min(least, glm::ivec3(unpackPosition(position)));
        most = glm::max(most, glm::ivec3(unpackPosition(position)));
    }
    return {least, most, mesh.triangles.size()};
}

}  // namespace

std::uint64_t edgeSum(const std::array<std::uint64_t, 3>& positions) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint64_t from = positions[i];
        const std::uint64_t to = positions[(i + 1) % 3];
        const std::uint64_t edge = mixed(mixed(std::min(from, to)) + std::max(from, to));
        sum += from < to ? edge : from > to ? 0 - edge : 0;
    }
    return sum;
}

std::optional<std::vector<std::uint32_t>> seenFromBehind(const PackedMesh& mesh) {
    std::uint64_t edges = 0;
    for (const Triangle& triangle : mesh.triangles) edges += edgeSum(positionsOf(mesh, triangle));
    if (mesh.triangles.empty() || edges != 0)
        return std::nullopt;
    const ColumnGrid grid = gridOf(mesh);
    std::uint64_t entries = 0;
    for (const Triangle& triangle : mesh.triangles)
        if (const auto reach = grid.reachOf(cornersOf(positionsOf(mesh, triangle))))
            entries += reach->columns();
    if (grid.isTooMuch(entries, 0))
        return std::nullopt;
    double comparisons = 0;
    return seenFromBehind(mesh, grid, {0, grid.rows}, comparisons);
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
    boxes_.push_back(box);
    if (boxes_.size() > kMostPockets)
        addAll();
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

std::vector<Pockets> findPockets(const PackedMesh& mesh, const KdTree& tree) {
    const auto behind = seenFromBehind(mesh);
    if (!behind)
        return pocketsEverywhere(tree);
    std::vector<bool> isBehind(mesh.triangles.size(), false);
    for (const std::uint32_t triangle : *behind) isBehind[triangle] = true;
    return gatherPockets(mesh, tree, isBehind);
}

}  // namespace eyrie::mesh
