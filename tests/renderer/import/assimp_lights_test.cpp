// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_lights.h"

#include <chrono>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <assimp/light.h>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/import/assimp_reader.h"
#include "renderer/import/gltf_json.h"
#include "renderer/import/gltf_mending.h"
#include "tests/renderer/import/assimp_files.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::import {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(AssimpReader, TakesLightsOfWhichNothingElseIsSaidForOnesThatReachEverywhere) {
    const test::TemporaryFolder folder;
    std::string lit = test::kAc3d;
    lit.replace(lit.find("kids 2"), 6, "kids 3\nOBJECT light\nloc 0 5 0\nkids 0");
    test::writeFile(folder.file("m.ac"), lit);
    const auto mesh = readWithAssimp(folder.file("m.ac"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_THAT(mesh->lights.points,
                ElementsAre(fabric::PointLight{{0, 0, 5}, {1, 1, 1}, fabric::kMostReachMetres}));
}

/// kGltf with a light of `type` at its first node, which is where `place` says.
std::string litGltf(const std::string& light, const std::string& place) {
    std::string lit = test::kGltf;
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
    EXPECT_THAT(point->notes, ElementsAre(HasSubstr("coordinates are rounded")));
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

/// Of the last two nodes one is called as a light is, and one is not in the scene.
TEST(AssimpReader, HasALightAtEachNodeOfAGltfThatUsesIt) {
    const auto node = [](int light, const std::string& place, const std::string& name) {
        return R"(,{"extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(light) +
               R"(}},"name":")" + name + R"(","translation":)" + place + "}";
    };
    std::string lit = litGltf(R"({"type":"point","intensity":4},{"type":"point"})", "");
    const std::string last = R"("translation":[0.25,0,0]})";
    lit.insert(lit.find(last) + last.size(),
               node(0, "[20,0,0]", "Light") + node(0, "[30,0,0]", "Light") +
                   node(1, "[40,0,0]", "Lamp") + R"(,{"name":"Lamp","translation":[50,0,0]})" +
                   node(1, "[60,0,0]", "Light"));
    const std::string children = R"("children":[1,2])";
    lit.replace(lit.find(children), children.size(), R"("children":[1,2,6,3,4,5])");
    const test::TemporaryFolder folder;
    test::writeFile(folder.file("lit.gltf"), lit);
    const auto mesh = readWithAssimp(folder.file("lit.gltf"));
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.size(), 2U);
    std::vector<double> places;
    for (const fabric::PointLight& light : mesh->lights.points)
        places.push_back(light.positionMetres.x - 1e6);
    EXPECT_THAT(places, testing::UnorderedElementsAre(0, 20, 30, 40));
}

/// What Assimp makes lights of goes by the names of nodes.
TEST(GltfMending, GivesManyNodesOfOneNameTheirOwnAtOnce) {
    constexpr std::size_t kLights = 20'000;
    Json root;
    root["scenes"] = Json::array({Json::object()});
    root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({{{"type", "point"}}});
    for (std::size_t i = 0; i < kLights; ++i) {
        root["scenes"][0]["nodes"].push_back(i);
        Json node = {{"name", "Lamp"}};
        node["extensions"]["KHR_lights_punctual"]["light"] = 0U;
        root["nodes"].push_back(node);
    }
    std::vector<std::string> notes;
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(mendGltf(root, notes));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    std::set<std::string> names;
    for (const Json& node : root["nodes"]) names.insert(textAt(node, "name"));
    EXPECT_EQ(names.size(), kLights);
}

TEST(AssimpReader, HasSpotsWithTheConesOfAGltf) {
    const auto spot = readLitGltf(
        R"({"type":"spot","intensity":4,"spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}})",
        R"(,"translation":[1,2,3],"rotation":[0,0.70710678,0,0.70710678])");
    ASSERT_TRUE(spot.ok()) << spot.status();
    EXPECT_THAT(spot->notes, ElementsAre(HasSubstr("coordinates are rounded")));
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

}  // namespace
}  // namespace eyrie::import
