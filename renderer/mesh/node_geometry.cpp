// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/node_geometry.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <glm/vec3.hpp>

#include "renderer/mesh/codec/open_edges.h"
#include "renderer/mesh/morton.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

std::uint64_t keyOf(const PackedMesh& mesh, const Triangle& corners) {
    return mortonKey((unpackPosition(mesh.positions[corners[0]]) +
                      unpackPosition(mesh.positions[corners[1]]) +
                      unpackPosition(mesh.positions[corners[2]])) /
                     3U);
}

std::vector<Triangle> alongMortonCurve(const PackedMesh& mesh,
                                       std::span<const Triangle> triangles) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(triangles.size());
    for (const Triangle& triangle : triangles)
        keys.emplace_back(keyOf(mesh, triangle), static_cast<std::uint32_t>(keys.size()));
    std::sort(keys.begin(), keys.end());
    std::vector<Triangle> order;
    order.reserve(keys.size());
    for (const auto& [key, triangle] : keys) order.push_back(triangles[triangle]);
    return order;
}

/// Numbers a mesh's vertices in the order they are asked for: an open hash table.
class LocalIndices {
public:
    explicit LocalIndices(std::size_t corners)
        : slots_(std::bit_ceil(corners * 2 + 2), Slot{0, kFree}), mask_(slots_.size() - 1) {}

    /// The local index of `vertex`, and whether it is new.
    std::pair<std::uint16_t, bool> number(std::uint32_t vertex) {
        std::size_t at = (vertex * 0x9E3779B97F4A7C15ULL >> 32) & mask_;
        while (slots_[at].local != kFree && slots_[at].vertex != vertex) at = (at + 1) & mask_;
        const bool isNew = slots_[at].local == kFree;
        if (isNew)
            slots_[at] = {vertex, count_++};
        return {static_cast<std::uint16_t>(slots_[at].local), isNew};
    }

private:
    static constexpr std::uint32_t kFree = 0xFFFFFFFF;
    struct Slot {
        std::uint32_t vertex;
        std::uint32_t local;
    };
    std::vector<Slot> slots_;
    std::size_t mask_;
    std::uint32_t count_ = 0;
};

/// So that a page need not say where they begin. Vertices keep their order of first use: on a
/// shared edge both are known.
void turnToSharedEdges(std::vector<std::uint16_t>& indices) {
    OpenEdges edges;
    std::uint32_t seen = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const std::span<std::uint16_t, 3> corners(indices.data() + i, 3);
        std::uint32_t turn = 0;
        const std::uint32_t age = edges.find(corners, turn);
        std::rotate(corners.begin(), corners.begin() + turn, corners.end());
        if (age == OpenEdges::kNone) {
            edges.openAll(corners);
        } else {
            const OpenEdge edge = edges.at(age);
            edges.close(age);
            edges.join(edge, corners[2], corners[2] == seen);
        }
        for (const std::uint16_t corner : corners) seen += corner == seen ? 1 : 0;
    }
}

}  // namespace

PackedNode gatherNode(const PackedMesh& mesh, std::span<const std::span<const Triangle>> parts) {
    PackedNode node;
    std::size_t corners = 0;
    for (const std::span<const Triangle> part : parts) corners += part.size() * 3;
    node.indices.reserve(corners);
    LocalIndices local(corners);
    const auto add = [&](std::uint32_t vertex) {
        const auto [index, isNew] = local.number(vertex);
        node.indices.push_back(index);
        if (!isNew)
            return;
        node.positions.push_back(mesh.positions[vertex]);
        node.normals.push_back(mesh.normals[vertex]);
        if (!mesh.colours.empty())
            node.colours.push_back(mesh.colours[vertex]);
        if (!mesh.textureCoordinates.empty())
            node.textureCoordinates.push_back(mesh.textureCoordinates[vertex]);
        if (!mesh.exact.empty())
            node.exact.push_back(mesh.exact[vertex]);
    };
    for (const std::span<const Triangle> part : parts)
        for (const Triangle& triangle : alongMortonCurve(mesh, part))
            for (const std::uint32_t vertex : triangle) add(vertex);
    turnToSharedEdges(node.indices);
    return node;
}

}  // namespace eyrie::mesh
