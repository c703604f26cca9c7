// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/home_camera.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace eyrie::stream {
namespace {

TEST(HomeCamera, SeesEveryCornerOfTheSceneInA4By3Picture) {
    const fabric::Box boxes[] = {{{0, 0, 0}, {1, 1, 1}},
                                 {{-5000, -3000, 200}, {5000, 3000, 1400}},
                                 {{4e6, 5e6, 0}, {4e6 + 10, 5e6 + 1000, 1}},
                                 {{7, 7, 7}, {7, 7, 7}},
                                 {{0, 0, -1000}, {1, 1, 1000}}};
    for (const fabric::Box& box : boxes) {
        const fabric::Camera camera = homeCamera(box);
        ASSERT_TRUE(fabric::validate(camera).ok()) << fabric::validate(camera);
        EXPECT_LT(camera.eye.x, box.centre().x);  // from the west
        EXPECT_LT(camera.eye.y, box.centre().y);  // and south
        EXPECT_GT(camera.eye.z, box.centre().z);
        const double tan = std::tan(glm::radians(camera.fovYDegrees / 2));
        for (int i = 0; i < 8; ++i) {
            const fabric::Vec3 p =
                fabric::viewFromWorldRotation(camera) * (box.corner(i) - camera.eye);
            EXPECT_LE(std::abs(p.y), -p.z * tan);
            EXPECT_LE(std::abs(p.x), -p.z * tan * 4 / 3);
        }
    }
}

TEST(HomeCamera, LeavesAsMuchFreeAboveAsBelowAndLeftAsRight) {
    const fabric::Box boxes[] = {{{0, 0, 0}, {1, 1, 1}},
                                 {{-5000, -3000, 200}, {5000, 3000, 1400}},
                                 {{576000, 5094000, 260}, {654000, 5207000, 4370}},
                                 {{0, 0, -1000}, {1, 1, 1000}}};
    for (const fabric::Box& box : boxes) {
        const fabric::Camera camera = homeCamera(box);
        fabric::Vec2 low(1e9);
        fabric::Vec2 high(-1e9);
        for (int i = 0; i < 8; ++i) {
            const fabric::Vec3 p =
                fabric::viewFromWorldRotation(camera) * (box.corner(i) - camera.eye);
            low = glm::min(low, fabric::Vec2(p) / -p.z);
            high = glm::max(high, fabric::Vec2(p) / -p.z);
        }
        EXPECT_NEAR(low.x, -high.x, 1e-6);
        EXPECT_NEAR(low.y, -high.y, 1e-6);
    }
}

TEST(HomeCamera, ShowsSmallThingsLargeAlsoFarFromTheOrigin) {
    const fabric::Vec3 places[] = {{0, 0, 0}, {6.4e6, -3e6, 1e6}};
    for (const fabric::Vec3& place : places)
        for (const double side : {1e3, 1.0, 0.3, place.x == 0 ? 2e-6 : 0.05}) {
            const fabric::Box box{place, place + fabric::Vec3(side)};
            const fabric::Camera camera = homeCamera(box);
            ASSERT_TRUE(fabric::validate(camera).ok()) << fabric::validate(camera);
            double highest = 0;
            for (int i = 0; i < 8; ++i) {
                const fabric::Vec3 p =
                    fabric::viewFromWorldRotation(camera) * (box.corner(i) - camera.eye);
                highest = std::max(highest, std::abs(p.y / p.z));
            }
            const double rim = std::tan(glm::radians(camera.fovYDegrees / 2));
            EXPECT_GT(highest, 0.8 * rim) << side << " m at " << place.x;
            EXPECT_LT(highest, rim);
        }
}

TEST(HomeCamera, IsOfTerrainAsItIsExaggerated) {
    fabric::SceneInfo scene;
    const fabric::Box terrain{{0, 0, 100}, {3000, 2000, 700}};
    const fabric::Box mesh{{-10, 0, 0}, {0, 10, 5}};
    for (const fabric::Box& box : {mesh, terrain}) {
        scene.objects.push_back({box, 1});
        scene.bounds.grow(box);
    }
    EXPECT_EQ(exaggeratedBounds(scene, 20), scene.bounds) << "nothing is known of a ground";
    fabric::GroundGrid grid;
    grid.worldFromGrid[0] *= 30;
    grid.worldFromGrid[1] *= 30;
    grid.worldFromGrid[3].z = 50;  // where the object's height 0 lies
    grid.object = 1;
    scene.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, grid);
    EXPECT_EQ(exaggeratedBounds(scene, 1), scene.bounds);
    const fabric::Box high = exaggeratedBounds(scene, 20);
    EXPECT_EQ(high.min.z, 0) << "the mesh's";
    EXPECT_NEAR(high.max.z, 50 + 20 * 650, 1e-6);
    EXPECT_NEAR(high.min.x, -10, 1e-9);
    EXPECT_NEAR(high.max.y, 2000, 1e-9);
    EXPECT_NEAR(exaggeratedBounds(scene, -1).min.z, 50 - 650, 1e-6);
}

}  // namespace
}  // namespace eyrie::stream
