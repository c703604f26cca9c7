// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(AssimpReader, TakesTransformsInDoublePrecisionAndTurnsMirroredFaces) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), test::kGltf);
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 2U);
    for (const auto& [a, b, c] : mesh->triangles) {  // seen from -y, where z of the file points
        const auto normal = glm::cross(mesh->positions[b] - mesh->positions[a],
                                       mesh->positions[c] - mesh->positions[a]);
        EXPECT_EQ(normal, fabric::Vec3(0, -1, 0));
    }
    // In float the quarter would be gone: 1e6 has a spacing of 1/16.
    EXPECT_THAT(mesh->positions, testing::Contains(fabric::Vec3(999999.25, 0, 0)));
    for (const fabric::Rgba colour : mesh->colours)
        EXPECT_EQ(colour, (fabric::Rgba{128, 255, 0, 255}));
}

constexpr const char* kGltfWithABuffer =
    R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],
"buffers":[{{"byteLength":36,"uri":"{}"}}]}})";

TEST(AssimpReader, FindsBuffersOfAGltfByUriAndByPlainName) {
    const test::TemporaryFolder folder;
    std::string corners(36, '\0');
    corners.replace(14, 2, "\x80\x3F").replace(30, 2, "\x80\x3F");  // of 1, 0 and 0, 1
    for (const auto& [uri, file] : {std::pair("a%20%C3%A4.bin", "a \xC3\xA4.bin"),
                                    {"b c.bin", "b c.bin"},
                                    {"d%20e.bin", "d%20e.bin"},
                                    {"100%.bin", "100%.bin"}}) {
        test::writeFile(folder.file(file), corners);
        test::writeFile(folder.file("m.gltf"), fmt::format(kGltfWithABuffer, uri));
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        ASSERT_TRUE(mesh.ok()) << uri << ": " << mesh.status();
        EXPECT_NEAR(test::area(*mesh), 0.5, 1e-12) << uri;
    }
}

/// A triangle that node 0 has, with what else is said of its mesh and node, and of the file.
std::string gltfOfATriangle(std::string_view ofMesh, std::string_view ofNode,
                            std::string_view rest) {
    const std::string zeros(400, 'A');  // places, joints and matrices: all 0
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}],
"nodes": [{{"mesh": 0 {1}}}, {{}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0,
"JOINTS_0": 1, "WEIGHTS_0": 2}}, "targets": [{{"POSITION": 0}}]}}] {0}}}], {2}
"buffers": [{{"byteLength": 300, "uri": "data:application/octet-stream;base64,{3}"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 300}}],
"accessors": [
{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}},
{{"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC4"}},
{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC4"}},
{{"bufferView": 0, "componentType": 5126, "count": 1, "type": "MAT4"}}]}})",
        ofMesh, ofNode, rest, zeros);
}

TEST(AssimpReader, SaysThatShapesAndSkeletonsAreLeftOut) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& gltf) {
        return test::notesOfFile(folder.file("m.gltf"), gltf);
    };
    EXPECT_THAT(notesOf(gltfOfATriangle("", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0])", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0.5])", "", "")),
                ElementsAre(HasSubstr("morph targets of 1 of 1 meshes")));
    EXPECT_THAT(notesOf(gltfOfATriangle("", R"(, "weights": [0])", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle("", R"(, "weights": [0.5])", "")),
                ElementsAre(HasSubstr("weights of morph targets of 1 nodes")));
    EXPECT_THAT(
        notesOf(gltfOfATriangle("", R"(, "skin": 0)",
                                R"("skins": [{"joints": [1], "inverseBindMatrices": 3}],)")),
        ElementsAre(HasSubstr("skeletons of 1 of 1 meshes")));
}

TEST(AssimpReader, PassesPrimitivesOfGltfWithoutPositionsOver) {
    const test::TemporaryFolder folder;
    const auto gltfWith = [](const std::string& primitives) {
        std::string gltf = test::kGltf;
        return gltf.replace(gltf.find(R"({"attributes")"), 0, primitives);
    };
    test::writeFile(folder.file("m.gltf"),
                    gltfWith(R"({"attributes":{"NORMAL":0}},{"attributes":{}},{},)"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 2U);
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("left out 3 of 4 parts of its meshes")));
    std::string none = gltfWith(R"({"attributes":{}}]},{"primitives":[)");
    test::writeFile(folder.file("m.gltf"), none.replace(none.rfind("\"mesh\":0"), 8, "\"mesh\":1"));
    const auto other = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(other.ok()) << other.status();
    EXPECT_EQ(other->triangles.size(), 1U) << "of the second node's mesh";
}

TEST(AssimpReader, ReadsGltfThatBeginsWithAByteOrderMark) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), "\xef\xbb\xbf" + std::string(test::kGltf));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 2U);
    EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr("coordinates are rounded")));
    test::writeFile(folder.file("m.glb"), "\xef\xbb\xbf" + std::string(test::kGltf));
    EXPECT_THAT(std::string(readWithAssimp(folder.file("m.glb")).status().message()),
                HasSubstr("is a .gltf file by what is in it"));
}

TEST(AssimpReader, CountsMeshesOfGltfThatNobodySees) {
    const test::TemporaryFolder folder;
    const auto notesOf = [&](const std::string& alpha, const std::string& mode) {
        std::string gltf = test::kGltf;
        gltf.replace(gltf.find(",1]}"), 4, "," + alpha + "]}," + mode);
        gltf.replace(gltf.find("1e6"), 3, "0.5");
        return test::notesOfFile(folder.file("m.gltf"), gltf);
    };
    EXPECT_THAT(notesOf("0", R"("alphaMode":"BLEND")"),
                ElementsAre(HasSubstr("nobody sees 1 of 1 meshes")));
    EXPECT_THAT(notesOf("0.01", R"("alphaMode":"BLEND")"), IsEmpty());
    EXPECT_THAT(notesOf("0", R"("alphaMode":"OPAQUE")"), IsEmpty());
}

/// Of two triangles, the second of which may have a corner that is no vertex.
std::string gltfOfTwoTriangles(int lastCorner) {
    const std::string base64 =
        fmt::format("AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAABAA{}A",
                    lastCorner == 2 ? "I" : "k");  // or 9
    const std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
    return fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
"nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{0}, {0}]}}],
"buffers": [{{"byteLength": 48, "uri": "data:application/octet-stream;base64,{1}"}}],
"bufferViews": [{{"buffer": 0, "byteLength": 36}},
{{"buffer": 0, "byteOffset": 36, "byteLength": 12}}],
"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
"min": [0, 0, 0], "max": [1, 1, 0]}},
{{"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}}]}})",
        primitive, base64);
}

TEST(AssimpReader, SaysWhatAssimpPassesOver) {
    const test::TemporaryFolder folder;
    const auto read = [&](int lastCorner) {
        test::writeFile(folder.file("m.gltf"), gltfOfTwoTriangles(lastCorner));
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? *mesh : TriangleMesh{};
    };
    const TriangleMesh sound = read(2);
    EXPECT_EQ(sound.triangles.size(), 4U);
    EXPECT_THAT(sound.notes, IsEmpty());
    const TriangleMesh broken = read(9);
    EXPECT_EQ(broken.triangles.size(), 2U);
    EXPECT_THAT(broken.notes, ElementsAre(HasSubstr("out-of-range indices")));
}

}  // namespace
}  // namespace eyrie::import
