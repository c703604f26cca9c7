// SPDX-License-Identifier: Apache-2.0
#include "fabric/lights.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
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
    EXPECT_EQ(lightsOf(scene, look).distant, scene.lights);
    look.sun = Sun{0, 90};
    const Lights lights = lightsOf(scene, look);
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
    EXPECT_EQ(lightsOf(scene, look).distant,
              (std::vector{DirectionalLight{-towardsSun(*look.sun), Vec3(1)}}));
    scene.pointLights.assign(kMaxLights, PointLight{});
    const Lights lights = lightsOf(scene, look);
    EXPECT_EQ(lights.distant.size(), 1U);
    EXPECT_EQ(lights.points.size(), static_cast<std::size_t>(kMaxLights - 1));
}

}  // namespace
}  // namespace eyrie::fabric
