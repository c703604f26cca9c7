// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::import {
namespace {

constexpr std::size_t kBlockTriangles = 65536;
constexpr std::size_t kGrain = 4096;

/// Shorter than this the sum of unit normals is rounding only.
constexpr float kCancelled = 1e-4F;

struct Facet {
    glm::vec3 normal;
    std::array<float, 3> angles;
};

float angleBetween(const glm::vec3& a, const glm::vec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0F, 1.0F));
}

/// Lattice coordinates are exact in float, so is the difference of two; double holds the product.
Facet facetOf(std::span<const std::uint64_t> positions, const mesh::Triangle& corners) {
    const glm::dvec3 a(mesh::unpackPosition(positions[corners[0]]));
    const glm::dvec3 b(mesh::unpackPosition(positions[corners[1]]));
    const glm::dvec3 c(mesh::unpackPosition(positions[corners[2]]));
    const glm::vec3 ab(glm::normalize(b - a));
    const glm::vec3 bc(glm::normalize(c - b));
    const glm::vec3 ca(glm::normalize(a - c));
    return {glm::vec3(glm::normalize(glm::cross(b - a, c - a))),
            {angleBetween(ab, -ca), angleBetween(bc, -ab), angleBetween(ca, -bc)}};
}

constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

/// Sums up the triangles of a mesh at its vertices, block after block.
class NormalSums {
public:
    NormalSums(std::span<const std::uint64_t> positions, std::span<const mesh::Triangle> triangles)
        : positions_(positions),
          triangles_(triangles),
          sums_(positions.size(), glm::vec3(0.0F)),
          firstTriangle_(positions.size(), kNoTriangle) {}

    /// Threads work on the facets; the sums are taken by one, in the triangles' order.
    void addBlock(std::size_t begin, std::size_t end) {
        facets_.resize(end - begin);
        oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(begin, end, kGrain),
                                  [&](const auto& part) {
                                      for (std::size_t i = part.begin(); i != part.end(); ++i)
                                          facets_[i - begin] = facetOf(positions_, triangles_[i]);
                                  });
        for (std::size_t i = begin; i < end; ++i)
            addFacet(static_cast<std::uint32_t>(i), facets_[i - begin]);
    }

    std::vector<glm::vec3> normals() && {
        for (std::size_t v = 0; v < sums_.size(); ++v) {
            const float length = glm::length(sums_[v]);
            if (length > kCancelled)
                sums_[v] /= length;
            else if (firstTriangle_[v] != kNoTriangle)
                sums_[v] = facetOf(positions_, triangles_[firstTriangle_[v]]).normal;
            else
                sums_[v] = glm::vec3(0, 0, 1);
        }
        return std::move(sums_);
    }

private:
    void addFacet(std::uint32_t triangle, const Facet& facet) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangles_[triangle][corner];
            sums_[vertex] += facet.normal * facet.angles[corner];
            firstTriangle_[vertex] = std::min(firstTriangle_[vertex], triangle);
        }
    }

    std::span<const std::uint64_t> positions_;
    std::span<const mesh::Triangle> triangles_;
    std::vector<glm::vec3> sums_;
    std::vector<std::uint32_t> firstTriangle_;
    std::vector<Facet> facets_;
};

/// Corners of triangles by vertex, those of one in the order of the triangles.
class CornersByVertex {
public:
    CornersByVertex(std::span<const mesh::Triangle> triangles, std::size_t vertices)
        : end_(vertices + 1, 0), corners_(triangles.size() * 3) {
        for (const mesh::Triangle& triangle : triangles)
            for (const std::uint32_t vertex : triangle) ++end_[vertex + 1];
        for (std::size_t i = 1; i < end_.size(); ++i) end_[i] += end_[i - 1];
        for (std::uint32_t i = 0; i < triangles.size(); ++i)
            for (std::uint32_t c = 0; c < 3; ++c) corners_[end_[triangles[i][c]]++] = 3 * i + c;
    }

    /// 3 * triangle + corner, each.
    std::span<const std::uint32_t> of(std::size_t vertex) const {
        const std::size_t begin = vertex == 0 ? 0 : end_[vertex - 1];
        return std::span(corners_).subspan(begin, end_[vertex] - begin);
    }

private:
    std::vector<std::uint32_t> end_;
    std::vector<std::uint32_t> corners_;
};

/// Puts the corners around one vertex after the other into groups without creases.
class CreaseGroups {
public:
    CreaseGroups(std::span<const mesh::Triangle> triangles, std::span<const Facet> facets,
                 double creaseRadians)
        : triangles_(triangles),
          facets_(facets),
          leastCosine_(static_cast<float>(std::cos(creaseRadians))) {}

    /// Per corner, the first one of its group.
    const std::vector<std::uint32_t>& of(std::span<const std::uint32_t> corners) {
        leader_.resize(corners.size());
        spokes_.clear();
        for (std::uint32_t i = 0; i < corners.size(); ++i) {
            leader_[i] = i;
            const mesh::Triangle& triangle = triangles_[corners[i] / 3];
            spokes_.push_back({triangle[(corners[i] % 3 + 1) % 3], i});
            spokes_.push_back({triangle[(corners[i] % 3 + 2) % 3], i});
        }
        std::sort(spokes_.begin(), spokes_.end());
        for (std::size_t i = 0; i < spokes_.size(); ++i)
            for (std::size_t j = i + 1; j < std::min(spokes_.size(), i + kMostAtAnEdge) &&
                                        spokes_[j].first == spokes_[i].first;
                 ++j)
                joinIfSmooth(corners, spokes_[i].second, spokes_[j].second);
        for (std::uint32_t i = 0; i < corners.size(); ++i) leader_[i] = leaderOf(i);
        return leader_;
    }

private:
    /// Triangles at one edge that are compared with each other; a limit on the work only.
    static constexpr std::size_t kMostAtAnEdge = 32;

    std::uint32_t leaderOf(std::uint32_t i) {
        while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
        return i;
    }

    void joinIfSmooth(std::span<const std::uint32_t> corners, std::uint32_t a, std::uint32_t b) {
        if (glm::dot(facets_[corners[a] / 3].normal, facets_[corners[b] / 3].normal) < leastCosine_)
            return;
        const std::uint32_t first = leaderOf(a);
        const std::uint32_t second = leaderOf(b);
        leader_[std::max(first, second)] = std::min(first, second);
    }

    std::span<const mesh::Triangle> triangles_;
    std::span<const Facet> facets_;
    float leastCosine_;
    std::vector<std::uint32_t> leader_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> spokes_;  ///< other end, corner
};

std::vector<Facet> facetsOf(std::span<const std::uint64_t> positions,
                            std::span<const mesh::Triangle> triangles) {
    std::vector<Facet> facets(triangles.size());
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, triangles.size(), kGrain),
                              [&](const auto& part) {
                                  for (std::size_t i = part.begin(); i != part.end(); ++i)
                                      facets[i] = facetOf(positions, triangles[i]);
                              });
    return facets;
}

/// The normals of the corners at one vertex, into `normals`.
void addUpGroups(std::span<const std::uint32_t> corners, const std::vector<std::uint32_t>& leader,
                 std::span<const Facet> facets, std::vector<glm::vec3>& normals) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Facet& facet = facets[corners[i] / 3];
        normals[corners[leader[i]]] += facet.normal * facet.angles[corners[i] % 3];
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {  // leaders come before those they lead
        glm::vec3& sum = normals[corners[leader[i]]];
        if (leader[i] != i)
            normals[corners[i]] = sum;
        else if (const float length = glm::length(sum); length > kCancelled)
            sum /= length;
        else
            sum = facets[corners[i] / 3].normal;
    }
}

}  // namespace

std::vector<glm::vec3> smoothNormals(std::span<const std::uint64_t> positions,
                                     std::span<const mesh::Triangle> triangles) {
    NormalSums sums(positions, triangles);
    for (std::size_t begin = 0; begin < triangles.size(); begin += kBlockTriangles)
        sums.addBlock(begin, std::min(begin + kBlockTriangles, triangles.size()));
    return std::move(sums).normals();
}

std::vector<glm::vec3> creasedNormals(std::span<const std::uint64_t> positions,
                                      std::span<const mesh::Triangle> triangles,
                                      double creaseRadians) {
    const std::vector<Facet> facets = facetsOf(positions, triangles);
    const CornersByVertex byVertex(triangles, positions.size());
    std::vector<glm::vec3> normals(triangles.size() * 3, glm::vec3(0.0F));
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, positions.size(), kGrain),
                              [&](const auto& part) {
                                  CreaseGroups groups(triangles, facets, creaseRadians);
                                  for (std::size_t vertex = part.begin(); vertex != part.end();
                                       ++vertex) {
                                      const auto corners = byVertex.of(vertex);
                                      addUpGroups(corners, groups.of(corners), facets, normals);
                                  }
                              });
    return normals;
}

}  // namespace eyrie::import
