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

}  // namespace

std::vector<glm::vec3> smoothNormals(std::span<const std::uint64_t> positions,
                                     std::span<const mesh::Triangle> triangles) {
    NormalSums sums(positions, triangles);
    for (std::size_t begin = 0; begin < triangles.size(); begin += kBlockTriangles)
        sums.addBlock(begin, std::min(begin + kBlockTriangles, triangles.size()));
    return std::move(sums).normals();
}

}  // namespace eyrie::import
