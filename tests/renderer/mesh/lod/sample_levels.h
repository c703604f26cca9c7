// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/lod/lod_tree.h"

/// Small meshes with levels of few triangles.
namespace eyrie::test {

inline constexpr std::uint32_t kNodeTriangles = 512;

struct Levels {
    mesh::PackedMesh mesh;
    mesh::KdTree tree;
    mesh::LodTree lod;
};

inline Levels levelsOf(mesh::PackedMesh mesh,
                       const mesh::LodOptions& options = {.nodeTriangles = kNodeTriangles}) {
    auto tree = mesh::buildKdTree(mesh.positions, mesh.triangles, {options.nodeTriangles / 4});
    EXPECT_TRUE(tree.ok());
    auto lod = mesh::buildLodTree(mesh, *tree, options);
    EXPECT_TRUE(lod.ok());
    return {std::move(mesh), *std::move(tree), *std::move(lod)};
}

inline Levels levelsOf(import::TriangleMesh source,
                       const mesh::LodOptions& options = {.nodeTriangles = kNodeTriangles},
                       const import::PackOptions& pack = {}) {
    import::PackCounts counts;
    auto mesh = import::packMesh(std::move(source), counts, pack);
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return levelsOf(*std::move(mesh), options);
}

/// The triangles of the mesh that are under a node.
inline std::vector<mesh::Triangle> sourceOf(const Levels& levels, const mesh::KdNode& node) {
    std::vector<mesh::Triangle> triangles;
    for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i)
        triangles.push_back(levels.mesh.triangles[levels.tree.order[i]]);
    return triangles;
}

/// So many cells a side, each two triangles and a metre wide, `height(x, y)` high at its posts.
template <typename Height>
import::TriangleMesh sheet(std::uint32_t cells, const Height& height) {
    import::TriangleMesh mesh;
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x) {
            mesh.positions.emplace_back(x, y, height(x, y));
            if (x == cells || y == cells)
                continue;
            const std::uint32_t at = y * (cells + 1) + x;
            mesh.triangles.push_back({at, at + 1, at + cells + 2});
            mesh.triangles.push_back({at, at + cells + 2, at + cells + 1});
        }
    return mesh;
}

/// A soup, of which pieces go: a ball with a thousand tetrahedra on it.
inline import::TriangleMesh ballWithPieces() {
    import::TriangleMesh mesh = import::synthesizeMesh(2000, 5);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    const std::size_t ball = mesh.positions.size();
    for (int i = 0; i < 1000; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const double size = 0.01 + 0.05 * share(random);
        const fabric::Vec3 foot = mesh.positions[random() % ball] * (1 + 0.1 * share(random));
        for (const fabric::Vec3& corner :
             {fabric::Vec3(0), fabric::Vec3(1, 0, 0), fabric::Vec3(0, 1, 0), fabric::Vec3(0, 0, 1)})
            mesh.positions.push_back(foot + size * corner);
        for (const mesh::Triangle& face :
             {mesh::Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
            mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    }
    return mesh;
}

/// Nodes are drawn as points where triangles cannot stand for them.
inline constexpr mesh::LodOptions kWithPoints = {
    .nodeTriangles = kNodeTriangles, .sampledTriangles = kNodeTriangles, .nodePoints = 300};

}  // namespace eyrie::test
