// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_reader.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <assimp/light.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_lights.h"
#include "renderer/import/obj_text.h"
#include "renderer/import/obj_textures.h"
#include "tests/renderer/import/mesh_text.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// An AC3D file: a red square and a grey triangle at places of their own.
constexpr const char* kAc3d = R"(AC3Db
MATERIAL "red" rgb 1 0 0 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0
MATERIAL "half" rgb 0.5 0.5 0.5 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0
OBJECT world
kids 2
OBJECT poly
loc 1 2 3
numvert 4
0 0 0
1 0 0
1 0 1
0 0 1
numsurf 1
SURF 0x10
mat 0
refs 4
0 0 0
1 0 0
2 0 0
3 0 0
kids 0
OBJECT poly
loc 10 0 0
numvert 3
0 0 0
1 0 0
0 1 0
numsurf 1
SURF 0x10
mat 1
refs 3
0 0 0
1 0 0
2 0 0
kids 0
)";

TEST(AssimpReader, TakesMaterialsThatNobodyWouldSeeForOpaque) {
    const test::TemporaryFolder folder;
    std::string unseen = kAc3d;
    unseen.replace(unseen.find("trans 0"), 7, "trans 1");
    test::writeFile(folder.file("m.ac"), unseen);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes, testing::Contains(HasSubstr("1 of 2 materials have no opacity")));
    for (const fabric::Rgba& colour : mesh->colours) EXPECT_EQ(colour.a, 255);
    for (const mesh::Material& material : mesh->materials) EXPECT_FALSE(material.isBlended());
}

TEST(AssimpReader, TakesLightsOfWhichNothingElseIsSaidForOnesThatReachEverywhere) {
    const test::TemporaryFolder folder;
    std::string lit = kAc3d;
    lit.replace(lit.find("kids 2"), 6, "kids 3\nOBJECT light\nloc 0 5 0\nkids 0");
    test::writeFile(folder.file("m.ac"), lit);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->lights.points,
                ElementsAre(fabric::PointLight{{0, 0, 5}, {1, 1, 1}, fabric::kMostReachMetres}));
}

TEST(AssimpReader, PutsObjectsAtTheirPlacesInTheColoursOfTheirMaterials) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.ac"), kAc3d);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->triangles.size(), 3U);
    const std::vector<fabric::Vec3> square = {{1, -3, 2}, {2, -3, 2}, {2, -4, 2}, {1, -4, 2}};
    const std::vector<fabric::Vec3> triangle = {{10, 0, 0}, {11, 0, 0}, {10, 0, 1}};
    std::size_t reds = 0;
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        const bool isRed = mesh->colours[i] == fabric::Rgba{255, 0, 0, 255};
        reds += isRed ? 1 : 0;
        EXPECT_TRUE(isRed || mesh->colours[i] == (fabric::Rgba{128, 128, 128, 255}));
        EXPECT_THAT(isRed ? square : triangle, testing::Contains(mesh->positions[i]));
    }
    EXPECT_EQ(reds, 4U);
    EXPECT_THAT(mesh->notes, ElementsAre(HasSubstr("'loc'")));
}

/// Two nodes that show one triangle, the second mirrored and moved; linear red 0.2159 is shown as
/// 128.
constexpr const char* kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"translation":[1e6,0,0],"children":[1,2]},{"mesh":0},
{"mesh":0,"scale":[-1,1,1],"translation":[0.25,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.21586,1,0,1]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
"min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
                              "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

TEST(AssimpReader, TakesTransformsInDoublePrecisionAndTurnsMirroredFaces) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), kGltf);
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

/// kGltf with a light of `type` at its first node, which is where `place` says.
std::string litGltf(const std::string& light, const std::string& place) {
    std::string lit = kGltf;
    lit.replace(0, 1,
                R"({"extensionsUsed":["KHR_lights_punctual"],"extensions":
{"KHR_lights_punctual":{"lights":[)" +
                    light + "]}},");
    const std::string node = R"({"mesh":0},)";
    lit.replace(lit.find(node), node.size(),
                R"({"mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}})" + place + "},");
    return lit;
}

absl::StatusOr<TriangleMesh> readLitGltf(const std::string& light, const std::string& place = "") {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("lit.gltf"), litGltf(light, place));
    return readWithAssimp(folder.file("lit.gltf"));
}

TEST(AssimpReader, HasLightsWhereTheirNodesPutThem) {
    const auto point = readLitGltf(R"({"type":"point","intensity":4,"color":[1,0.5,0]})",
                                   R"(,"translation":[1,2,3])");
    ASSERT_TRUE(point.ok()) << point.status();
    EXPECT_THAT(point->notes, testing::IsEmpty());
    EXPECT_THAT(point->lights.distant, testing::IsEmpty());
    // Of four candela: as bright as 1 at two metres, where half of 4 / (d/2)^2 arrives.
    EXPECT_THAT(point->lights.points,
                ElementsAre(fabric::PointLight{{1000001, -3, 2}, {1, 0.5, 0}, 2}));

    const auto distant = readLitGltf(R"({"type":"directional","intensity":100000})");
    ASSERT_TRUE(distant.ok()) << distant.status();
    EXPECT_THAT(distant->lights.points, testing::IsEmpty());
    ASSERT_EQ(distant->lights.distant.size(), 1U);
    // Along -z of a model in which y is up.
    EXPECT_LT(glm::distance(distant->lights.distant[0].direction, fabric::Vec3(0, 1, 0)), 1e-12);
    EXPECT_EQ(distant->lights.distant[0].colour, fabric::Vec3(1));
}

TEST(AssimpReader, HasSpotsWithTheConesOfAGltf) {
    const auto spot = readLitGltf(
        R"({"type":"spot","intensity":4,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}})",
        R"(,"translation":[1,2,3],"rotation":[0,0.70710678,0,0.70710678])");
    ASSERT_TRUE(spot.ok()) << spot.status();
    EXPECT_THAT(spot->notes, testing::IsEmpty());
    ASSERT_EQ(spot->lights.points.size(), 1U);
    const fabric::PointLight& light = spot->lights.points[0];
    EXPECT_EQ(light.positionMetres, fabric::Vec3(1000001, -3, 2));
    ASSERT_TRUE(light.cone.has_value());
    // -z, turned by 90 degrees about y, is -x.
    EXPECT_LT(glm::distance(light.cone->axis, fabric::Vec3(-1, 0, 0)), 1e-6);
    EXPECT_NEAR(light.cone->innerDegrees, glm::degrees(0.25), 1e-5);
    EXPECT_NEAR(light.cone->outerDegrees, glm::degrees(0.5), 1e-5);

    const auto plain = readLitGltf(R"({"type":"spot","spot":{}})");
    ASSERT_TRUE(plain.ok()) << plain.status();
    ASSERT_TRUE(plain->lights.points.at(0).cone.has_value());
    EXPECT_EQ(plain->lights.points[0].cone->innerDegrees, 0);
    EXPECT_NEAR(plain->lights.points[0].cone->outerDegrees, 45, 1e-5);
}

/// One light at the root, `change`d.
template <typename Change>
fabric::FileLights lightsOfOne(std::string_view extension, std::vector<std::string>& notes,
                               const Change& change) {
    aiScene scene;  // owns what it points to
    scene.mRootNode = new aiNode("root");
    scene.mNumLights = 1;
    scene.mLights = new aiLight* [1] { new aiLight };
    scene.mLights[0]->mName = "root";
    scene.mLights[0]->mColorDiffuse = aiColor3D(1, 1, 1);
    change(*scene.mLights[0]);
    return lightsOf(scene, extension, glm::dmat4(1), 1, notes);
}

TEST(AssimpReader, TakesConesAsWideAsTheFormatMeansThem) {
    struct Case {
        const char* extension;
        float inner, outer;  ///< as Assimp has them, degrees
        std::optional<fabric::LightCone> cone;
    };
    const fabric::Vec3 down(0, 0, -1);
    const std::vector<Case> cases = {
        {".glb", 20, 40, fabric::LightCone{down, 20, 40}},
        {".fbx", 20, 40, fabric::LightCone{down, 10, 20}},  // across
        {".dae", 100, 150, fabric::LightCone{down, 90, 90}},
        {".dae", 360, 360, std::nullopt},  // what Assimp says where nobody said anything
        {".x3d", 50, 40, fabric::LightCone{down, 40, 40}},
        {".fbx", 30, 200, fabric::LightCone{down, 15, 90}},
    };
    for (const Case& c : cases) {
        std::vector<std::string> notes;
        const auto lights = lightsOfOne(c.extension, notes, [&](aiLight& light) {
            light.mType = aiLightSource_SPOT;
            light.mDirection = aiVector3D(0, 0, -2);
            light.mAngleInnerCone = glm::radians(c.inner);
            light.mAngleOuterCone = glm::radians(c.outer);
        });
        EXPECT_THAT(notes, testing::IsEmpty());
        ASSERT_EQ(lights.points.size(), 1U);
        const auto& cone = lights.points[0].cone;
        ASSERT_EQ(cone.has_value(), c.cone.has_value()) << c.extension << " " << c.outer;
        if (!cone)
            continue;
        EXPECT_EQ(cone->axis, down);
        EXPECT_NEAR(cone->innerDegrees, c.cone->innerDegrees, 1e-4) << c.extension;
        EXPECT_NEAR(cone->outerDegrees, c.cone->outerDegrees, 1e-4) << c.extension;
    }
}

constexpr const char* kSpotX3d =
    R"(<?xml version="1.0" encoding="UTF-8"?><X3D profile="Interchange" version="3.3"><Scene>
<SpotLight DEF="L" location="1 2 3" direction="0 -1 0" beamWidth="0.25" cutOffAngle="0.5"/>
<Shape><IndexedFaceSet coordIndex="0 1 2 -1"><Coordinate point="0 0 0 1 0 0 0 1 0"/>
</IndexedFaceSet></Shape></Scene></X3D>)";

/// Angles are from one edge of the cone to the other.
constexpr const char* kSpotFbx = R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {
FBXVersion: 7300
}
GlobalSettings:  {
Properties70:  {
P: "UnitScaleFactor", "double", "Number", "",100
}
}
Objects:  {
Geometry: 10, "Geometry::", "Mesh" {
Vertices: *9 {
a: 0,0,0,1,0,0,0,1,0
}
PolygonVertexIndex: *3 {
a: 0,1,-3
}
}
Model: 11, "Model::M", "Mesh" {
}
NodeAttribute: 20, "NodeAttribute::L", "Light" {
Properties70:  {
P: "LightType", "enum", "", "",2
P: "InnerAngle", "Number", "", "A",20
P: "OuterAngle", "Number", "", "A",40
}
}
Model: 21, "Model::LN", "Light" {
Properties70:  {
P: "Lcl Translation", "Lcl Translation", "", "A",1,2,3
}
}
}
Connections:  {
C: "OO",11,0
C: "OO",10,11
C: "OO",21,0
C: "OO",20,21
}
)";

TEST(AssimpReader, HasSpotsOfX3dAndFbxAsTheseFormatsMeanThem) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("spot.x3d"), kSpotX3d);
    test::writeFile(folder.file("spot.fbx"), kSpotFbx);
    for (const auto& [name, inner, outer] :
         {std::tuple("spot.x3d", glm::degrees(0.25), glm::degrees(0.5)), {"spot.fbx", 10., 20.}}) {
        const auto spot = readWithAssimp(folder.file(name));
        ASSERT_TRUE(spot.ok()) << spot.status();
        EXPECT_THAT(spot->notes, testing::IsEmpty());
        ASSERT_EQ(spot->lights.points.size(), 1U) << name;
        const auto& cone = spot->lights.points[0].cone;
        ASSERT_TRUE(cone.has_value()) << name;
        EXPECT_LT(glm::distance(cone->axis, fabric::Vec3(0, 0, -1)), 1e-6) << name;
        EXPECT_NEAR(cone->innerDegrees, inner, 1e-4) << name;
        EXPECT_NEAR(cone->outerDegrees, outer, 1e-4) << name;
    }
}

TEST(AssimpReader, SaysWhichLightsAreNotAsTheFileHasThem) {
    std::vector<std::string> notes;
    const auto spots =
        lightsOfOne(".3ds", notes, [](aiLight& light) { light.mType = aiLightSource_SPOT; });
    EXPECT_THAT(notes, ElementsAre(HasSubstr("1 of 1 lights are spots")));
    ASSERT_EQ(spots.points.size(), 1U);
    EXPECT_FALSE(spots.points[0].cone.has_value());

    notes.clear();
    const auto aimless = lightsOfOne(".glb", notes, [](aiLight& light) {
        light.mType = aiLightSource_SPOT;
        light.mAngleInnerCone = light.mAngleOuterCone = 1;
        light.mDirection = aiVector3D(0, 0, 0);
    });
    EXPECT_EQ(aimless.count(), 0U);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("left out 1 of 1 lights, whose numbers")));

    notes.clear();
    EXPECT_EQ(
        lightsOfOne(".glb", notes, [](aiLight& light) { light.mType = aiLightSource_AMBIENT; })
            .count(),
        0U);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("left out 1 of 1 lights")));
}

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

TEST(AssimpReader, SaysThatTexturesAreNotMirrored) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.gltf"), texturedGltf(R"("wrapT":10497)", R"("wrapT":33648)"));
    const auto mesh = readWithAssimp(folder.file("m.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->notes,
                testing::Contains(HasSubstr("textures of 3 materials ought to be mirrored")));
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

TEST(AssimpReader, CutsConcavePolygonsWithoutCoveringWhatIsOutside) {
    const test::TemporaryFolder folder;
    // An L of area 3 whose fan from the first corner would cover 5.
    test::writeFile(folder.file("m.obj"),
                    "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4 5 6\n");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 4U);
    EXPECT_NEAR(test::area(*mesh), 3, 1e-12);
}

TEST(AssimpReader, MultipliesVertexColoursAndLeavesBlankOnesOut) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.mtl"), "newmtl half\nKd 0.5 1 1\n");
    test::writeFile(folder.file("m.obj"),
                    "mtllib m.mtl\nv 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 1 0.5 0\n"
                    "usemtl half\nf 1 2 3\n");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_FALSE(mesh->colours.empty());
    EXPECT_EQ(mesh->colours[0], (fabric::Rgba{128, 128, 0, 255}));
    test::writeFile(folder.file("plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_TRUE(readWithAssimp(folder.file("plain.obj"))->colours.empty());
}

TEST(AssimpReader, SaysWhereCoordinatesLoseWhatOneSees) {
    const test::TemporaryFolder folder;
    const auto notesAt = [&](double x, const std::string& name) {
        test::writeFile(folder.file(name),
                        fmt::format("OFF\n3 1 0\n{} 0 0\n{} 0 0\n{} 1 0\n3 0 1 2\n", x, x + 1, x));
        const auto mesh = readWithAssimp(folder.file(name));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    EXPECT_THAT(notesAt(100, "m.off"), IsEmpty());
    EXPECT_THAT(notesAt(5e5, "m.off"),
                ElementsAre(testing::AllOf(HasSubstr("by up to 0.03 m"), HasSubstr("PLY"))));
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
        test::writeFile(folder.file("m.gltf"), gltf);
        const auto mesh = readWithAssimp(folder.file("m.gltf"));
        EXPECT_TRUE(mesh.ok()) << mesh.status();
        return mesh.ok() ? mesh->notes : std::vector<std::string>();
    };
    EXPECT_THAT(notesOf(gltfOfATriangle("", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0])", "", "")), IsEmpty());
    EXPECT_THAT(notesOf(gltfOfATriangle(R"(, "weights": [0.5])", "", "")),
                ElementsAre(HasSubstr("morph targets of 1 of 1 meshes")));
    EXPECT_THAT(
        notesOf(gltfOfATriangle("", R"(, "skin": 0)",
                                R"("skins": [{"joints": [1], "inverseBindMatrices": 3}],)")),
        ElementsAre(HasSubstr("skeletons of 1 of 1 meshes")));
}

TEST(AssimpReader, ReadsObjsWithIndentsCommentsAndNumbersThatBeginWithTheirPoint) {
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("m.obj"),
                    "\xef\xbb\xbfv .5 0 0 # 1\r\n v 1 -.5 0\r\nv 0 1 .25\nv 9 9 9\n"
                    "usemtl #.5 .5\nf 1 2 3 # all\nf -4 -3 -2#");
    const auto mesh = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    const std::vector<fabric::Vec3> expected = {{0.5, 0, 0}, {1, -0.5, 0}, {0, 1, 0.25}};
    ASSERT_EQ(mesh->triangles.size(), 2U);
    for (const auto& triangle : mesh->triangles)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(mesh->positions[triangle[k]], expected[k]);
    test::writeFile(folder.file("m.obj"),
                    "v 1 2 3 .5 1 .5\nv 2 2 3 .5 1 .5\nv 1 3 3 .5 1 .5\nf 1 2 3\n");
    const auto coloured = readWithAssimp(folder.file("m.obj"));
    ASSERT_TRUE(coloured.ok()) << coloured.status();
    EXPECT_THAT(coloured->positions, testing::Contains(fabric::Vec3(1, 2, 3)));
    EXPECT_THAT(coloured->colours, testing::Each(fabric::Rgba{128, 255, 128, 255}));
}

TEST(ObjForAssimp, LeavesAsTheyAreFilesThatAreReadRightly) {
    EXPECT_FALSE(objForAssimp("# .5\no a .5 # b\nv 0.5 -.5 1.\nvn 0 0 1\nf 1 2 3\n"));
    EXPECT_FALSE(objForAssimp(""));
    EXPECT_FALSE(objForAssimp("f 1 2\\\n 3\n")) << "which goes on";
    EXPECT_EQ(objForAssimp("v .5 .5 1\r\to .5\rvt .1 # .1\r"), "v 0.5 0.5 1\ro .5\rvt 0.1 \r");
}

TEST(AssimpReader, SaysHowLongABinaryStlOughtToBe) {
    const test::TemporaryFolder folder;
    for (const std::string header : {"made by hand", "solid made by hand"}) {
        std::string file = header + std::string(84 + 2 * 50 - header.size(), '\0');
        file[80] = 2;
        file[84 + 26] = file[84 + 40] = '\x40';  // corners at 0 0 0, 2 0 0 and 0 2 0, and no others
        test::writeFile(folder.file("m.stl"), file);
        EXPECT_TRUE(readWithAssimp(folder.file("m.stl")).ok()) << header;
        test::writeFile(folder.file("m.stl"), file.substr(0, 150));
        EXPECT_THAT(std::string(readWithAssimp(folder.file("m.stl")).status().message()),
                    HasSubstr("m.stl: its header counts 2 triangles, which take 184 bytes, and it "
                              "has 150; it is cut off"))
            << header;
    }
}

/// The first facet is red, of its own; the second has the green of the part. Those with the highest
/// bit the other way around are MeshLab's.
TEST(AssimpReader, TakesColoursOfAnStlAsMaterialiseMeansThem) {
    const test::TemporaryFolder folder;
    for (const bool isMeshLab : {false, true}) {
        std::string file(84 + 2 * 50, '\0');
        file.replace(0, 6, "COLOR=");
        file[7] = file[9] = '\xFF';
        file[80] = 2;
        for (const std::size_t facet : {84U, 134U}) file[facet + 26] = file[facet + 40] = '\x40';
        file[84 + 48] = 31;
        file[isMeshLab ? 84 + 49 : 134 + 49] = '\x80';
        test::writeFile(folder.file("m.stl"), file);
        const auto mesh = readWithAssimp(folder.file("m.stl"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        ASSERT_EQ(mesh->triangles.size(), 2U);
        EXPECT_EQ(mesh->colours[mesh->triangles[0][0]], (fabric::Rgba{255, 0, 0, 255}));
        EXPECT_EQ(mesh->colours[mesh->triangles[1][0]], (fabric::Rgba{0, 255, 0, 255}));
    }
}

TEST(AssimpReader, TellsMissingFilesFromBadOnes) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(readWithAssimp(folder.file("no.obj")).status().code(), absl::StatusCode::kNotFound);
    test::writeFile(folder.file("m.3ds"), "this is no 3ds file at all");
    const auto bad = readWithAssimp(folder.file("m.3ds"));
    EXPECT_EQ(bad.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(bad.status().message()), HasSubstr(folder.file("m.3ds")));
}

}  // namespace
}  // namespace eyrie::import
