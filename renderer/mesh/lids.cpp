// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lids.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "renderer/mesh/edges.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Edges that may be looked at one by one: one for so many triangles, and a few.
constexpr std::size_t kTrianglesPerOpenEdge = 4;
constexpr std::size_t kFewEdges = 1024;

/// Edges passed more often this way than back, as often as that; nothing where they are too many.
std::optional<std::vector<Edge>> openEdges(const PackedMesh& mesh) {
    const auto candidates =
        edgesLeftOver(mesh, mesh.triangles.size() / kTrianglesPerOpenEdge + kFewEdges);
    if (!candidates)
        return std::nullopt;
    std::vector<Edge> open;
    for (auto at = candidates->begin(); at != candidates->end();) {
        const auto end = std::find_if(at, candidates->end(),
                                      [&](const Edge& edge) { return edge.ends() != at->ends(); });
        const auto turn = std::find_if(at, end, [&](const Edge& e) { return e.from != at->from; });
        const auto there = turn - at;
        const auto back = end - turn;
        if (there > back)
            open.insert(open.end(), at, at + (there - back));
        else
            open.insert(open.end(), turn, turn + (back - there));
        at = end;
    }
    return open;
}

/// Whether at each point as many begin as end, as they do around holes. They do not where an edge
/// was taken for another of the same hash and is not among them.
bool areAroundHoles(const std::vector<Edge>& edges) {
    std::vector<std::uint64_t> begins, ends;
    for (const Edge& edge : edges) {
        begins.push_back(edge.from);
        ends.push_back(edge.to);
    }
    std::sort(begins.begin(), begins.end());
    std::sort(ends.begin(), ends.end());
    return begins == ends;
}

/// Edges by the holes they are around, those that share a point being around one.
class Holes {
public:
    explicit Holes(const std::vector<Edge>& edges) {
        for (const Edge& edge : edges) points_.push_back(edge.from);  // each is left, too
        std::sort(points_.begin(), points_.end());
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        parents_.resize(points_.size());
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
        for (const Edge& edge : edges) join(numberOf(edge.from), numberOf(edge.to));
    }

    /// The same for all edges around one hole: the first of its points.
    std::uint64_t of(const Edge& edge) { return points_[rootOf(numberOf(edge.from))]; }

private:
    std::size_t numberOf(std::uint64_t position) const {
        return static_cast<std::size_t>(std::lower_bound(points_.begin(), points_.end(), position) -
                                        points_.begin());
    }
    std::size_t rootOf(std::size_t point) {
        while (parents_[point] != point) point = parents_[point] = parents_[parents_[point]];
        return point;
    }
    void join(std::size_t a, std::size_t b) {
        const std::size_t rootA = rootOf(a);
        const std::size_t rootB = rootOf(b);
        parents_[std::max(rootA, rootB)] = std::min(rootA, rootB);
    }

    std::vector<std::uint64_t> points_;  ///< sorted
    std::vector<std::size_t> parents_;
};

/// Nothing for a fan without area.
std::optional<fabric::Box> boxAround(const PackedMesh& mesh, std::span<const Triangle> fan) {
    fabric::Box box;
    bool hasArea = false;
    for (const Triangle& triangle : fan) {
        std::array<glm::dvec3, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = glm::dvec3(unpackPosition(mesh.positions[triangle[i]]));
            box.grow(corners[i]);
        }
        // Exact: coordinates have 21 bits.
        hasArea = hasArea ||
                  glm::cross(corners[1] - corners[0], corners[2] - corners[0]) != glm::dvec3(0.0);
    }
    return hasArea ? std::optional(box) : std::nullopt;
}

}  // namespace

std::optional<Lids> findLids(const PackedMesh& mesh) {
    std::optional<std::vector<Edge>> open = openEdges(mesh);
    if (!open || !areAroundHoles(*open))
        return std::nullopt;
    Holes holes(*open);
    std::stable_sort(open->begin(), open->end(),
                     [&](const Edge& a, const Edge& b) { return holes.of(a) < holes.of(b); });
    Lids lids;
    for (auto at = open->begin(); at != open->end();) {
        const std::uint64_t hub = holes.of(*at);
        const auto end =
            std::find_if(at, open->end(), [&](const Edge& edge) { return holes.of(edge) != hub; });
        const std::uint32_t hubVertex =
            std::find_if(at, end, [&](const Edge& edge) { return edge.from == hub; })->fromVertex;
        const std::size_t first = lids.triangles.size();
        for (; at != end; ++at)
            if (at->from != hub && at->to != hub)
                lids.triangles.push_back({hubVertex, at->toVertex, at->fromVertex});
        if (const auto box = boxAround(mesh, std::span(lids.triangles).subspan(first)))
            lids.boxes.push_back(*box);
        if (lids.boxes.size() > kMostLids)
            return std::nullopt;
    }
    return lids;
}

std::uint64_t edgeSum(const std::array<std::uint64_t, 3>& positions) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint64_t from = positions[i];
        const std::uint64_t to = positions[(i + 1) % 3];
        if (from != to)
            sum += from < to ? hashOfEdge(from, to) : 0 - hashOfEdge(from, to);
    }
    return sum;
}

}  // namespace eyrie::mesh
