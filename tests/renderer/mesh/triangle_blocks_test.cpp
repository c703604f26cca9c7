// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/triangle_blocks.h"

#include <algorithm>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "renderer/mesh/node_geometry.h"
#include "tests/renderer/mesh/sample_meshes.h"

namespace eyrie::mesh {
namespace {

PackedNode nodeOf(const PackedMesh& mesh) {
    const std::span<const Triangle> all[] = {mesh.triangles};
    return gatherNode(mesh, all);
}

std::vector<TriangleBlock> blocksOf(const PackedNode& node) {
    NodeGeometry geometry;
    geometry.positions = node.positions;
    geometry.indices = node.indices;
    return triangleBlocks(geometry);
}

TEST(MeshTriangleBlocks, HoldEveryTriangleOnceInOrderAndAllOfItsCornersNoMore) {
    for (const std::uint32_t triangles : {1U, 127U, 128U, 129U, 3000U}) {
        const PackedNode node = nodeOf(test::randomSoup(triangles, 400, 100000, triangles));
        std::uint32_t next = 0;
        for (const TriangleBlock& block : blocksOf(node)) {
            ASSERT_EQ(block.first, next);
            ASSERT_GT(block.count, 0U);
            ASSERT_EQ(block.count % 3, 0U);
            LatticeBox corners;
            for (std::uint32_t i = block.first; i < block.first + block.count; ++i)
                corners.grow(unpackPosition(node.positions[node.indices[i]]));
            EXPECT_EQ(block.bounds.min, corners.min);
            EXPECT_EQ(block.bounds.max, corners.max);
            next += block.count;
        }
        EXPECT_EQ(next, node.indices.size());
    }
}

TEST(MeshTriangleBlocks, OfASurfaceInAnyOrderAreSmall) {
    PackedMesh mesh = test::separateTriangles(5000);  // in a row
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(7));
    for (const TriangleBlock& block : blocksOf(nodeOf(mesh)))
        EXPECT_LE(block.bounds.max.x - block.bounds.min.x, 128U);
}

TEST(MeshTriangleBlocks, AreNoneOfPoints) {
    PackedNode node = nodeOf(test::separateTriangles(10));
    node.indices.clear();
    EXPECT_TRUE(blocksOf(node).empty());
}

}  // namespace
}  // namespace eyrie::mesh
