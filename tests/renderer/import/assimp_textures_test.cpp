// SPDX-License-Identifier: Apache-2.0
// Textures of files that Assimp reads.
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/obj_textures.h"
#include "tests/renderer/import/tga_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Three triangles: of glass with an image, cut out of it, and of neither.
constexpr const char* kTexturedGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0},
{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":1},
{"attributes":{"POSITION":0},"material":2}]}],
"materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.4],
"baseColorTexture":{"index":0}}},
{"alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,
"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},
{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,0.1],"baseColorTexture":{"index":0}}}],
"samplers":[{"wrapS":33071,"wrapT":10497}],"textures":[{"source":0,"sampler":0}],
"images":[{"uri":"data:image/png;base64,QUJDRA=="}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]},{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

TEST(AssimpReader, TakesMaterialsAndImagesThatAreInTheFile) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), kTexturedGltf);
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->textures.size(), 1U);
    EXPECT_THAT(mesh->textures[0].bytes,
                ElementsAre(std::byte{'A'}, std::byte{'B'}, std::byte{'C'}, std::byte{'D'}));
    EXPECT_EQ(mesh->textures[0].flags, mesh::kClampsU);
    ASSERT_EQ(mesh->triangles.size(), 3U);
    const auto materialOf = [&](std::size_t triangle) {
        return mesh->materials[mesh->materialOf[mesh->triangles[triangle][0]]];
    };
    EXPECT_EQ(materialOf(0),
              (mesh::Material{.image = 0, .flags = mesh::kIsBlended | mesh::kIsOneSided}));
    EXPECT_EQ(materialOf(1),
              (mesh::Material{.image = 0, .flags = mesh::kIsTwoSided, .alphaCutoff = 0.25F}));
    EXPECT_EQ(materialOf(2), (mesh::Material{.flags = mesh::kIsOneSided}));
    EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 255, 255, 102}));
    EXPECT_EQ(mesh->colours[mesh->triangles[2][0]], (fabric::Rgba{255, 0, 0, 255})) << "opaque";
    EXPECT_EQ(mesh->textureCoordinates[mesh->triangles[0][1]], glm::vec2(0, 1)) << "v down";
}

/// kTexturedGltf with something else in a place.
std::string texturedGltf(std::string_view from, std::string_view to) {
    std::string text = kTexturedGltf;
    return text.replace(text.find(from), from.size(), to);
}

fabric::Rgba firstColourOf(const std::string& gltf) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), gltf);
    const auto mesh = readMesh(folder.file("m.gltf"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? mesh->colours[mesh->triangles[0][0]] : fabric::Rgba{};
}

TEST(AssimpReader, TakesAGltfsColoursOfThreeNumbersForOpaque) {
    EXPECT_EQ(firstColourOf(texturedGltf(R"("TEXCOORD_0":1})", R"("TEXCOORD_0":1,"COLOR_0":0})")),
              (fabric::Rgba{0, 0, 0, 102}));
}

/// kTexturedGltf with another factor and an image of one texel beside it.
absl::StatusOr<TriangleMesh> readWithTexel(std::string_view factor, fabric::Rgba texel) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.tga"), test::tgaOf(1, 1, {texel}));
    std::string text = texturedGltf("[1,1,1,0.4]", factor);
    const std::string_view image = "data:image/png;base64,QUJDRA==";
    text.replace(text.find(image), image.size(), "m.tga");
    test::writeFile(folder.file("m.gltf"), text);
    return readMesh(folder.file("m.gltf"));
}

TEST(AssimpReader, KeepsAGltfsTexturesBlackWhereTheirFactorIs) {
    const auto mesh = readWithTexel("[0,0,0,0.4]", {9, 8, 7, 255});
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->images.size(), 1U);
    EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{0, 0, 0, 102}));
}

TEST(AssimpReader, LeavesTheAlphaOfAGltfsImagesAsItIs) {
    const auto mesh = readWithTexel("[1,1,1,1]", {9, 8, 7, 225});
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->images.size(), 1U);
    EXPECT_TRUE(mesh->images[0].shape.hasAlpha());
    const auto materialOf = [&](std::size_t triangle) {
        return mesh->materials[mesh->materialOf[mesh->triangles[triangle][0]]];
    };
    EXPECT_TRUE(materialOf(0).isBlended());
    EXPECT_EQ(materialOf(1).alphaCutoff, 0.25F);
}

/// The second triangle of kTexturedGltf without its image: the factor's alpha decides.
TEST(AssimpReader, LeavesOutWhatAGltfCutsAwayWithoutAnImage) {
    const test::TemporaryFolder folder;
    const auto read = [&](std::string_view alpha) {
        const std::string factor = fmt::format(
            R"("doubleSided":true,"pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,{}]}}}})",
            alpha);
        test::writeFile(folder.file("m.gltf"), texturedGltf(R"("doubleSided":true,
"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})",
                                                            factor));
        const auto mesh = readMesh(folder.file("m.gltf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? *mesh : TriangleMesh{};
    };
    const auto isTold = testing::Contains(HasSubstr("left out 1 triangles whose opacity"));
    for (const char* alpha : {"1", "0.3", "0.25"}) {
        const TriangleMesh mesh = read(alpha);
        EXPECT_EQ(mesh.triangles.size(), 3U) << alpha;
        EXPECT_THAT(mesh.notes, testing::Not(isTold));
    }
    for (const char* alpha : {"0.24", "0"}) {
        const TriangleMesh mesh = read(alpha);
        EXPECT_EQ(mesh.triangles.size(), 2U) << alpha;
        EXPECT_THAT(mesh.notes, isTold);
    }
}

/// Where the point at u = 1 or v = 1 of a texture comes to by a KHR_texture_transform, v downwards.
glm::vec2 transformedPlace(std::string_view transform, bool isV) {
    const test::TemporaryFolder folder;
    std::string text = texturedGltf(
        R"("baseColorTexture":{"index":0})",
        fmt::format(
            R"("baseColorTexture":{{"index":0,"extensions":{{"KHR_texture_transform":{{{}}}}}}})",
            transform));
    text.insert(1, R"("extensionsUsed":["KHR_texture_transform"],)");
    const std::string_view places = R"("count":3,"type":"VEC2")";
    if (!isV)  // the floats are 0 0 0 1 0 0 from the first, and 0 0 1 0 0 0 from the second
        text.insert(text.find(places), R"("byteOffset":4,)");
    test::writeFile(folder.file("m.gltf"), text);
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    EXPECT_TRUE(mesh.ok()) << mesh.status();
    return mesh.ok() ? mesh->textureCoordinates[mesh->triangles[0][1]] : glm::vec2(0);
}

void expectTransform(std::string_view transform, glm::vec2 ofU, glm::vec2 ofV) {
    SCOPED_TRACE(transform);
    const glm::vec2 u = transformedPlace(transform, false);
    const glm::vec2 v = transformedPlace(transform, true);
    EXPECT_LT(glm::distance(u, ofU), 1e-6F) << u.x << ", " << u.y;
    EXPECT_LT(glm::distance(v, ofV), 1e-6F) << v.x << ", " << v.y;
}

/// The second and third are the examples of the extension's own text: the lower left quarter of an
/// image, turned clockwise, and an image upside down.
TEST(AssimpReader, PutsTexturesWhereAGltfsTransformsDo) {
    expectTransform("", {1, 0}, {0, 1});
    expectTransform(R"("offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5])", {0, 0.5F},
                    {0.5F, 1});
    expectTransform(R"("offset":[0,1],"scale":[1,-1])", {1, 1}, {0, 0});
    expectTransform(R"("scale":[0.5,0.25])", {0.5F, 0}, {0, 0.25F});
    expectTransform(R"("offset":[0.1,0.2],"rotation":0.52359877559,"scale":[2,3])",
                    {1.8320508F, -0.8F}, {1.6F, 2.7980762F});
}

/// The second set begins a float later: its middle place is at v = 0, the first's at v = 1.
TEST(AssimpReader, TakesTheTextureCoordinatesThatAGltfsTransformNames) {
    const auto placeWith = [](const std::string& texture) {
        const test::TemporaryFolder folder;
        std::string text = texturedGltf(R"("baseColorTexture":{"index":0})",
                                        R"("baseColorTexture":{"index":0)" + texture + "}");
        text.insert(1, R"("extensionsUsed":["KHR_texture_transform"],)");
        const std::string_view set = R"("TEXCOORD_0":1)";
        text.replace(text.find(set), set.size(), R"("TEXCOORD_0":1,"TEXCOORD_1":2)");
        const std::string_view places = R"("count":3,"type":"VEC2"})";
        text.insert(text.find(places) + places.size(),
                    R"(,{"bufferView":0,"byteOffset":4,"componentType":5126,"count":3,)"
                    R"("type":"VEC2"})");
        test::writeFile(folder.file("m.gltf"), text);
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->textureCoordinates[mesh->triangles[0][1]] : glm::vec2(-1);
    };
    EXPECT_EQ(placeWith(""), glm::vec2(0, 1));
    const auto transform = [](const std::string& inner) {
        return R"(,"extensions":{"KHR_texture_transform":{)" + inner + "}}";
    };
    EXPECT_EQ(placeWith(transform("")), glm::vec2(0, 1));
    EXPECT_EQ(placeWith(transform(R"("texCoord":1)")), glm::vec2(1, 0));
    EXPECT_EQ(placeWith(R"(,"texCoord":1)" + transform("")), glm::vec2(1, 0));
    EXPECT_EQ(placeWith(R"(,"texCoord":1)" + transform(R"("texCoord":0)")), glm::vec2(0, 1));
}

TEST(AssimpReader, SaysThatTexturesAreNotMirrored) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), texturedGltf(R"("wrapT":10497)", R"("wrapT":33648)"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes,
                testing::Contains(HasSubstr("textures of 3 materials ought to be mirrored")));
}

TEST(AssimpReader, SaysThatTexturesAreFilteredThatAreNotToBe) {
    const test::TemporaryFolder folder;
    const auto expectNote = [&](const std::string& filter, const auto& expected) {
        test::writeFile(folder.file("m.gltf"),
                        texturedGltf(R"("wrapT":10497)", R"("wrapT":10497,"magFilter":)" + filter));
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        EXPECT_THAT(mesh->notes, expected);
    };
    const auto note = testing::Contains(HasSubstr("textures of 3 materials ought to show their"));
    expectNote("9728", note);
    expectNote("9729", testing::Not(note));
}

TEST(AssimpReader, ScalesAndShiftsTexturesOfAnObjAsItsMaterialsSay) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"),
                    "mtllib m.mtl\r\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                    "usemtl my wall\nf 1/1 2/2 3/3\n");
    const auto expect = [&](const std::string& mapKd, glm::vec2 ofU, glm::vec2 ofV) {
        SCOPED_TRACE(mapKd);
        test::writeFile(folder.file("m.mtl"), "newmtl my wall\r\nKd 1 1 1\r\n" + mapKd + "\r\n");
        const auto mesh = readWithAssimp(folder.file("m.obj"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->textures.size(), 1U);
        EXPECT_EQ(mesh->textures[0].name, "a wall.png");
        const auto& [origin, u, v] = mesh->triangles[0];
        const auto& places = mesh->textureCoordinates;
        EXPECT_LT(glm::distance(places[u], ofU), 1e-6F) << places[u].x << ", " << places[u].y;
        EXPECT_LT(glm::distance(places[v], ofV), 1e-6F) << places[v].x << ", " << places[v].y;
    };
    // v goes up in the file and down here.
    expect("map_Kd a wall.png", {1, 1}, {0, 0});
    expect("map_Kd -s 2 3 1 -o 0.25 0.5 0 a wall.png", {2.25F, 0.5F}, {0.25F, -2.5F});
    expect("map_Kd -s 2 3 a wall.png", {2, 1}, {0, -2});
    expect("map_kd -s 2 3 a wall.png", {2, 1}, {0, -2});
    expect("map_Kd -o 0.25 -clamp off -mm 0 1 -t 1 1 1 a wall.png", {1.25F, 1}, {0.25F, 0});
}

TEST(AssimpReader, SaysWhichTexturesItLeavesOut) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"),
                    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                    "usemtl leaf\nf 1/1 2/2 3/3\nusemtl wall\nf 2/2 1/1 3/3\n");
    const auto notesOf = [&](const std::string& ofLeaf, const std::string& ofWall) {
        test::writeFile(folder.file("m.mtl"), "newmtl leaf\nmap_Kd a.png\n" + ofLeaf +
                                                  "newmtl wall\nmap_Kd b.png\n" + ofWall);
        return readWithAssimp(folder.file("m.obj"))->notes;
    };
    EXPECT_THAT(notesOf("", ""), testing::IsEmpty());
    EXPECT_THAT(notesOf("map_d a.png\n", ""), testing::IsEmpty()) << "the alpha of the same image";
    EXPECT_THAT(notesOf("", "map_Bump c.png\nmap_Ks d.png\n"),
                ElementsAre(testing::AllOf(HasSubstr("left out the textures of 1 materials"),
                                           testing::Not(HasSubstr("opacity")))));
    EXPECT_THAT(notesOf("map_d c.png\n", "map_Bump c.png\n"),
                ElementsAre(testing::AllOf(HasSubstr("left out the textures of 2 materials"),
                                           HasSubstr("opacity of 1"))));
}

TEST(ObjTextures, KeepNamesThatLookLikeNumbersOrOptions) {
    EXPECT_EQ(parseMapKd("-s 2 2 2"), (ObjTexture{"2", {2, 2}}));
    EXPECT_EQ(parseMapKd(" -s 2 3.png "), (ObjTexture{"3.png", {2, 1}}));
    EXPECT_EQ(parseMapKd("-my texture.png"), (ObjTexture{"-my texture.png"}));
    EXPECT_EQ(parseMapKd("-o"), ObjTexture());
    EXPECT_EQ(parseMapKd(""), ObjTexture());
}

TEST(AssimpReader, TakesTheFirstOfARaceTracksTextures) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.acc"),
                    "AC3Db\nMATERIAL \"\" rgb 0.4 0.4 0.4 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 1 "
                    "trans 0\nOBJECT world\nkids 1\nOBJECT poly\nname \"a\"\n"
                    "texture \"road.png\" base\ntexture \"skid.png\" skids\n"
                    "texture empty_texture_no_mapping shad\nnumvert 3\n0 0 0\n1 0 0\n0 0 1\n"
                    "numsurf 1\nSURF 0x10\nmat 0\nrefs 3\n0 0 0\n1 1 0\n2 0 1\nkids 0\n");
    const auto mesh = readWithAssimp(folder.file("m.acc"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->textures.size(), 1U);
    EXPECT_EQ(mesh->textures[0].name, "road.png");
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{102, 102, 102, 255})) << "until it is there";
}

}  // namespace
}  // namespace eyrie::import
