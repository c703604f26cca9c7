// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/shared_points.h"

#include <bit>
#include <cstddef>
#include <limits>

namespace eyrie::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Of each vertex, the first at its position. With an open hash table.
std::vector<std::uint32_t> firstAtPositions(std::span<const std::uint64_t> positions) {
    std::vector<std::uint32_t> slots(std::bit_ceil(positions.size() + positions.size() / 2 + 2),
                                     kNone);
    std::vector<std::uint32_t> result;
    result.reserve(positions.size());
    for (std::uint32_t vertex = 0; vertex < positions.size(); ++vertex) {
        std::size_t slot = (positions[vertex] * 0x9E3779B97F4A7C15ULL >> 32) & (slots.size() - 1);
        while (slots[slot] != kNone && positions[slots[slot]] != positions[vertex])
            slot = (slot + 1) & (slots.size() - 1);
        if (slots[slot] == kNone)
            slots[slot] = vertex;
        result.push_back(slots[slot]);
    }
    return result;
}

/// The first and the last of tree.order that have a corner there.
struct Span {
    std::uint32_t first = kNone;
    std::uint32_t last = 0;
};

/// Of the smallest node that has all of them, and one.
std::uint8_t depthBelow(const KdTree& tree, const Span& span) {
    std::uint8_t depth = 1;
    for (const KdNode* node = &tree.nodes.front(); !node->isLeaf(); ++depth) {
        const KdNode& left = tree.nodes[static_cast<std::size_t>(node->left)];
        if (span.last < left.triangleEnd)
            node = &left;
        else if (span.first >= left.triangleEnd)
            node = &tree.nodes[static_cast<std::size_t>(node->right)];
        else
            break;
    }
    return depth;
}

}  // namespace

std::vector<std::uint8_t> sharedFrom(const PackedMesh& mesh, const KdTree& tree,
                                     std::span<const std::uint32_t> goesOnAt) {
    std::vector<std::uint8_t> result(mesh.positions.size(), 0);
    if (tree.nodes.empty())
        return result;
    const std::vector<std::uint32_t> firstOf = firstAtPositions(mesh.positions);
    std::vector<Span> spans(mesh.positions.size());
    for (std::uint32_t i = 0; i < tree.order.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[tree.order[i]]) {
            Span& span = spans[firstOf[vertex]];
            if (span.first == kNone)
                span.first = i;
            span.last = i;
        }
    std::vector<bool> goesOn(mesh.positions.size());
    for (const std::uint32_t vertex : goesOnAt) goesOn[firstOf[vertex]] = true;
    for (std::uint32_t vertex = 0; vertex < result.size(); ++vertex) {
        const std::uint32_t first = firstOf[vertex];
        if (first < vertex)
            result[vertex] = result[first];
        else if (!goesOn[vertex])
            result[vertex] = depthBelow(tree, spans[vertex]);
    }
    return result;
}

}  // namespace eyrie::mesh
