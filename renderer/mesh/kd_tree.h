// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>
#include <glm/vec3.hpp>

#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

/// Unique vertices a leaf may have: 16-bit indices, without 65,535 (primitive restart).
inline constexpr std::uint32_t kMaxLeafVertices = 65535;

/// Triangles that a leaf, or what stands for an inner node, may have.
inline constexpr std::uint32_t kMaxNodeTriangles = 65535;

/// Triangles of one tree: even with one a leaf its nodes have 31-bit indices.
inline constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 30;

struct KdOptions {
    /// Triangles a leaf may have, at least 1. llvmpipe draws batches of about this size fastest.
    std::uint32_t leafTriangles = 8192;
};

/// One LOD node of a mesh. Nodes lie depth first: the left child follows its parent.
struct KdNode {
    glm::uvec3 boxMin{0U};  ///< tight around the vertices of its triangles; lattice, closed
    glm::uvec3 boxMax{0U};
    std::int32_t left = -1;  ///< -1 in a leaf
    std::int32_t right = -1;
    std::uint64_t triangleBegin = 0;  ///< its triangles are order[triangleBegin, triangleEnd)
    std::uint64_t triangleEnd = 0;

    bool isLeaf() const { return left < 0; }
    bool operator==(const KdNode&) const = default;
};

/// Each triangle is in exactly one leaf.
struct KdTree {
    std::vector<KdNode> nodes;         ///< empty when there are no triangles
    std::vector<std::uint32_t> order;  ///< triangle indices, leaf after leaf

    bool operator==(const KdTree&) const = default;
};

/// Halves the triangles at the median centroid along the longest axis of the centroids' bounds
/// until a leaf's limits are kept; equal centroids part by triangle index. The result depends on
/// the mesh alone, not on the number of threads.
/// Errors: Cancelled, ResourceExhausted (more than kMaxTriangles).
/// J. L. Bentley, "Multidimensional Binary Search Trees Used for Associative Searching", 1975.
absl::StatusOr<KdTree> buildKdTree(std::span<const std::uint64_t> positions,
                                   std::span<const Triangle> triangles, const KdOptions& options,
                                   const std::stop_token& stop = {});

}  // namespace eyrie::mesh
