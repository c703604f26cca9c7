// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/kd_tree.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <rapidcheck/gtest.h>

#include "tests/renderer/mesh/sample_meshes.h"

namespace eyrie::mesh {
namespace {

KdTree build(const PackedMesh& mesh, std::uint32_t leafTriangles) {
    auto tree = buildKdTree(mesh.positions, mesh.triangles, {leafTriangles});
    EXPECT_TRUE(tree.ok()) << tree.status();
    return *std::move(tree);
}

std::set<std::uint32_t> verticesOf(const PackedMesh& mesh, const KdTree& tree, const KdNode& node) {
    std::set<std::uint32_t> vertices;
    for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i)
        for (const std::uint32_t corner : mesh.triangles[tree.order[i]]) vertices.insert(corner);
    return vertices;
}

bool boxIsTight(const PackedMesh& mesh, const KdTree& tree, const KdNode& node) {
    glm::uvec3 low(kMaxLatticeCoordinate);
    glm::uvec3 high(0U);
    for (const std::uint32_t vertex : verticesOf(mesh, tree, node)) {
        low = glm::min(low, unpackPosition(mesh.positions[vertex]));
        high = glm::max(high, unpackPosition(mesh.positions[vertex]));
    }
    return node.boxMin == low && node.boxMax == high;
}

/// Walks depth first; returns the first law that is broken, or nothing.
std::string brokenLaw(const PackedMesh& mesh, const KdTree& tree, std::uint32_t leafTriangles) {
    std::vector<std::uint32_t> sorted = tree.order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    if (sorted != all)
        return "order is no permutation of the triangles";
    std::uint64_t covered = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const KdNode& node = tree.nodes[i];
        if (!boxIsTight(mesh, tree, node))
            return "a box is not tight";
        const std::uint64_t count = node.triangleEnd - node.triangleBegin;
        if (node.isLeaf()) {
            if (node.triangleBegin != covered || count == 0)
                return "leaves do not follow one another";
            covered = node.triangleEnd;
            if (count > leafTriangles || verticesOf(mesh, tree, node).size() > kMaxLeafVertices)
                return "a leaf exceeds its limits";
            continue;
        }
        const KdNode& left = tree.nodes[static_cast<std::size_t>(node.left)];
        const KdNode& right = tree.nodes[static_cast<std::size_t>(node.right)];
        if (node.left != static_cast<std::int32_t>(i) + 1 || node.right <= node.left)
            return "nodes are not depth first";
        if (left.triangleBegin != node.triangleBegin || left.triangleEnd != right.triangleBegin ||
            right.triangleEnd != node.triangleEnd)
            return "children do not part their parent's triangles";
        if (left.triangleEnd - left.triangleBegin != count / 2)
            return "the split is not at the median";
    }
    return covered == mesh.triangles.size() ? "" : "leaves do not cover the range";
}

RC_GTEST_PROP(KdTree, KeepsItsLawsForAnySoup, ()) {
    const auto triangles = *rc::gen::inRange<std::uint32_t>(1, 300);
    const auto vertices = *rc::gen::inRange<std::uint32_t>(1, 100);
    const auto extent = *rc::gen::element<std::uint32_t>(1, 2, 50, kMaxLatticeCoordinate);
    const auto leafTriangles = *rc::gen::inRange<std::uint32_t>(1, 40);
    const PackedMesh mesh =
        test::randomSoup(triangles, vertices, extent, *rc::gen::arbitrary<std::uint32_t>());
    RC_ASSERT(brokenLaw(mesh, build(mesh, leafTriangles), leafTriangles) == "");
}

TEST(KdTree, IsTheSameForAnyNumberOfThreads) {
    const PackedMesh mesh = test::randomSoup(200000, 60000, 5000, 1);
    std::vector<KdTree> trees;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const oneapi::tbb::global_control limit(
            oneapi::tbb::global_control::max_allowed_parallelism, threads);
        trees.push_back(build(mesh, 500));
    }
    EXPECT_EQ(trees[0], trees[1]);
    EXPECT_EQ(trees[0], trees[2]);
    EXPECT_EQ(brokenLaw(mesh, trees[0], 500), "");
}

TEST(KdTree, PartsEqualCentroidsByIndex) {
    PackedMesh mesh = test::randomSoup(1000, 3, 100, 2);
    mesh.triangles.assign(1000, Triangle{0, 1, 2});
    const KdTree tree = build(mesh, 10);
    EXPECT_EQ(brokenLaw(mesh, tree, 10), "");
    EXPECT_TRUE(std::is_sorted(tree.order.begin(), tree.order.end()));
}

TEST(KdTree, TakesPointsThatAreAllEqualOrOnALine) {
    PackedMesh equal = test::randomSoup(100, 50, 1, 3);
    EXPECT_EQ(brokenLaw(equal, build(equal, 7), 7), "");
    PackedMesh line = test::randomSoup(100, 50, 1000, 4);
    for (std::uint64_t& position : line.positions)
        position = packPosition({unpackPosition(position).x, 5, 5});
    EXPECT_EQ(brokenLaw(line, build(line, 7), 7), "");
}

TEST(KdTree, FillsALeafTo65535VerticesAndSplitsAtOneMore) {
    const PackedMesh full = test::separateTriangles(kMaxLeafVertices / 3);
    ASSERT_EQ(full.positions.size(), 65535U);
    EXPECT_EQ(build(full, kMaxLeafVertices).nodes.size(), 1U);

    PackedMesh over = full;
    over.positions.push_back(packPosition({7, 7, 7}));
    over.triangles.push_back({0, 1, 65535});
    const KdTree tree = build(over, kMaxLeafVertices);
    EXPECT_EQ(tree.nodes.size(), 3U);
    EXPECT_EQ(brokenLaw(over, tree, kMaxLeafVertices), "");
}

TEST(KdTree, SharesVerticesBeyondTwentyThousandTriangles) {
    // Without sharing, 60,000 triangles would have 180,000 vertices; these have 1,000: one leaf.
    const PackedMesh mesh = test::randomSoup(60000, 1000, 500, 5);
    EXPECT_EQ(build(mesh, kMaxLeafVertices).nodes.size(), 1U);
}

TEST(KdTree, OfNothingIsEmpty) {
    const KdTree tree = build({}, 10);
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_TRUE(tree.order.empty());
}

TEST(KdTree, StopsWhenAsked) {
    const PackedMesh mesh = test::randomSoup(1000, 100, 100, 6);
    std::stop_source stop;
    stop.request_stop();
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {10}, stop.get_token());
    EXPECT_EQ(tree.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace eyrie::mesh
