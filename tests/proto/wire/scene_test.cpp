// SPDX-License-Identifier: Apache-2.0
#include "wire/scene.h"

#include <limits>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "eyrie/v1/render_service.pb.h"
#include "eyrie/v1/scene.pb.h"
#include "wire/json.h"
#include "wire/scene_info.h"

namespace eyrie::wire {
namespace {

absl::StatusOr<fabric::Scene> sceneFrom(const std::string& json) {
    const absl::StatusOr<v1::Scene> message = sceneMessageFromJson(json, "scene.json");
    if (!message.ok())
        return message.status();
    return fromMessage(*message);
}

std::string refusal(const std::string& json) {
    return std::string(sceneFrom(json).status().message());
}

fabric::Scene anyScene() {
    const auto number = [] { return *rc::gen::inRange(-1000, 1000) / 100.0; };
    const auto fraction = [] { return *rc::gen::inRange(0, 1001) / 1000.0; };
    fabric::Scene scene;
    for (int i = 0; i < *rc::gen::inRange(0, 4); ++i) {
        fabric::SceneObject object{"object", fabric::ObjectKind::Terrain, "a.eyt", {}, {}};
        object.kind = *rc::gen::element(fabric::ObjectKind::Terrain, fabric::ObjectKind::Mesh);
        object.worldFromObject = fabric::Mat4(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) object.worldFromObject[column][row] = number();
        object.colour = {fraction(), fraction(), fraction()};
        object.singleSided = object.kind == fabric::ObjectKind::Mesh && *rc::gen::arbitrary<bool>();
        if (object.kind == fabric::ObjectKind::Terrain && *rc::gen::arbitrary<bool>())
            object.imagery = {"a.tif", "folder/b.jpg"};
        scene.objects.push_back(object);
    }
    for (int i = 0; i < *rc::gen::inRange(0, 5); ++i)
        scene.lights.push_back({{number(), number(), 1}, {fraction(), fraction(), fraction()}});
    for (int i = 0; i < *rc::gen::inRange(0, 3); ++i)
        scene.pointLights.push_back({{number(), number(), number()},
                                     {fraction(), fraction(), fraction()},
                                     fraction() + 0.5});
    if (!scene.pointLights.empty() && *rc::gen::arbitrary<bool>())
        scene.pointLights.back().cone = {{number(), number(), 1}, 40 * fraction(), 45};
    scene.ambient = fraction();
    scene.background.g = *rc::gen::arbitrary<std::uint8_t>();
    return scene;
}

RC_GTEST_PROP(WireScene, ComesBackAsItWas, ()) {
    const fabric::Scene scene = anyScene();
    RC_PRE(fabric::validate(scene).ok());
    fabric::Scene back = fromMessage(toMessage(scene)).value();
    // Colours pass through the sRGB curve and back, which rounds.
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        RC_ASSERT(glm::distance(back.objects[i].colour, scene.objects[i].colour) < 1e-12);
        back.objects[i].colour = scene.objects[i].colour;
    }
    RC_ASSERT(back == scene);
}

TEST(WireScene, TheTransformScalesThenRotatesThenTranslates) {
    const fabric::Scene scene =
        sceneFrom(R"({"objects":[{"mesh":"a/b.eym","transform":{"translation":[10,0,0],
                   "axisDegrees":[0,0,2,90],"scale":3}}]})")
            .value();
    const fabric::Vec4 moved = scene.objects[0].worldFromObject * fabric::Vec4(1, 0, 0, 1);
    EXPECT_LT(glm::distance(fabric::Vec3(moved), fabric::Vec3(10, 3, 0)), 1e-12);
}

TEST(WireScene, AMatrixIsWrittenRowByRow) {
    const fabric::Scene scene =
        sceneFrom(
            R"({"objects":[{"mesh":"b.eym","transform":{"matrix":[1,0,0,7, 0,1,0,8, 0,0,1,9, 0,0,0,1]}}]})")
            .value();
    EXPECT_EQ(scene.objects[0].worldFromObject[3], fabric::Vec4(7, 8, 9, 1));
}

TEST(WireScene, WhatIsAbsentTakesItsDefault) {
    const fabric::Scene scene =
        sceneFrom(R"({"objects":[{"terrain":"/data/rainier.eyt"}]})").value();
    EXPECT_EQ(scene.objects[0].name, "rainier.eyt");
    EXPECT_EQ(scene.objects[0].kind, fabric::ObjectKind::Terrain);
    EXPECT_EQ(scene.objects[0].worldFromObject, fabric::Mat4(1.0));
    EXPECT_EQ(scene.ambient, fabric::Scene{}.ambient);
    EXPECT_EQ(scene.background, fabric::Scene{}.background);
}

TEST(WireScene, NamesThatAreOfAddressesHaveNoQuery) {
    EXPECT_EQ(sceneFrom(R"({"objects":[{"terrain":"https://h/dem.eyt?sig=S/x"}]})")
                  .value()
                  .objects[0]
                  .name,
              "dem.eyt?…");
}

TEST(WireScene, AmbientMayBeZero) { EXPECT_EQ(sceneFrom(R"({"ambient":0})").value().ambient, 0); }

TEST(WireScene, ColoursAreSrgb) {
    const fabric::Scene scene =
        sceneFrom(R"({"objects":[{"mesh":"a.eym","colour":[0,0.5,1]}],"background":[0,0.5,1]})")
            .value();
    EXPECT_NEAR(scene.objects[0].colour.y, 0.21404, 1e-5);
    EXPECT_EQ(scene.objects[0].colour.z, 1);
    EXPECT_EQ(scene.background, (fabric::Rgba{0, 128, 255, 255}));
}

TEST(WireScene, ARefusalNamesTheObjectAndField) {
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a.eym"},{"name":"ghost"}]})"),
                testing::HasSubstr("objects[1] 'ghost' has no data"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","transform":{"scale":0}}]})"),
                testing::HasSubstr("objects[0].transform.scale"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","transform":{"scale":2,"matrix":[1]}}]})"),
                testing::HasSubstr("objects[0].transform has a matrix besides"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","transform":{"matrix":[1]}}]})"),
                testing::HasSubstr("objects[0].transform.matrix has 1 numbers"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","transform":{"axisDegrees":[0,0,0,9]}}]})"),
                testing::HasSubstr("objects[0].transform.axisDegrees"));
    EXPECT_THAT(refusal(R"({"objects":[{"terrain":"a","singleSided":true}]})"),
                testing::HasSubstr("objects[0].singleSided"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","imagery":["b.tif"]}]})"),
                testing::HasSubstr("objects[0].imagery"));
    EXPECT_THAT(refusal(R"({"objects":[{"mesh":"a","colour":[0,0,2]}]})"),
                testing::HasSubstr("objects[0].colour[2]"));
    EXPECT_THAT(refusal(R"({"background":["NaN",0,0]})"), testing::HasSubstr("background[0]"));
    EXPECT_THAT(refusal(R"({"lights":[{"colour":[1,1,1]}]})"),
                testing::HasSubstr("lights[0].direction"));
    EXPECT_THAT(refusal(R"({"lights":[{"direction":[0,0,1],"colour":[1,-1,1]}]})"),
                testing::HasSubstr("lights[0].colour[1]"));
    EXPECT_THAT(refusal(R"({"pointLights":[{"reach":1}]})"),
                testing::HasSubstr("pointLights[0].position"));
    EXPECT_THAT(refusal(R"({"pointLights":[{"position":[0,0,1]}]})"),
                testing::HasSubstr("scene.pointLights[0].reach is 0"));
    const auto refusalOfCone = [](const std::string& cone) {
        return refusal(R"({"pointLights":[{"position":[0,0,1],"reach":1,"cone":)" + cone + "}]}");
    };
    EXPECT_THAT(refusalOfCone("{}"), testing::HasSubstr("pointLights[0].cone.axis"));
    EXPECT_THAT(refusalOfCone(R"({"axis":[0,0,-1],"outerDegrees":120})"),
                testing::HasSubstr("pointLights[0].cone.outerDegrees is 120"));
    EXPECT_THAT(refusalOfCone(R"({"axis":[0,0,-1],"innerDegrees":20,"outerDegrees":10})"),
                testing::HasSubstr("pointLights[0].cone.innerDegrees is 20"));
    EXPECT_THAT(refusalOfCone(R"({"axis":[0,0,-1],"innerDegrees":"NaN"})"),
                testing::HasSubstr("pointLights[0].cone.innerDegrees is nan"));
}

TEST(WireScene, ASpotComesBackAsItWasAndIs45DegreesWideWhereItSaysNothing) {
    fabric::Scene scene;
    scene.pointLights = {{{1, 2, 3}, {1, 0.5, 0}, 4, fabric::LightCone{{0, 3, -4}, 12.5, 60}},
                         {{3, 2, 1}, {1, 1, 1}, 4}};
    EXPECT_EQ(fromMessage(toMessage(scene)).value(), scene);
    const fabric::Scene plain =
        sceneFrom(R"({"pointLights":[{"position":[0,0,1],"reach":1,"cone":{"axis":[0,0,-1]}}]})")
            .value();
    EXPECT_EQ(plain.pointLights[0].cone, (fabric::LightCone{{0, 0, -1}, 0, 45}));
}

TEST(WireSceneInfo, ComesBackAsItWas) {
    const fabric::SceneInfo info{
        {{-1, -2, -3}, {4, 5, 6}}, 7, 8, {}, {{9, 0xfedcba9876543210}, {1, 2}}};
    EXPECT_EQ(fromMessage(toMessage(info)).value(), info);
    EXPECT_EQ(fromMessage(toMessage(fabric::SceneInfo{})).value(), fabric::SceneInfo{});
}

fabric::SceneInfo infoWithGround() {
    fabric::GroundGrid grid;
    grid.worldFromGrid[0] = {0, 30, 0, 0};
    grid.worldFromGrid[1] = {-30, 0, 0, 0};
    grid.worldFromGrid[3] = {5e5, 4e6, 1, 1};
    grid.columns = 3;
    grid.rows = 2;
    grid.highest = {1, 2, 3, 4, 5, 6};
    grid.lowest = {-1, -2, 3, -4, -5, -7};
    fabric::SceneInfo info{{{0, 0, 0}, {1, 1, 1}}, 1, 2};
    info.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(2, grid);
    return info;
}

TEST(WireSceneInfo, KeepsHowHighAndHowLowTheGroundIs) {
    const fabric::SceneInfo info = infoWithGround();
    EXPECT_EQ(fromMessage(toMessage(info)).value(), info);
    EXPECT_FALSE(fromMessage(toMessage(info)).value() == fabric::SceneInfo{});
}

TEST(WireSceneInfo, GroundThatCannotBeIsRefused) {
    const auto refusal = [](auto change) {
        v1::OpenSceneResponse message = toMessage(infoWithGround());
        change(*message.mutable_ground(1));
        return std::string(fromMessage(message).status().message());
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    using testing::HasSubstr;
    EXPECT_THAT(refusal([](auto& grid) { grid.set_columns(4); }),
                HasSubstr("ground.highest has 6"));
    EXPECT_THAT(refusal([](auto& grid) { grid.set_rows(-2), grid.set_columns(-3); }),
                HasSubstr("ground.highest has 6"));
    EXPECT_THAT(refusal([](auto& grid) { grid.set_highest(5, kNan); }),
                HasSubstr("ground.highest has a height that is not finite"));
    EXPECT_THAT(refusal([](auto& grid) { grid.set_lowest(0, -kNan); }),
                HasSubstr("ground.lowest has a height that is not finite"));
    EXPECT_THAT(refusal([](auto& grid) { grid.mutable_lowest()->RemoveLast(); }),
                HasSubstr("ground.lowest has 5"));
    EXPECT_THAT(
        refusal([](auto& grid) { grid.set_world_from_grid(0, 0), grid.set_world_from_grid(1, 0); }),
        HasSubstr("ground.world_from_grid is singular"));
    EXPECT_THAT(refusal([](auto& grid) { grid.mutable_world_from_grid()->RemoveLast(); }),
                HasSubstr("ground.world_from_grid has 15"));
}

TEST(WireSceneInfo, ABoxOutOfOrderIsRefused) {
    v1::OpenSceneResponse inverted = toMessage(fabric::SceneInfo{{{0, 0, 0}, {1, 1, 1}}, 0, 0});
    inverted.mutable_bounds()->mutable_min()->set_y(2);
    EXPECT_THAT(std::string(fromMessage(inverted).status().message()),
                testing::HasSubstr("along axis y"));
    inverted.mutable_bounds()->mutable_min()->set_y(-std::numeric_limits<double>::infinity());
    EXPECT_FALSE(fromMessage(inverted).ok());
}

}  // namespace
}  // namespace eyrie::wire
