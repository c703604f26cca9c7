// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/closing_pieces.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <oneapi/tbb/parallel_for.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

/// Share of a piece's width within which it touches others.
constexpr double kTouch = 1.0 / 4;
/// Lattice steps: what touched in the source still does.
constexpr double kLeastTouch = 3;
/// Ends that may be looked at for one point: one with more around it touches some.
constexpr int kMostLooks = 64;

glm::dvec3 pointOf(std::uint64_t packed) { return glm::dvec3(unpackPosition(packed)); }

bool comesFirst(const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

double distance(const glm::dvec3& at, const SheetEnds::End& end) {
    const glm::dvec3 from(end.from);
    const glm::dvec3 along = glm::dvec3(end.to) - from;
    const double share = glm::dot(at - from, along) / glm::dot(along, along);
    return glm::distance(from + std::clamp(share, 0.0, 1.0) * along, at);
}

/// Of each piece, as of a strip: its area over half of the length of its ends.
std::vector<double> widthsOf(const PackedMesh& mesh, const SheetEnds& ends,
                             std::span<const std::uint32_t> pieceOf, std::size_t count) {
    std::vector<double> areas(count, 0.0);
    for (const Triangle& triangle : mesh.triangles) {
        const glm::dvec3 first = pointOf(mesh.positions[triangle[0]]);
        areas[pieceOf[triangle[0]]] +=
            0.5 * glm::length(glm::cross(pointOf(mesh.positions[triangle[1]]) - first,
                                         pointOf(mesh.positions[triangle[2]]) - first));
    }
    std::vector<double> lengths(count, 0.0);
    for (const SheetEnds::End& end : ends.all())
        lengths[pieceOf[mesh.triangles[end.triangle][0]]] +=
            glm::distance(glm::dvec3(end.from), glm::dvec3(end.to));
    for (std::size_t i = 0; i < count; ++i)
        areas[i] = lengths[i] > 0 ? 2 * areas[i] / lengths[i] : 0.0;
    return areas;
}

}  // namespace

std::vector<bool> closingPieces(const PackedMesh& mesh, const SheetEnds& ends,
                                std::span<const std::uint32_t> pieceOf, std::size_t count) {
    const auto pieceOfEnd = [&](const SheetEnds::End& end) {
        return pieceOf[mesh.triangles[end.triangle][0]];
    };
    const std::span<const SheetEnds::End> all = ends.all();
    std::vector<std::uint32_t> byPiece(all.size());
    std::iota(byPiece.begin(), byPiece.end(), 0U);
    std::ranges::sort(byPiece, {},
                      [&](std::uint32_t i) { return std::pair(pieceOfEnd(all[i]), i); });

    std::vector<std::size_t> firsts;  // of each piece that ends anywhere
    for (std::size_t i = 0; i < byPiece.size(); ++i)
        if (i == 0 || pieceOfEnd(all[byPiece[i]]) != pieceOfEnd(all[byPiece[i - 1]]))
            firsts.push_back(i);
    firsts.push_back(byPiece.size());

    const std::vector<double> widths = widthsOf(mesh, ends, pieceOf, count);
    std::vector<std::uint8_t> isClosing(count, 0);
    tbb::parallel_for(std::size_t{1}, firsts.size(), [&](std::size_t k) {
        const std::uint32_t piece = pieceOfEnd(all[byPiece[firsts[k - 1]]]);
        std::vector<glm::vec3> points;  // where it ends
        for (std::size_t i = firsts[k - 1]; i < firsts[k]; ++i)
            points.insert(points.end(), {all[byPiece[i]].from, all[byPiece[i]].to});
        std::sort(points.begin(), points.end(), comesFirst);
        points.erase(std::unique(points.begin(), points.end()), points.end());
        const double reach = std::max(kLeastTouch, kTouch * widths[piece]);
        const auto touching = std::ranges::count_if(points, [&](const glm::vec3& at) {
            int looks = 0;
            return ends.anyNear(
                at, at, static_cast<float>(reach) + 1, [&](const SheetEnds::End& end) {
                    return ++looks > kMostLooks ||
                           (pieceOfEnd(end) != piece && distance(glm::dvec3(at), end) <= reach);
                });
        });
        isClosing[piece] = 3 * static_cast<std::size_t>(touching) >= 2 * points.size() ? 1 : 0;
    });
    return {isClosing.begin(), isClosing.end()};
}

}  // namespace eyrie::mesh
