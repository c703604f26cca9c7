// SPDX-License-Identifier: Apache-2.0
#include "fabric/lights.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

void expectNear(const Vec3& found, const Vec3& expected) {
    EXPECT_LT(glm::length(found - expected), 1e-12) << found.x << " " << found.y << " " << found.z;
}

TEST(TheSun, StandsWhereACompassSays) {
    expectNear(towardsSun({0, 0}), {0, 1, 0});
    expectNear(towardsSun({90, 0}), {1, 0, 0});
    expectNear(towardsSun({180, 45}), {0, -std::sqrt(0.5), std::sqrt(0.5)});
    expectNear(towardsSun({-90, 0}), {-1, 0, 0});
    expectNear(towardsSun({123, 90}), {0, 0, 1});
}

TEST(TheSun, MovesTheFirstDistantLightAndLeavesTheOthers) {
    Scene scene;
    scene.lights = {{{1, 0, 0}, {0.5, 0.6, 0.7}}, {{0, 1, 0}, {1, 0, 0}}};
    scene.pointLights = {{{1, 2, 3}, {1, 1, 1}, 4}};
    scene.ambient = 0.1;
    Look look;
    EXPECT_EQ(lightsOf(scene, {}, look).distant, scene.lights);
    look.sun = Sun{0, 90};
    const Lights lights = lightsOf(scene, {}, look);
    ASSERT_EQ(lights.distant.size(), 2U);
    expectNear(lights.distant[0].direction, {0, 0, -1});
    EXPECT_EQ(lights.distant[0].colour, Vec3(0.5, 0.6, 0.7));
    EXPECT_EQ(lights.distant[1], scene.lights[1]);
    EXPECT_EQ(lights.points, scene.pointLights);
    EXPECT_EQ(lights.ambient, 0.1);
}

TEST(TheSun, IsWhiteWhereTheSceneHasNoneAndNeverOneLightTooMany) {
    Look look;
    look.sun = Sun{90, 0};
    Scene scene;
    EXPECT_EQ(lightsOf(scene, {}, look).distant,
              (std::vector{DirectionalLight{-towardsSun(*look.sun), Vec3(1)}}));
    scene.pointLights.assign(kMaxLights, PointLight{});
    const Lights lights = lightsOf(scene, {}, look);
    EXPECT_EQ(lights.distant.size(), 1U);
    EXPECT_EQ(lights.points.size(), static_cast<std::size_t>(kMaxLights - 1));
}

const FileLights kOfFile{{{{0, 0, -1}, {1, 1, 1}}}, {{{1, 0, 0}, {0, 1, 0}, 2}}};

TEST(LightsOfFiles, ShineWhereTheSceneHasNone) {
    Scene scene;
    scene.ambient = 0.1;
    const Lights lights = lightsOf(scene, kOfFile, {});
    EXPECT_EQ(lights.distant, kOfFile.distant);
    EXPECT_EQ(lights.points, kOfFile.points);
    EXPECT_EQ(lights.ambient, 0.1);

    scene.pointLights = {{{1, 2, 3}, {1, 1, 1}, 4}};
    EXPECT_TRUE(lightsOf(scene, kOfFile, {}).distant.empty());
    EXPECT_EQ(lightsOf(scene, kOfFile, {}).points, scene.pointLights);
}

TEST(LightsOfFiles, HaveTheSunOfTheLook) {
    Look look;
    look.sun = Sun{0, 90};
    const Lights lights = lightsOf({}, kOfFile, look);
    ASSERT_EQ(lights.distant.size(), 1U);
    expectNear(lights.distant[0].direction, {0, 0, -1});
    EXPECT_EQ(lights.points, kOfFile.points);
}

TEST(LightsOfFiles, GoWithTheirObject) {
    FileLights lights;
    const Mat4 moved = glm::scale(
        glm::rotate(glm::translate(Mat4(1.0), Vec3(10, 20, 30)), glm::radians(90.0), Vec3(1, 0, 0)),
        Vec3(3));
    append(lights, kOfFile, moved);
    ASSERT_EQ(lights.count(), 2U);
    expectNear(lights.distant[0].direction, {0, 1, 0});
    expectNear(lights.points[0].positionMetres, {13, 20, 30});
    EXPECT_NEAR(lights.points[0].reachMetres, 6, 1e-12);
    EXPECT_EQ(lights.points[0].colour, Vec3(0, 1, 0));

    append(lights, kOfFile);
    EXPECT_EQ(lights.count(), 4U);
    EXPECT_EQ(lights.points[1], kOfFile.points[0]);
}

TEST(LightsOfFiles, ThatAreSpotsTurnWithTheirObjectAndKeepTheirAngles) {
    const FileLights spot{{}, {{{1, 0, 0}, Vec3(1), 2, LightCone{{0, 0, -1}, 10, 20}}}};
    FileLights lights;
    append(lights, spot,
           glm::scale(glm::rotate(Mat4(1.0), glm::radians(90.0), Vec3(1, 0, 0)), Vec3(3)));
    ASSERT_EQ(lights.points.size(), 1U);
    ASSERT_TRUE(lights.points[0].cone.has_value());
    expectNear(lights.points[0].cone->axis, {0, 1, 0});
    EXPECT_EQ(lights.points[0].cone->innerDegrees, 10);
    EXPECT_EQ(lights.points[0].cone->outerDegrees, 20);
}

TEST(LightsOfFiles, AreTheBrightestWhereThereAreTooMany) {
    FileLights lights;
    lights.distant = {{{0, 0, -1}, Vec3(0.01)}, {{0, 1, 0}, Vec3(0.5)}};
    for (int i = 0; i < 6; ++i) lights.points.push_back({Vec3(10.0 * i, 0, 0), Vec3(1), 10});
    keepBrightest(lights, Vec3(30, 0, 0));
    ASSERT_EQ(lights.distant.size(), 1U);
    EXPECT_EQ(lights.distant[0].colour, Vec3(0.5));
    ASSERT_EQ(lights.points.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(lights.points[i].positionMetres.x, 20 + 10.0 * static_cast<double>(i));
}

}  // namespace
}  // namespace eyrie::fabric
