// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/sheet_ends.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_for.h>

#include "renderer/mesh/edges.h"
#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Lattice steps within which two sheets touch.
constexpr float kTouch = 3;
constexpr std::uint32_t kLeafEnds = 8;
/// Ends that may be looked at for one triangle: one with more around it counts as touched.
constexpr int kMostLooks = 1024;

glm::vec3 pointOf(std::uint64_t packed) { return glm::vec3(unpackPosition(packed)); }

double squareOf(const glm::dvec3& way) { return glm::dot(way, way); }

using Segment = std::array<glm::dvec3, 2>;

double shareOf(const glm::dvec3& at, const Segment& segment) {
    const glm::dvec3 along = segment[1] - segment[0];
    return std::clamp(glm::dot(at - segment[0], along) / squareOf(along), 0.0, 1.0);
}

glm::dvec3 pointAt(const Segment& segment, double share) {
    return segment[0] + share * (segment[1] - segment[0]);
}

/// Both of some length.
double squareDistance(const Segment& a, const Segment& b) {
    const glm::dvec3 alongA = a[1] - a[0];
    const glm::dvec3 alongB = b[1] - b[0];
    const glm::dvec3 between = a[0] - b[0];
    const double cosine = glm::dot(alongA, alongB);
    const double determinant = squareOf(alongA) * squareOf(alongB) - cosine * cosine;
    double least = std::numeric_limits<double>::infinity();
    if (determinant > 0) {
        const double share =
            (cosine * glm::dot(alongB, between) - squareOf(alongB) * glm::dot(alongA, between)) /
            determinant;
        const glm::dvec3 at = pointAt(a, std::clamp(share, 0.0, 1.0));
        least = squareOf(pointAt(b, shareOf(at, b)) - at);
    }
    for (const auto& [point, segment] :
         {std::pair(a[0], b), std::pair(a[1], b), std::pair(b[0], a), std::pair(b[1], a)})
        least = std::min(least, squareOf(pointAt(segment, shareOf(point, segment)) - point));
    return least;
}

/// A triangle that others' ends may touch.
class Touched {
public:
    explicit Touched(const std::array<glm::vec3, 3>& corners)
        : corners_{glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])},
          packed_(corners) {
        const glm::dvec3 normal = glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
        const double length = glm::length(normal);
        if (length > 0)
            normal_ = normal / length;
    }

    glm::vec3 low() const { return glm::min(packed_[0], glm::min(packed_[1], packed_[2])); }
    glm::vec3 high() const { return glm::max(packed_[0], glm::max(packed_[1], packed_[2])); }

    bool isBy(const SheetEnds::End& end) const {
        for (const glm::vec3& corner : packed_)
            if (corner == end.from || corner == end.to)
                return false;
        const Segment segment{glm::dvec3(end.from), glm::dvec3(end.to)};
        const std::array above{glm::dot(segment[0] - corners_[0], normal_),
                               glm::dot(segment[1] - corners_[0], normal_)};
        if (std::min(above[0], above[1]) > kTouch || std::max(above[0], above[1]) < -kTouch)
            return false;
        for (std::size_t i = 0; i < 2; ++i)
            if (std::abs(above[i]) <= kTouch && isAbove(segment[i]))
                return true;
        for (std::size_t k = 0; k < 3; ++k)
            if (squareDistance(segment, {corners_[k], corners_[(k + 1) % 3]}) <= kTouch * kTouch)
                return true;
        return false;
    }

private:
    /// Or below: of the inside, not beside it.
    bool isAbove(const glm::dvec3& at) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (glm::dot(glm::cross(corners_[(k + 1) % 3] - corners_[k], at - corners_[k]),
                         normal_) < 0)
                return false;
        return true;
    }

    std::array<glm::dvec3, 3> corners_;
    std::array<glm::vec3, 3> packed_;
    glm::dvec3 normal_{0.0};
};

/// Edges that one triangle has alone.
std::vector<Edge> edgesAlone(const PackedMesh& mesh) {
    std::vector<Edge> edges = edgesLeftOver(mesh, std::numeric_limits<std::size_t>::max()).value();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < edges.size();) {
        const std::size_t first = i;
        while (i < edges.size() && edges[i].ends() == edges[first].ends()) ++i;
        if (i == first + 1)
            edges[kept++] = edges[first];
    }
    edges.resize(kept);
    return edges;
}

}  // namespace

SheetEnds::SheetEnds(const PackedMesh& mesh, std::span<const std::uint32_t> goesOnAt) {
    std::vector<bool> goesOn(mesh.positions.size());
    for (const std::uint32_t vertex : goesOnAt) goesOn[vertex] = true;
    {
        const std::vector<Edge> edges = edgesAlone(mesh);
        ends_.reserve(edges.size());
        for (const Edge& edge : edges)
            if (!goesOn[edge.fromVertex] || !goesOn[edge.toVertex])
                ends_.push_back({pointOf(edge.from), pointOf(edge.to), edge.triangle});
    }
    if (!ends_.empty())
        build(0, static_cast<std::uint32_t>(ends_.size()));
}

std::uint32_t SheetEnds::build(std::uint32_t begin, std::uint32_t end) {
    Box box = boxOf(ends_[begin]);
    for (std::uint32_t i = begin; i < end; ++i) {
        box.low = glm::min(box.low, boxOf(ends_[i]).low);
        box.high = glm::max(box.high, boxOf(ends_[i]).high);
    }
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({box, begin, end, 0});
    if (end - begin <= kLeafEnds)
        return index;
    const glm::vec3 size = box.high - box.low;
    const int wider = size.y > size.x ? 1 : 0;
    const int axis = size.z > size[wider] ? 2 : wider;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(ends_.begin() + begin, ends_.begin() + middle, ends_.begin() + end,
                     [axis](const End& a, const End& b) {
                         return a.from[axis] + a.to[axis] < b.from[axis] + b.to[axis];
                     });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[index].right = right;
    return index;
}

namespace {

/// Of each vertex, whether its own sheet ends there: 1, else 0.
std::vector<std::uint8_t> whereItEnds(const PackedMesh& mesh, const SheetEnds& ends) {
    std::vector<std::uint8_t> result(mesh.positions.size(), 0);
    for (const SheetEnds::End& end : ends.all())
        for (const std::uint32_t vertex : mesh.triangles[end.triangle]) {
            const glm::vec3 at = pointOf(mesh.positions[vertex]);
            if (at == end.from || at == end.to)
                result[vertex] = 1;
        }
    return result;
}

}  // namespace

std::vector<std::uint8_t> whereOthersEnd(const PackedMesh& mesh, const SheetEnds& ends) {
    if (ends.all().empty())
        return std::vector<std::uint8_t>(mesh.positions.size(), 0);
    const std::vector<std::uint8_t> isEnd = whereItEnds(mesh, ends);
    std::vector<std::uint8_t> result = isEnd;
    tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t i) {
        const Triangle& triangle = mesh.triangles[i];
        if (std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return isEnd[vertex] != 0; }))
            return;
        const Touched touched({pointOf(mesh.positions[triangle[0]]),
                               pointOf(mesh.positions[triangle[1]]),
                               pointOf(mesh.positions[triangle[2]])});
        int looks = 0;
        const auto touches = [&](const SheetEnds::End& end) {
            return ++looks > kMostLooks || touched.isBy(end);
        };
        if (!ends.anyNear(touched.low(), touched.high(), kTouch, touches))
            return;
        for (const std::uint32_t vertex : triangle)
            std::atomic_ref(result[vertex]).store(1, std::memory_order_relaxed);
    });
    return result;
}

}  // namespace eyrie::mesh
