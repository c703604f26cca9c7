// SPDX-License-Identifier: Apache-2.0
// Levels of sheets that touch, by points of their own or by those of both: no slit opens between.
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/mesh/lod/level_surface.h"
#include "tests/renderer/mesh/lod/sample_levels.h"

namespace eyrie::mesh {
namespace {

using test::kNodeTriangles;
using test::Levels;
using test::levelsOf;
using test::sourceOf;
using test::surfaceOf;

/// Hills, and a fence with a foot and a top so far from each post of one row of theirs.
PackedMesh hillsAndFence(const glm::ivec3& foot, const glm::ivec3& top) {
    constexpr std::uint32_t kPosts = 100;
    PackedMesh mesh;
    mesh.lattice = {{0, 0, 0}, 0.25};
    std::mt19937 random(5);
    const auto add = [&](const glm::uvec3& at) {
        mesh.positions.push_back(packPosition(at));
        mesh.normals.push_back(packNormal({0, 0, 1}));
    };
    const auto rectangle = [&](std::uint32_t a, std::uint32_t across) {
        mesh.triangles.push_back({a, a + 1, a + across + 1});
        mesh.triangles.push_back({a, a + across + 1, a + across});
    };
    for (std::uint32_t y = 0; y < kPosts; ++y)
        for (std::uint32_t x = 0; x < kPosts; ++x) {
            add({x * 1000, y * 1000, 5000 + random() % 800});
            if (x + 1 < kPosts && y + 1 < kPosts)
                rectangle(y * kPosts + x, kPosts);
        }
    for (const glm::ivec3& away : {foot, top})
        for (std::uint32_t x = 0; x < kPosts; ++x)
            add(glm::uvec3(glm::ivec3(unpackPosition(mesh.positions[30 * kPosts + x])) + away));
    for (std::uint32_t x = 0; x + 1 < kPosts; ++x) rectangle(kPosts * kPosts + x, kPosts);
    return mesh;
}

/// However much else of the hills goes, no slit opens under the fence.
TEST(LodTree, KeepsSheetsTogetherThatTouchWithoutSharingPoints) {
    const Levels levels = levelsOf(hillsAndFence({0, 0, 1}, {0, 0, 2001}));
    std::size_t simpler = 0;
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        std::vector<Triangle> hills;
        for (const Triangle& triangle : levels.lod.geometry[i])
            if (triangle[0] < 10'000)
                hills.push_back(triangle);
        if (hills.empty())
            continue;
        ++simpler;
        const truth::MeshRayCaster surface = surfaceOf(levels.mesh, hills);
        for (const Triangle& triangle : sourceOf(levels, levels.tree.nodes[i]))
            for (const std::uint32_t vertex : triangle)
                if (vertex >= 10'000 && vertex < 10'100) {
                    const fabric::Vec3 foot =
                        levels.mesh.lattice.metres(unpackPosition(levels.mesh.positions[vertex]));
                    // The hill right under it may be another node's.
                    const double away = glm::distance(*surface.counterpart(foot), foot);
                    EXPECT_TRUE(away <= levels.mesh.lattice.stepMetres || away >= 100)
                        << "node " << i << ", " << away;
                }
    }
    EXPECT_GT(simpler, 20U);
    EXPECT_LE(levels.lod.geometry[0].size(), kNodeTriangles * 3);
}

/// Of posts that a fence starts from none goes, though the fence, which leans over, is in nodes of
/// its own, and the hills alone go on all around them there.
TEST(LodTree, KeepsWhereASheetOfAnotherNodeStarts) {
    const Levels levels = levelsOf(hillsAndFence({0, 0, 0}, {0, -29'000, 2000}));
    std::size_t looks = 0;
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        std::set<std::uint64_t> there;
        for (const Triangle& triangle : levels.lod.geometry[i])
            for (const std::uint32_t vertex : triangle)
                if (vertex < 10'000)
                    there.insert(levels.mesh.positions[vertex]);
        if (there.empty())
            continue;
        for (const Triangle& triangle : sourceOf(levels, levels.tree.nodes[i]))
            for (const std::uint32_t vertex : triangle)
                if (vertex >= 3000 && vertex < 3100) {
                    ++looks;
                    EXPECT_TRUE(there.contains(levels.mesh.positions[vertex])) << "node " << i;
                }
    }
    EXPECT_GT(looks, 1000U);
}

}  // namespace
}  // namespace eyrie::mesh
