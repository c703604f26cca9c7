// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/pack_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <rapidcheck/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/import/ply_text.h"

namespace eyrie::import {
namespace {

struct Packed {
    mesh::PackedMesh mesh;
    PackCounts counts;
};

constexpr PackOptions kFile{.normals = NormalSource::File};

Packed pack(const TriangleMesh& source, const PackOptions& options = {}) {
    Packed result;
    auto packed = packMesh(source, result.counts, options);
    EXPECT_TRUE(packed.ok()) << packed.status();
    if (packed.ok())
        result.mesh = *std::move(packed);
    return result;
}

glm::vec3 normalAt(const mesh::PackedMesh& packed, const fabric::Vec3& position) {
    for (std::size_t i = 0; i < packed.positions.size(); ++i)
        if (packed.lattice.metres(mesh::unpackPosition(packed.positions[i])) == position)
            return mesh::unpackNormal(packed.normals[i]);
    ADD_FAILURE() << "no vertex there";
    return {};
}

RC_GTEST_PROP(PackMesh, MovesNoVertexFurtherThanTheLatticesError, ()) {
    const auto axis =
        rc::gen::map(rc::gen::inRange(-1000000, 1000000), [](int value) { return value / 7.0; });
    TriangleMesh source;
    source.positions = *rc::gen::container<std::vector<fabric::Vec3>>(
        12, rc::gen::construct<fabric::Vec3>(axis, axis, axis));
    source.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
    PackCounts counts;
    const auto packed = packMesh(source, counts);
    const bool isWhole = packed.ok() && packed->triangles.size() == 4;
    RC_PRE(isWhole);  // random triangles may be degenerate
    for (std::size_t t = 0; t < 4; ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto stored = packed->lattice.metres(
                mesh::unpackPosition(packed->positions[packed->triangles[t][c]]));
            RC_ASSERT(glm::distance(stored, source.positions[source.triangles[t][c]]) <=
                      packed->lattice.errorMetres());
        }
}

TEST(PackMesh, WeldsTriangleSoupIntoItsSurface) {
    const TriangleMesh whole = test::tetrahedron();
    TriangleMesh soup;
    for (const auto& triangle : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t corner : triangle)
            soup.positions.push_back(whole.positions[corner]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    const Packed packed = pack(soup);
    EXPECT_EQ(packed.mesh.positions.size(), 4U);
    EXPECT_EQ(packed.counts.weldedVertices, 8U);
    EXPECT_EQ(packed.mesh.triangles.size(), 4U);
}

TEST(PackMesh, KeepsVerticesApartThatDifferInNormalOrColour) {
    TriangleMesh source;
    source.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}};
    source.triangles = {{0, 1, 2}, {3, 5, 4}};
    EXPECT_EQ(pack(source).mesh.positions.size(), 4U);
    source.colours.assign(6, {1, 2, 3, 255});
    source.colours[3].r = 9;
    EXPECT_EQ(pack(source).mesh.positions.size(), 5U);
    source.normals.assign(6, {0, 0, 1});
    source.normals[4] = {0, 1, 1};
    EXPECT_EQ(pack(source).mesh.positions.size(), 5U);  // normals are not asked for
    const Packed packed = pack(source, kFile);
    EXPECT_EQ(packed.mesh.positions.size(), 6U);
    EXPECT_FALSE(packed.counts.normalsComputed);
}

TEST(PackMesh, DropsAndCountsDegenerateTrianglesAndIsolatedVertices) {
    TriangleMesh source = test::tetrahedron();
    source.positions.insert(source.positions.end(), {{0.5, 0, 0}, {0, 0, 0}, {7, 7, 7}});
    source.triangles.insert(source.triangles.end(), {{0, 0, 1}, {0, 1, 4}, {0, 5, 2}});
    const Packed packed = pack(source);
    EXPECT_EQ(packed.counts.degenerateTriangles, 3U);
    EXPECT_EQ(packed.counts.isolatedVertices, 3U);
    EXPECT_EQ(packed.mesh.triangles.size(), 4U);
    EXPECT_EQ(packed.mesh.positions.size(), 4U);
}

TEST(PackMesh, FitsTheLatticeToUsedVerticesOnly) {
    TriangleMesh source = test::tetrahedron();
    const mesh::Lattice lattice = pack(source).mesh.lattice;
    source.positions.emplace_back(1e300, -1e300, 0);
    EXPECT_EQ(pack(source).mesh.lattice, lattice);
}

TEST(PackMesh, RefusesMeshesWithoutAreaSayingSo) {
    for (const fabric::Vec3 direction : {fabric::Vec3(0), fabric::Vec3(1, 2, 3)}) {
        TriangleMesh source;
        for (int i = 0; i < 9; ++i)
            source.positions.push_back(fabric::Vec3(5, 5, 5) + direction * static_cast<double>(i));
        source.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
        PackCounts counts;
        const auto packed = packMesh(source, counts);
        ASSERT_EQ(packed.status().code(), absl::StatusCode::kInvalidArgument);
        EXPECT_THAT(std::string(packed.status().message()),
                    testing::AllOf(testing::HasSubstr("3 triangles"), testing::HasSubstr("area")));
    }
}

/// As where a reader has rounded corners.
TEST(PackMesh, CountsTrianglesWithoutAreaInTheSourceApart) {
    TriangleMesh source;
    for (const double x : {0.0, 1e9})
        for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {2, 0}, {0, 1}})
            source.positions.emplace_back(x + dx, dy, 0);
    source.positions.emplace_back(0, 1e9, 0);
    source.triangles = {{0, 4, 8}, {0, 0, 1}, {0, 1, 2}, {0, 1, 3}};
    PackCounts counts;
    ASSERT_TRUE(packMesh(source, counts).ok());
    EXPECT_EQ(counts.degenerateTriangles, 3U);
    EXPECT_EQ(counts.emptyTriangles, 2U) << "one is only too small";
}

TEST(PackMesh, SaysWhatCornersAreRoundedToWhereAllAreaIsLostByIt) {
    TriangleMesh two;
    for (const double x : {0.0, 1e9})
        for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {0, 1}})
            two.positions.emplace_back(x + dx, dy, 0);
    two.triangles = {{0, 1, 2}, {3, 4, 5}};
    PackCounts counts;
    EXPECT_THAT(packMesh(two, counts).status().message(),
                testing::AllOf(testing::HasSubstr("found 2 triangles, none with any area where "
                                                  "corners are rounded to"),
                               testing::HasSubstr("far from all others")));
}

TEST(PackMesh, WeighsNormalsByAngleNotByTheCut) {
    // A cube's corner: one face is cut through the corner, the others are not.
    TriangleMesh cube;
    cube.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    cube.triangles = {{0, 3, 1}, {0, 2, 3}, {0, 1, 4}, {1, 5, 4}, {0, 4, 2}, {2, 4, 6}};
    const glm::vec3 normal = normalAt(pack(cube).mesh, {0, 0, 0});
    EXPECT_LT(glm::distance(normal, glm::normalize(glm::vec3(-1, -1, -1))), 1e-4F);
}

TEST(PackMesh, GivesThinSheetsAUnitNormal) {
    TriangleMesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
    EXPECT_EQ(normalAt(pack(sheet).mesh, {0, 0, 0}), glm::vec3(0, 0, 1));
}

TEST(PackMesh, SmoothsAcrossChangesOfColour) {
    TriangleMesh source = test::tetrahedron();
    const glm::vec3 plain = normalAt(pack(source).mesh, {0, 0, 0});
    source.positions.emplace_back(0, 0, 0);
    source.triangles[0][0] = 4;
    source.colours.assign(5, {1, 2, 3, 255});
    source.colours[4] = {9, 9, 9, 255};
    const Packed packed = pack(source);
    EXPECT_EQ(packed.mesh.positions.size(), 5U);
    EXPECT_EQ(normalAt(packed.mesh, {0, 0, 0}), plain);
}

TEST(PackMesh, ComputesOnlyTheNormalsThatTheSourceLacks) {
    TriangleMesh source = test::tetrahedron();
    const glm::vec3 smooth = normalAt(pack(source).mesh, {1, 0, 0});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    source.normals = {{0, 0, 5}, {0, 0, 0}, {nan, 0, 1}, {1, 0, 0}};
    const Packed packed = pack(source, kFile);
    EXPECT_TRUE(packed.counts.normalsComputed);
    EXPECT_EQ(normalAt(packed.mesh, {0, 0, 0}), glm::vec3(0, 0, 1));
    EXPECT_EQ(normalAt(packed.mesh, {0, 0, 1}), glm::vec3(1, 0, 0));
    EXPECT_EQ(normalAt(packed.mesh, {1, 0, 0}), smooth);
}

TEST(PackMesh, IsTheSameForAnyNumberOfThreads) {
    const TriangleMesh source = synthesizeMesh(300000, 5);
    for (const NormalSource normals : {NormalSource::Smooth, NormalSource::Crease}) {
        std::vector<mesh::PackedMesh> packed;
        for (const std::size_t threads : {1U, 2U, 5U}) {
            const oneapi::tbb::global_control limit(
                oneapi::tbb::global_control::max_allowed_parallelism, threads);
            packed.push_back(
                pack(source, {.normals = normals, .creaseDegrees = 5, .orients = true}).mesh);
        }
        EXPECT_TRUE(packed[0] == packed[1]);
        EXPECT_TRUE(packed[0] == packed[2]);
    }
}

TEST(PackMesh, DropsFacesThatAreThereAlreadyButNotTheOtherSide) {
    TriangleMesh source = test::tetrahedron();
    const auto [a, b, c] = source.triangles[1];
    source.positions.push_back(source.positions[a]);  // welded before
    source.triangles.insert(source.triangles.end(), {{b, c, a}, {c, 4, b}, {4, c, b}});
    const Packed packed = pack(source);
    EXPECT_EQ(packed.counts.duplicateTriangles, 2U);
    EXPECT_EQ(packed.mesh.triangles.size(), 5U);
}

constexpr mesh::Material kWall;
constexpr mesh::Material kGlass{.flags = mesh::kIsBlended};
constexpr mesh::Material kFence{.alphaCutoff = 0.5F};

/// How many are left of triangles of these materials in one place, their corners in turn.
std::size_t leftInOnePlace(const std::vector<mesh::Material>& materials,
                           const std::vector<fabric::Rgba>& colours = {}) {
    TriangleMesh source;
    for (std::uint32_t i = 0; i < materials.size(); ++i) {
        std::vector<fabric::Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        std::rotate(corners.begin(), corners.begin() + i % 3, corners.end());
        source.positions.insert(source.positions.end(), corners.begin(), corners.end());
        source.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        source.materialOf.insert(source.materialOf.end(), 3, static_cast<std::uint16_t>(i));
        if (!colours.empty())
            source.colours.insert(source.colours.end(), 3, colours[i]);
    }
    source.materials = materials;
    return pack(source).mesh.triangles.size();
}

TEST(PackMesh, AnOpaqueTriangleHidesWhatIsOpaqueAfterItInItsPlace) {
    EXPECT_EQ(leftInOnePlace({kWall, kWall}), 1U);
    EXPECT_EQ(leftInOnePlace({kWall, kWall}, {{255, 0, 0, 255}, {0, 0, 255, 255}}), 1U);
    EXPECT_EQ(leftInOnePlace({kWall, kFence}), 1U);
}

TEST(PackMesh, WhatIsSeenThroughGlassOrHolesOrOnAWallIsNoDuplicate) {
    EXPECT_EQ(leftInOnePlace({kGlass, kWall}), 2U);
    EXPECT_EQ(leftInOnePlace({kFence, kWall}), 2U);
    EXPECT_EQ(leftInOnePlace({kWall, kGlass}), 2U);
    EXPECT_EQ(leftInOnePlace({kGlass, kWall, kWall, kGlass}), 2U) << "each is kept once";
}

TEST(PackMesh, PanesOfGlassInOnePlaceAreDuplicatesWhereTheyLookTheSame) {
    EXPECT_EQ(leftInOnePlace({kGlass, kGlass}), 1U);
    EXPECT_EQ(leftInOnePlace({kGlass, kGlass}, {{255, 0, 0, 99}, {255, 0, 0, 99}}), 1U);
    EXPECT_EQ(leftInOnePlace({kGlass, kGlass}, {{255, 0, 0, 99}, {0, 0, 255, 99}}), 2U);
}

TEST(PackMesh, WhatIsSeenFromOneSideDoesNotHideWhatIsSeenFromBoth) {
    constexpr mesh::Material kOneSided{.flags = mesh::kIsOneSided};
    EXPECT_EQ(leftInOnePlace({kOneSided, kWall}), 2U);
    EXPECT_EQ(leftInOnePlace({kWall, kOneSided}), 1U);
}

TEST(PackMesh, OfManyTrianglesInOnePlaceTheWallHidesAllOpaqueOnesAfterIt) {
    std::vector<mesh::Material> materials(20, kWall);
    materials[0] = materials[12] = kGlass;
    EXPECT_EQ(leftInOnePlace(materials), 2U);
}

/// Two squares that meet in the y axis, the second one turned up by `degrees`.
TriangleMesh roof(double degrees) {
    const double angle = glm::radians(degrees);
    TriangleMesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}};
    mesh.positions.emplace_back(std::cos(angle), 0, std::sin(angle));
    mesh.positions.emplace_back(std::cos(angle), 1, std::sin(angle));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    return mesh;
}

TEST(PackMesh, SplitsEdgesThatAreSharperThanTheCrease) {
    const auto vertices = [](double degrees, double crease) {
        return pack(roof(degrees), {.normals = NormalSource::Crease, .creaseDegrees = crease})
            .mesh.positions.size();
    };
    EXPECT_EQ(vertices(39, 40), 6U);
    EXPECT_EQ(vertices(41, 40), 8U);
    EXPECT_EQ(vertices(170, 180), 6U);
    EXPECT_EQ(vertices(10, 0), 8U);
}

TEST(PackMesh, GivesEachSideOfACreaseItsOwnNormal) {
    const Packed packed = pack(roof(60), {.normals = NormalSource::Crease, .creaseDegrees = 40});
    for (const mesh::Triangle& triangle : packed.mesh.triangles)
        for (const std::uint32_t corner : triangle) {
            const bool isFlat = &triangle - packed.mesh.triangles.data() < 2;
            const glm::vec3 expected =
                isFlat ? glm::vec3(0, 0, 1) : glm::vec3(-std::sin(glm::radians(60.0)), 0, 0.5);
            EXPECT_LT(glm::distance(mesh::unpackNormal(packed.mesh.normals[corner]), expected),
                      1e-3);
        }
}

TEST(PackMesh, IsSmoothRoundACornerAsFarAsNoEdgeIsACrease) {
    // A fine sphere has no crease, whatever way round a vertex is gone.
    const TriangleMesh source = synthesizeMesh(20000, 3);
    const Packed smooth = pack(source);
    const Packed creased = pack(source, {.normals = NormalSource::Crease, .creaseDegrees = 180});
    EXPECT_EQ(creased.mesh.positions, smooth.mesh.positions);
    for (std::size_t i = 0; i < smooth.mesh.normals.size(); ++i)
        EXPECT_LT(glm::distance(mesh::unpackNormal(creased.mesh.normals[i]),
                                mesh::unpackNormal(smooth.mesh.normals[i])),
                  2e-3);
}

/// Two triangles that share an edge; the second has vertices of its own there.
TriangleMesh texturedPair() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.textureCoordinates = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}};
    mesh.materials = {{}, {.image = 0}};
    mesh.materialOf.assign(6, 1);
    mesh.images = {{{1, 1, 0}, std::vector<std::byte>(8)}};
    return mesh;
}

TEST(PackMesh, WeldsVerticesOfOneMaterialAndPlaceInTheTexture) {
    const auto vertices = [](TriangleMesh mesh) {
        PackCounts counts;
        const auto packed = packMesh(std::move(mesh), counts);
        EXPECT_TRUE(packed.ok()) << packed.status();
        EXPECT_EQ(packed->materialOf.size(), packed->positions.size());
        return packed->positions.size();
    };
    EXPECT_EQ(vertices(texturedPair()), 4U);
    TriangleMesh seam = texturedPair();
    seam.textureCoordinates[3].x = 0.5F;
    EXPECT_EQ(vertices(seam), 5U);
    TriangleMesh other = texturedPair();
    for (std::size_t i = 3; i < 6; ++i) other.materialOf[i] = 0;
    EXPECT_EQ(vertices(other), 6U);
    TriangleMesh plain = seam;  // what has no image has no places in it
    plain.materials = {{}, {.flags = mesh::kIsBlended}};
    plain.images.clear();
    EXPECT_EQ(vertices(plain), 4U);
}

TEST(PackMesh, TakesAnyTextureCoordinates) {
    TriangleMesh mesh = texturedPair();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    mesh.textureCoordinates = {{std::numeric_limits<float>::quiet_NaN(), kInfinity},
                               {1e30F, -1e30F},
                               {-0.25F, 1.0F / 65536},
                               {3, -kInfinity},
                               {200.5F, 0},
                               {0, 1e-9F}};
    PackCounts counts;
    const auto packed = packMesh(mesh, counts);
    ASSERT_TRUE(packed.ok()) << packed.status();
    constexpr int kMost = 16384 * mesh::kTextureSteps;
    EXPECT_EQ(packed->textureCoordinates,
              (std::vector<glm::ivec2>{
                  {0, 0}, {kMost, -kMost}, {-16384, 1}, {3 * 65536, 0}, {401 * 32768, 0}, {0, 0}}));
}

}  // namespace
}  // namespace eyrie::import
