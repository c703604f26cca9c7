// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

#include "renderer/mesh/kd_tree.h"
#include "renderer/mesh/lod/patch.h"
#include "renderer/mesh/lod/patch_normals.h"
#include "renderer/mesh/lod/point_sample.h"
#include "renderer/mesh/lod/simplify.h"
#include "renderer/mesh/packed_mesh.h"

namespace eyrie::mesh {

struct LodOptions {
    /// A node with more triangles than this is drawn by about as many; one with fewer, by its
    /// leaves.
    std::uint32_t nodeTriangles = 16384;
    /// Vertices where the mesh goes on beyond the tree, of which it is a part: what touches one is
    /// no component to be left out.
    std::span<const std::uint32_t> goesOnAt = {};
    /// Where triangles cannot stand for a node, or not well, points do, if it has as many triangles
    /// as this.
    std::size_t sampledTriangles = 8192;
    /// Nodes of more have no points, but those below them: sampling takes some hundred bytes a
    /// triangle.
    std::size_t mostSampled = std::size_t{1} << 18;
    std::size_t nodePoints = 4096;                            ///< how many, at most
    std::uint32_t leafTriangles = KdOptions().leafTriangles;  ///< of the tree's leaves, at most

    /// More triangles are not simplified: those of four nodes' surfaces, or of two leaves.
    std::size_t mostUnsimplified() const {
        return std::max<std::size_t>(4 * std::size_t{nodeTriangles},
                                     2 * std::size_t{leafTriangles});
    }
    /// Of more triangles nothing comes, neither fewer nor points.
    std::size_t mostUseful() const { return std::max(mostUnsimplified(), mostSampled); }
};

/// A node's surface on its way up.
struct LodPart {
    Patch patch;
    std::size_t height = 0;  ///< of the tree of simplifications under it
    double errorSteps = 0;   ///< the largest of what is drawn for the node and those under it
    double reachSteps = 0;   ///< so of colourReach()
};

/// How trees of parts of a mesh become one.
struct LodParts {
    std::vector<LodPart>
        leaves;    ///< in: what stands for each leaf, by node, its triangles if empty
    LodPart root;  ///< out: what stands for the root, or would have been simplified
};

/// What was simplified at one distance from the leaves. Without nodes: it was tried, in vain.
struct LodLevel {
    std::uint64_t nodes = 0;
    std::uint64_t trianglesBefore = 0;
    std::uint64_t trianglesAfter = 0;
    double largestErrorMetres = 0;
    double largestReachMetres = 0;  ///< of LodTree::colourReachMetres
    NormalError normals;            ///< the greatest of its nodes, and the greatest mean
    PointCounts points;             ///< of its nodes, those included that nothing came of
};

/// Of a level's points, on borders of its nodes: where they are more, less goes from the level than
/// its error would allow, as each level keeps all that those below it have kept on borders above
/// it (decision 84).
inline constexpr double kMostBorderShare = 0.4;

/// What stands for the nodes of a kd-tree when they are drawn coarser, node by node.
struct LodTree {
    /// Triangles of the mesh's own vertices; empty for leaves, and for nodes that are drawn as
    /// points or by their children.
    std::vector<std::vector<Triangle>> geometry;
    std::vector<std::optional<PointSample>> points;  ///< only of nodes without triangles
    /// Bound on the distance of any point of the source's surface under the node to what stands for
    /// it, and of any point of that to the source; what the lattice and reading rounded included.
    /// Measured, never below the children's.
    std::vector<double> errorMetres;
    /// At any point of what stands for a node the colour, channel by channel and as displayed, and
    /// the opacity is within kColourTolerance of those that the source has within this, or within
    /// the error where that is more. 0 where it is so within the error. Never below the children's.
    std::vector<double> colourReachMetres;
    /// Of what stands for a node itself; 0 of others.
    std::vector<NormalError> normalErrors;
    std::vector<LodLevel> levels;  ///< from the finest

    /// Nodes that points stand for.
    std::uint64_t pointNodes() const {
        return static_cast<std::uint64_t>(
            std::ranges::count_if(points, [](const auto& one) { return one.has_value(); }));
    }
};

/// Simplifies bottom-up: a node's surface is made of its children's, with the vertices that other
/// nodes have, too, left alone until the node that has all around them. Any cut through the tree is
/// therefore without cracks. The result depends on the mesh alone. With `parts`, a tree under or
/// over others: all of them together are as one tree would be. Errors: Cancelled.
absl::StatusOr<LodTree> buildLodTree(const PackedMesh& mesh, const KdTree& tree,
                                     const LodOptions& options = {},
                                     const std::function<void(double)>& progress = {},
                                     const std::stop_token& stop = {}, LodParts* parts = nullptr);

}  // namespace eyrie::mesh
