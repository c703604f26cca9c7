// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/edges.h"

#include <bit>
#include <tuple>

#include <oneapi/tbb/parallel_sort.h>

namespace eyrie::mesh {
namespace {

/// Triangles for each slot that edges are added up in.
constexpr std::size_t kTrianglesPerSlot = 4;

/// The finalizer of Austin Appleby's MurmurHash3.
std::uint64_t mixed(std::uint64_t value) {
    value = (value ^ value >> 33) * 0xFF51AFD7ED558CCDULL;
    value = (value ^ value >> 33) * 0xC4CEB9FE1A85EC53ULL;
    return value ^ value >> 33;
}

template <typename Visit>
void forEdges(const PackedMesh& mesh, const Visit& visit) {
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = mesh.triangles[k][i];
            const std::uint32_t to = mesh.triangles[k][(i + 1) % 3];
            if (mesh.positions[from] != mesh.positions[to])
                visit(Edge{mesh.positions[from], mesh.positions[to], from, to, k});
        }
}

/// Each edge adds its hash to its slot where it is passed one way, and takes it off where the
/// other: slots with something left hold those that are left over.
std::vector<std::uint64_t> addedUp(const PackedMesh& mesh) {
    std::vector<std::uint64_t> slots(std::bit_ceil(mesh.triangles.size() / kTrianglesPerSlot + 1));
    forEdges(mesh, [&](const Edge& edge) {
        const std::uint64_t hash = hashOfEdge(edge.from, edge.to);
        slots[hash & (slots.size() - 1)] += edge.from < edge.to ? hash : 0 - hash;
    });
    return slots;
}

}  // namespace

std::uint64_t hashOfEdge(std::uint64_t from, std::uint64_t to) {
    return mixed(mixed(std::min(from, to)) + std::max(from, to));
}

std::optional<std::vector<Edge>> edgesLeftOver(const PackedMesh& mesh, std::size_t most) {
    const std::vector<std::uint64_t> slots = addedUp(mesh);
    std::vector<Edge> edges;
    edges.reserve(std::min(most, 3 * mesh.triangles.size()));  // no memory until it is written
    forEdges(mesh, [&](const Edge& edge) {
        if (slots[hashOfEdge(edge.from, edge.to) & (slots.size() - 1)] != 0 && edges.size() <= most)
            edges.push_back(edge);
    });
    if (edges.size() > most)
        return std::nullopt;
    oneapi::tbb::parallel_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return std::tuple(a.ends(), a.from, a.fromVertex, a.toVertex, a.triangle) <
               std::tuple(b.ends(), b.from, b.fromVertex, b.toVertex, b.triangle);
    });
    return edges;
}

}  // namespace eyrie::mesh
