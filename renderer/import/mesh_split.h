// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/import/mesh_spool.h"

/// The upper part of a mesh's kd-tree, made on disk: the tree that mesh::buildKdTree would make of
/// all of it begins with this one.
namespace eyrie::import {

struct SplitNode {
    std::int32_t left = -1;  ///< -1: a part
    std::int32_t right = -1;
    /// Its triangles are rows of MeshSplit::triangles[file], in their order.
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::size_t file = 0;
    /// The parts under it; a part has itself only.
    std::uint32_t firstPart = 0;
    std::uint32_t lastPart = 0;

    bool isPart() const { return left < 0; }
};

struct MeshSplit {
    std::vector<RowFile<SpooledTriangle>> triangles;  ///< two
    std::vector<SplitNode> nodes;                     ///< depth first
    std::vector<std::uint32_t> parts;                 ///< nodes

    const SplitNode& part(std::size_t index) const { return nodes[parts[index]]; }
};

/// Halves the triangles at the median of their centroids along the longest axis, equal ones by
/// their number, until `most` are left. Takes spool.triangles.
/// Stage reported: "tree". Errors: disk full, Cancelled.
absl::StatusOr<MeshSplit> splitMesh(MeshSpool& spool, std::uint64_t most,
                                    const std::string& outPath, const ImportControl& control);

}  // namespace eyrie::import
