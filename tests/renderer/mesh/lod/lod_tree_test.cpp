// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/lod/lod_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/pack_mesh.h"
#include "renderer/mesh/vertex_packing.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "tests/renderer/mesh/lod/level_surface.h"
#include "tests/renderer/mesh/lod/sample_levels.h"
#include "tests/renderer/mesh/sample_meshes.h"

namespace eyrie::mesh {
namespace {

using import::TriangleMesh;
using test::kNodeTriangles;
using test::Levels;
using test::levelsOf;
using test::sourceOf;
using test::surfaceOf;

const Levels& bumpyBall() {
    static const Levels levels = [] {
        import::PackCounts counts;
        auto mesh = import::packMesh(import::synthesizeMesh(20000, 5), counts);
        EXPECT_TRUE(mesh.ok());
        return levelsOf(*std::move(mesh),
                        {.nodeTriangles = kNodeTriangles, .sampledTriangles = kNodeTriangles});
    }();
    return levels;
}

/// Largest distance found from points all over the triangles to the surface.
double farthest(const PackedMesh& mesh, const std::vector<Triangle>& triangles,
                const truth::MeshRayCaster& to) {
    double worst = 0;
    for (const Triangle& triangle : triangles) {
        std::array<fabric::Vec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = mesh.lattice.metres(unpackPosition(mesh.positions[triangle[i]]));
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; i + j <= 4; ++j) {
                const fabric::Vec3 at =
                    p[0] + (i / 4.0) * (p[1] - p[0]) + (j / 4.0) * (p[2] - p[0]);
                worst = std::max(worst, glm::length(*to.counterpart(at) - at));
            }
    }
    return worst;
}

/// A scan: smooth noise on facets of many triangles each.
Levels displacedBall(int subdivisions) {
    auto source = import::subdivide(import::synthesizeMesh(5000, 5), subdivisions);
    EXPECT_TRUE(source.ok());
    import::displace(*source, 2e-3, 3);
    import::PackCounts counts;
    auto mesh = import::packMesh(*std::move(source), counts);
    EXPECT_TRUE(mesh.ok());
    return levelsOf(*std::move(mesh));
}

/// Promised over measured, both ways.
struct Ratios {
    double least = std::numeric_limits<double>::infinity();
    double mean = 0;
};

Ratios promisedOverMeasured(const Levels& levels) {
    Ratios ratios;
    int nodes = 0;
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        if (levels.lod.geometry[i].empty())
            continue;
        const std::vector<Triangle> source = sourceOf(levels, levels.tree.nodes[i]);
        const auto& drawn = levels.lod.geometry[i];
        const double measured =
            std::max(farthest(levels.mesh, source, surfaceOf(levels.mesh, drawn)),
                     farthest(levels.mesh, drawn, surfaceOf(levels.mesh, source)));
        EXPECT_LE(measured, levels.lod.errorMetres[i]) << "node " << i;
        const double ratio = levels.lod.errorMetres[i] / measured;
        ratios.least = std::min(ratios.least, ratio);
        ratios.mean += ratio;
        ++nodes;
    }
    EXPECT_GT(nodes, 20);
    ratios.mean /= nodes;
    fmt::print("promised over measured: {:.2f} on average of {} nodes, {:.2f} at least\n",
               ratios.mean, nodes, ratios.least);
    return ratios;
}

TEST(LodTree, NoPointOfEitherSurfaceIsFartherThanPromised) {
    EXPECT_LT(promisedOverMeasured(bumpyBall()).mean, 1.6);
}

/// Nor is there room: a bound a tenth smaller would be broken.
TEST(LodTree, NoPointOfADisplacedScanIsFartherThanPromised) {
    const Ratios ratios = promisedOverMeasured(displacedBall(1));
    EXPECT_LT(ratios.mean, 1.5);
    EXPECT_LT(ratios.least, 1.1);
}

/// Borders stay as fine as the source, so they are the more of a node the more levels lie below it:
/// up to 43 % of the fifth level's vertices. What may still go does not go too far for that.
TEST(LodTree, BordersDoNotStarveTheInside) {
    const std::vector<LodLevel> levels = displacedBall(3).lod.levels;
    ASSERT_GE(levels.size(), 5U);
    for (std::size_t i = 1; i < 5; ++i)
        EXPECT_LT(levels[i].largestErrorMetres, 3 * levels[i - 1].largestErrorMetres) << i;
}

/// A bumpy ball with a crowd of small solids on it and some afar.
const Levels& soup() {
    static const Levels levels = [] {
        TriangleMesh source = import::synthesizeMesh(6000, 5);
        const TriangleMesh ball = source;
        std::mt19937 engine(7);
        std::uniform_real_distribution<double> random(0, 1);
        for (int i = 0; i < 4000; ++i) {
            const auto first = static_cast<std::uint32_t>(source.positions.size());
            const double size = 0.002 + 0.02 * random(engine) * random(engine);
            const fabric::Vec3 foot = ball.positions[engine() % ball.positions.size()] *
                                      (i % 50 == 0 ? 1.5 : 1.0 + 0.1 * random(engine) * size);
            for (const fabric::Vec3 corner : {fabric::Vec3(0), fabric::Vec3(1, 0, 0),
                                              fabric::Vec3(0, 1, 0), fabric::Vec3(0, 0, 1)})
                source.positions.push_back(foot + size * corner * glm::length(foot));
            for (const Triangle& face : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
                source.triangles.push_back({first + face[0], first + face[1], first + face[2]});
        }
        import::PackCounts counts;
        auto mesh = import::packMesh(std::move(source), counts);
        EXPECT_TRUE(mesh.ok());
        return levelsOf(*std::move(mesh));
    }();
    return levels;
}

TEST(LodTree, OfASoupLosesPiecesAndStillKeepsItsPromise) {
    const Levels& levels = soup();
    std::size_t nodes = 0;
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        if (levels.lod.geometry[i].empty())
            continue;
        const std::vector<Triangle> source = sourceOf(levels, levels.tree.nodes[i]);
        const auto& drawn = levels.lod.geometry[i];
        EXPECT_LE(farthest(levels.mesh, source, surfaceOf(levels.mesh, drawn)),
                  levels.lod.errorMetres[i])
            << "node " << i;
        EXPECT_LE(farthest(levels.mesh, drawn, surfaceOf(levels.mesh, source)),
                  levels.lod.errorMetres[i])
            << "node " << i;
        ++nodes;
    }
    EXPECT_GT(nodes, 20U);
    // Without its pieces' going the root has no simpler form: none of them can be simplified.
    EXPECT_LE(levels.lod.geometry[0].size(), kNodeTriangles * 5 / 4);
    EXPECT_FALSE(levels.lod.geometry[0].empty());
}

/// Ladders, which are border all over: nothing of them can be simplified.
PackedMesh ladders() {
    PackedMesh mesh;
    mesh.lattice = {{0, 0, 0}, 0.25};
    std::mt19937 random(3);
    for (std::uint32_t row = 0; row < 60; ++row)
        for (std::uint32_t i = 0; i <= 50; ++i)
            for (const std::uint32_t side : {0U, 900U}) {
                mesh.positions.push_back(
                    packPosition({i * 1000, row * 1000 + side, random() % 3000}));
                mesh.normals.push_back(packNormal({0, 0, 1}));
                const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
                if (i > 0 && side > 0) {
                    mesh.triangles.push_back({last - 3, last - 1, last});
                    mesh.triangles.push_back({last - 3, last, last - 2});
                }
            }
    return mesh;
}

TEST(LodTree, SimplifiesLeavesHoweverLarge) {
    const PackedMesh& mesh = bumpyBall().mesh;
    const auto leaf = static_cast<std::uint32_t>(mesh.triangles.size() / 2 + 1);
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {leaf});
    ASSERT_TRUE(tree.ok());
    const auto lod =
        buildLodTree(mesh, *tree, {.nodeTriangles = kNodeTriangles, .leafTriangles = leaf});
    ASSERT_TRUE(lod.ok());
    ASSERT_EQ(lod->geometry.size(), 3U);
    EXPECT_FALSE(lod->geometry[0].empty());
    EXPECT_LE(lod->geometry[0].size(), kNodeTriangles);
}

TEST(LodTree, WhatDoesNotSimplifyIsPoints) {
    const PackedMesh mesh = ladders();
    const auto tree = buildKdTree(mesh.positions, mesh.triangles, {kNodeTriangles / 4});
    ASSERT_TRUE(tree.ok());
    const auto lod = buildLodTree(
        mesh, *tree,
        {.nodeTriangles = kNodeTriangles, .sampledTriangles = kNodeTriangles, .nodePoints = 300});
    ASSERT_TRUE(lod.ok());
    const truth::MeshRayCaster source = surfaceOf(mesh, mesh.triangles);
    std::size_t sampled = 0;
    for (std::size_t i = 0; i < tree->nodes.size(); ++i) {
        const KdNode& node = tree->nodes[i];
        if (!lod->points[i])
            continue;
        ++sampled;
        EXPECT_FALSE(node.isLeaf());
        EXPECT_TRUE(lod->geometry[i].empty());
        EXPECT_LE(lod->points[i]->positions.size(), 300U);
        EXPECT_GE(
            lod->errorMetres[i] + 1e-9,
            mesh.lattice.errorMetres() + lod->points[i]->errorSteps() * mesh.lattice.stepMetres);
        for (const std::int32_t child : {node.left, node.right})
            EXPECT_GE(lod->errorMetres[i], lod->errorMetres[static_cast<std::size_t>(child)]);
        for (const std::uint64_t position : lod->points[i]->positions) {
            const fabric::Vec3 at = mesh.lattice.metres(unpackPosition(position));
            EXPECT_LE(glm::distance(*source.counterpart(at), at), lod->errorMetres[i]);
        }
    }
    EXPECT_GE(sampled, 8U);
    EXPECT_TRUE(lod->points[0].has_value());
}

TEST(LodTree, ScansNeedNoPoints) {
    for (const auto& points : bumpyBall().lod.points) EXPECT_FALSE(points.has_value());
}

TEST(LodTree, HalvesWhatIsNotItsBorderFromLevelToLevel) {
    const Levels& levels = bumpyBall();
    ASSERT_GE(levels.lod.levels.size(), 5U);
    for (const LodLevel& level : levels.lod.levels) {
        const auto before = static_cast<double>(level.trianglesBefore);
        const double most = static_cast<double>(level.nodes) * kNodeTriangles;
        // Of two triangles there is one vertex; for each on the border half of one is kept.
        EXPECT_NEAR(static_cast<double>(level.trianglesAfter),
                    std::min(before / 2, most) + level.points.borderShare() * before / 4,
                    0.05 * before);
    }
    EXPECT_LE(levels.lod.geometry[0].size(), kNodeTriangles * 5 / 4);
}

using Edge = std::pair<std::uint64_t, std::uint64_t>;

/// A square of cells, open around, that bulges a little.
PackedMesh sheet(std::uint32_t cells) {
    TriangleMesh source;
    for (std::uint32_t y = 0; y <= cells; ++y)
        for (std::uint32_t x = 0; x <= cells; ++x)
            source.positions.emplace_back(x, y, std::sin(0.1 * x) * std::cos(0.13 * y));
    for (std::uint32_t y = 0; y < cells; ++y)
        for (std::uint32_t x = 0; x < cells; ++x) {
            const std::uint32_t at = y * (cells + 1) + x;
            source.triangles.push_back({at, at + 1, at + cells + 2});
            source.triangles.push_back({at, at + cells + 2, at + cells + 1});
        }
    import::PackCounts counts;
    auto mesh = import::packMesh(std::move(source), counts);
    EXPECT_TRUE(mesh.ok());
    return *std::move(mesh);
}

/// Of the nodes above leaves that are not simplified, whose triangles are the source's own: by the
/// nodes that a point's triangles are in, and by the edges that it has alone.
PointCounts countsOfTheFinest(const Levels& levels) {
    std::map<Edge, int> edges;
    for (const Triangle& triangle : levels.mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint64_t from = levels.mesh.positions[triangle[i]];
            const std::uint64_t to = levels.mesh.positions[triangle[(i + 1) % 3]];
            ++edges[{std::min(from, to), std::max(from, to)}];
        }
    std::set<std::uint64_t> open;
    for (const auto& [ends, count] : edges)
        if (count == 1)
            open.insert({ends.first, ends.second});
    const auto isSimplified = [&](std::int32_t index) {
        const KdNode& node = levels.tree.nodes[static_cast<std::size_t>(index)];
        return !node.isLeaf() && node.triangleEnd - node.triangleBegin > kNodeTriangles;
    };
    PointCounts counts;
    for (std::size_t index = 0; index < levels.tree.nodes.size(); ++index) {
        const KdNode& node = levels.tree.nodes[index];
        if (!isSimplified(static_cast<std::int32_t>(index)) || isSimplified(node.left) ||
            isSimplified(node.right))
            continue;
        std::set<std::uint64_t> inside, outside;
        for (std::uint64_t i = 0; i < levels.tree.order.size(); ++i)
            for (const std::uint32_t vertex : levels.mesh.triangles[levels.tree.order[i]])
                (i >= node.triangleBegin && i < node.triangleEnd ? inside : outside)
                    .insert(levels.mesh.positions[vertex]);
        for (const std::uint64_t point : inside) {
            ++counts.all;
            if (open.contains(point))
                ++counts.staying;
            else if (outside.contains(point))
                ++counts.onBorder;
        }
    }
    return counts;
}

TEST(LodTree, TellsPointsWhereNodesMeetFromThoseAtOpenEdges) {
    const Levels open = levelsOf(sheet(60));
    for (const Levels* const levels : {&open, &bumpyBall()}) {
        const PointCounts expected = countsOfTheFinest(*levels);
        const PointCounts& found = levels->lod.levels.front().points;
        EXPECT_EQ(found.all, expected.all);
        EXPECT_EQ(found.onBorder, expected.onBorder);
        EXPECT_EQ(found.staying, expected.staying);
        EXPECT_GT(found.onBorder, 0U);
        // All of the surface has no border. Of what is left of the ball some points have more
        // triangles than are taken for a star.
        const PointCounts& root = levels->lod.levels.back().points;
        EXPECT_EQ(root.onBorder, 0U);
        if (levels == &open) {
            EXPECT_EQ(root.staying, 240U) << "those around it";
        } else {
            EXPECT_LT(root.stayingShare(), 0.05);
        }
    }
}

TEST(LodTree, ErrorsAreNeverBelowTheChildrens) {
    const Levels& levels = bumpyBall();
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        const KdNode& node = levels.tree.nodes[i];
        if (node.isLeaf())
            continue;
        EXPECT_GE(levels.lod.errorMetres[i], levels.lod.errorMetres[std::size_t(node.left)]);
        EXPECT_GE(levels.lod.errorMetres[i], levels.lod.errorMetres[std::size_t(node.right)]);
    }
}

void addEdges(const PackedMesh& mesh, const std::vector<Triangle>& triangles,
              std::map<Edge, int>& edges) {
    for (const Triangle& triangle : triangles)
        for (std::size_t i = 0; i < 3; ++i)
            ++edges[{mesh.positions[triangle[i]], mesh.positions[triangle[(i + 1) % 3]]}];
}

/// A random cut through the tree.
void addCut(const Levels& levels, std::size_t index, std::mt19937& engine,
            std::map<Edge, int>& edges) {
    const KdNode& node = levels.tree.nodes[index];
    if (node.isLeaf())
        return addEdges(levels.mesh, sourceOf(levels, node), edges);
    if (!levels.lod.geometry[index].empty() && engine() % 4 == 0)
        return addEdges(levels.mesh, levels.lod.geometry[index], edges);
    addCut(levels, static_cast<std::size_t>(node.left), engine, edges);
    addCut(levels, static_cast<std::size_t>(node.right), engine, edges);
}

TEST(LodTree, AnyCutThroughAClosedMeshIsClosed) {
    std::mt19937 engine(1);
    for (int round = 0; round < 50; ++round) {
        std::map<Edge, int> edges;
        addCut(bumpyBall(), 0, engine, edges);
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            ASSERT_TRUE(back != edges.end() && back->second == count) << "round " << round;
        }
    }
}

/// One half has a texture around it, with a seam; the other is plain.
TriangleMesh texturedBall() {
    const TriangleMesh plain = import::synthesizeMesh(20000, 5);
    TriangleMesh ball;
    ball.materials = {{}, {.image = 0}};
    ball.images = {{{1, 1, 0, 0, 0}, std::vector<std::byte>(8)}};
    for (const auto& triangle : plain.triangles) {
        const bool isTextured = plain.positions[triangle[0]].z > 0;
        std::array<std::uint32_t, 3> corners;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = static_cast<std::uint32_t>(ball.positions.size());
            const fabric::Vec3& position =
                ball.positions.emplace_back(plain.positions[triangle[i]]);
            const bool isPastSeam = position.y > 0;
            ball.textureCoordinates.emplace_back(position.x + (isPastSeam ? 0.0 : 7.5), position.z);
            ball.materialOf.push_back(isTextured ? 1 : 0);
        }
        ball.triangles.push_back(corners);
    }
    return ball;
}

TEST(LodTree, CutsOfATexturedMeshAreClosedAndKeepMaterialsApart) {
    import::PackCounts counts;
    auto mesh = import::packMesh(texturedBall(), counts);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const Levels levels = levelsOf(*std::move(mesh));
    std::size_t simplified = 0;
    for (const std::vector<Triangle>& geometry : levels.lod.geometry) {
        simplified += geometry.size();
        for (const auto& [a, b, c] : geometry)
            ASSERT_TRUE(levels.mesh.materialOf[a] == levels.mesh.materialOf[b] &&
                        levels.mesh.materialOf[a] == levels.mesh.materialOf[c]);
    }
    EXPECT_GT(simplified, 10000U);
    std::mt19937 engine(2);
    for (int round = 0; round < 20; ++round) {
        std::map<Edge, int> edges;
        addCut(levels, 0, engine, edges);
        for (const auto& [edge, count] : edges) {
            const auto back = edges.find({edge.second, edge.first});
            ASSERT_TRUE(back != edges.end() && back->second == count) << "round " << round;
        }
    }
}

TEST(LodTree, LeavesSurfacesThatAreAllBorderToTheirLeaves) {
    PackedMesh flag;  // one strip: every vertex lies on its border, and it is one piece
    for (std::uint32_t i = 0; i < 2002; ++i)
        flag.positions.push_back(packPosition({i / 2, i % 2 * 10, i % 7}));
    flag.normals.assign(flag.positions.size(), packNormal({0, 0, 1}));
    for (std::uint32_t i = 0; i < 2000; ++i)
        flag.triangles.push_back(i % 2 == 0 ? Triangle{i, i + 2, i + 1}
                                            : Triangle{i, i + 1, i + 2});
    const Levels levels = levelsOf(std::move(flag), {.nodeTriangles = 64});
    for (const auto& geometry : levels.lod.geometry) EXPECT_TRUE(geometry.empty());
    for (const double error : levels.lod.errorMetres)
        EXPECT_EQ(error, levels.mesh.lattice.errorMetres());
}

TEST(LodTree, SurvivesRandomTriangles) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Levels levels =
            levelsOf(test::randomSoup(3000, 300, 40, seed), {.nodeTriangles = 128});
        for (const auto& geometry : levels.lod.geometry)
            for (const Triangle& triangle : geometry)
                for (const std::uint32_t vertex : triangle)
                    ASSERT_LT(vertex, levels.mesh.positions.size());
    }
}

TEST(LodTree, DependsOnTheMeshAlone) {
    const Levels again = levelsOf(bumpyBall().mesh);
    EXPECT_EQ(again.lod.geometry, bumpyBall().lod.geometry);
    EXPECT_EQ(again.lod.errorMetres, bumpyBall().lod.errorMetres);
}

TEST(LodTree, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const Levels& levels = bumpyBall();
    EXPECT_EQ(buildLodTree(levels.mesh, levels.tree, {}, {}, stop.get_token()).status().code(),
              absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace eyrie::mesh
