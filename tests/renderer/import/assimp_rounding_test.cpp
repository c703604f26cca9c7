// SPDX-License-Identifier: Apache-2.0
// What single precision moves is part of the promise: docs/errors.md#single-precision.
#include "renderer/import/assimp_rounding.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/joined_meshes.h"
#include "renderer/import/mesh_import.h"
#include "renderer/mesh/eym_format.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/import/ply_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// How far the nearest vertex is from a place.
double offOf(const TriangleMesh& mesh, const fabric::Vec3& place) {
    double least = 1e300;
    for (const fabric::Vec3& one : mesh.positions)
        least = std::min(least, glm::length(one - place));
    return least;
}

/// A triangle of floats, with what else its node has.
std::string gltfWith(const std::string& transform) {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
"nodes":[{{"mesh":0{}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
"buffers":[{{"byteLength":36,
"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}})",
        transform);
}

constexpr const char* kFarObj =
    "v 100000.0039 100000.0039 0\nv 101000 100000 0\nv 100000 101000 0\nf 1 2 3\n";

TEST(AssimpRounding, OfTextIsInTheErrorOfAFileAndOfItsNodes) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), kFarObj);
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const double off = offOf(*mesh, {100000.0039, 100000.0039, 0});
    EXPECT_GT(off, 0.005);
    EXPECT_LE(off, mesh->roundingMetres);
    for (const bool keepsExact : {false, true}) {
        const auto report = importMesh({folder.file("m.obj")}, folder.file("m.eym"),
                                       {.pack = {.keepsExact = keepsExact}});
        ASSERT_TRUE(report.ok()) << report.status();
        EXPECT_GT(report->errorMetres, mesh->roundingMetres);
        const auto file = mesh::EymFile::open(folder.file("m.eym"));
        ASSERT_TRUE(file.ok()) << file.status();
        for (const mesh::Node& node : file->nodes())
            EXPECT_GE(static_cast<double>(node.errorMetres), report->errorMetres);
        EXPECT_GE(file->finestErrorMetres(), report->errorMetres);
    }
}

TEST(AssimpRounding, OfJoinedFilesIsTheMost) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"), kFarObj);
    test::writeFile(folder.file("m.ply"),
                    test::plyOf(test::tetrahedron(), test::Encoding::LittleEndian));
    const std::vector<std::string> paths = {folder.file("m.obj"), folder.file("m.ply")};
    EXPECT_EQ(readMeshes(paths)->roundingMetres,
              readWithAssimp(folder.file("m.obj"))->roundingMetres);
    EXPECT_EQ(readMeshes(std::vector{paths[1]})->roundingMetres, 0);
}

TEST(AssimpRounding, IsThatOfTextInStl) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.stl"),
                    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 4512345.678 0 0\n"
                    "vertex 4512346.678 0 0\nvertex 4512345.678 1 0\nendloop\nendfacet\n"
                    "endsolid a\n");
    const auto text = readWithAssimp(folder.file("m.stl"));
    ASSERT_TRUE(text.ok()) << text.status();
    EXPECT_GT(offOf(*text, {4512345.678, 0, 0}), 0.1);
    EXPECT_LE(offOf(*text, {4512345.678, 0, 0}), text->roundingMetres);
    EXPECT_THAT(text->notes, Contains(HasSubstr("coordinates are rounded, by up to")));
    std::string binary(134, '\0');
    binary[80] = 1;
    const float corners[9] = {4512345.5F, 0, 0, 4512346.5F, 0, 0, 4512345.5F, 1, 0};
    std::memcpy(binary.data() + 96, corners, sizeof corners);
    test::writeFile(folder.file("b.stl"), binary);
    const auto floats = readWithAssimp(folder.file("b.stl"));
    ASSERT_TRUE(floats.ok()) << floats.status();
    EXPECT_EQ(floats->roundingMetres, 0);
    EXPECT_THAT(floats->notes, IsEmpty());
}

TEST(AssimpRounding, OfWhereANodeOfAGltfIsIsToldAndPromised) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"),
                    gltfWith(R"(,"translation":[500123.4567,35.2,-4512345.678])"));
    const auto moved = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(moved.ok()) << moved.status();
    const double off = offOf(*moved, {500123.4567, 4512345.678, 35.2});
    EXPECT_GT(off, 0.1);
    EXPECT_LE(off, moved->roundingMetres);
    EXPECT_THAT(moved->notes, Contains(HasSubstr("coordinates are rounded, by up to")));
    test::writeFile(folder.file("m.gltf"), gltfWith(""));
    const auto still = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(still.ok()) << still.status();
    EXPECT_EQ(still->roundingMetres, 0);
}

/// Chains of nodes as single precision has them, against the same in double precision.
TEST(AssimpRounding, OfChainsOfNodesIsNeverLessThanWhatTheyMove) {
    for (int i = 0; i < 200; ++i) {
        glm::dmat4 worldFromPoint(1);
        AssimpPlace place(worldFromPoint);
        for (int level = 0; level < 1 + i % 6; ++level) {
            const double number = 10 * i + level;
            const glm::dvec3 way(1e4 * std::sin(number), 1e3 * std::cos(3 * number),
                                 7 / (1 + number));
            const glm::dquat turn = glm::normalize(
                glm::dquat(std::cos(number), std::sin(2 * number), std::sin(5 * number), 0.3));
            const double scale = 0.1 + std::abs(std::sin(7 * number));
            worldFromPoint = worldFromPoint * glm::translate(glm::dmat4(1), way) *
                             glm::mat4_cast(turn) * glm::scale(glm::dmat4(1), glm::dvec3(scale));
            const glm::mat4 single = glm::translate(glm::mat4(1), glm::vec3(way)) *
                                     glm::mat4_cast(glm::quat(turn)) *
                                     glm::scale(glm::mat4(1), glm::vec3(static_cast<float>(scale)));
            place = place.child(glm::dmat4(single));
        }
        const glm::dvec4 point(100 * std::sin(i), 30, -20.7, 1);
        const glm::dvec4 rounded(glm::vec4{point});
        EXPECT_LE(glm::length(place.worldFromNode() * rounded - worldFromPoint * point),
                  place.roundingMetres(glm::length(glm::dvec3(point)), true))
            << i;
    }
}

}  // namespace
}  // namespace eyrie::import
