// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/placed_surfaces.h"

#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::truth {
namespace {

using fabric::Mat4;
using fabric::Vec3;

/// Two triangles in the plane z = 0, from -1 to 1.
std::shared_ptr<const MeshRayCaster> square() {
    return std::make_shared<MeshRayCaster>(
        TriangleMesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
}

/// Level ground at 5 m, 100 m by 100 m from the origin.
std::shared_ptr<const TerrainRayCaster> plain() {
    return std::make_shared<TerrainRayCaster>(HeightGrid{.columns = 2,
                                                         .rows = 2,
                                                         .heights = {5, 5, 5, 5},
                                                         .origin = {0, 0},
                                                         .perColumn = {100, 0},
                                                         .perRow = {0, 100}});
}

TEST(PlacedSurfaces, TheNearestIsHitAtTheRaysOwnParameter) {
    const auto shape = square();
    const PlacedSurfaces scene(
        {{shape, glm::translate(Mat4(1), Vec3(0, 0, 3))}, {shape, glm::scale(Mat4(1), Vec3(4))}});
    EXPECT_DOUBLE_EQ(scene.hitRange({{0.5, 0.5, 10}, {0, 0, -1}}).first, 7);
    EXPECT_DOUBLE_EQ(scene.hitRange({{3, 3, 10}, {0, 0, -2}}).first, 5) << "beside the upper one";
    EXPECT_EQ(scene.hitRange({{5, 5, 10}, {0, 0, -1}}).first, kNoHit);
}

TEST(PlacedSurfaces, APointIsHeldAgainstWhatItIsNearestTo) {
    const auto shape = square();
    const PlacedSurfaces scene({{shape, glm::translate(Mat4(1), Vec3(0, 0, 3))}, {shape, Mat4(1)}});
    EXPECT_EQ(*scene.counterpart({0.5, 0, 2}), Vec3(0.5, 0, 3));
    EXPECT_EQ(*scene.counterpart({0.5, 0, 1}), Vec3(0.5, 0, 0));
}

TEST(PlacedSurfaces, EndsAreFoundWhereTheyStand) {
    const Mat4 placed = glm::scale(glm::translate(Mat4(1), Vec3(1000, 0, 2)), Vec3(2, 2, 1));
    const PlacedSurfaces scene({{square(), Mat4(1)}, {plain(), placed}});
    const auto isAt = [](const Vec3& wanted) {
        return [wanted](const Vec3& end) { return glm::distance(end, wanted) < 1e-9; };
    };
    EXPECT_TRUE(scene.endsWithin({1190, 190, 7}, 20, isAt({1200, 200, 7})));
    EXPECT_FALSE(scene.endsWithin({1190, 190, 7}, 20, isAt({1000, 0, 7}))) << "beyond reach";
    EXPECT_FALSE(scene.endsWithin({500, 0, 0}, 20, [](const auto&) { return true; }));
    EXPECT_TRUE(scene.endsWithin({0, 0, 0}, 20, isAt({1, 1, 0})));
}

/// Seen from the side, a metre up is as many pixels for a scene as for its parts.
TEST(PlacedSurfaces, DisplacementsAreThoseOnTheScreenOfTheWorld) {
    const Pinhole camera({.eye = {50, -100, 5}, .target = {50, 50, 5}, .fovYDegrees = 45}, 160,
                         120);
    const Vec3 point(50, 50, 6);
    const double pixels = camera.focalPixels() * 1 / 150;
    const PlacedSurfaces scene({{plain(), Mat4(1)}});
    EXPECT_NEAR(scene.displacement(camera, point).pixels, pixels, 1e-9);
    EXPECT_TRUE(scene.displacement(camera, point).isInColumn);
    // Half as high and twice as wide, and lifted to where it was.
    const Mat4 placed = glm::scale(glm::translate(Mat4(1), Vec3(-10, -10, 2.5)), Vec3(2, 2, 0.5));
    const PlacedSurfaces moved({{plain(), placed}});
    EXPECT_NEAR(moved.displacement(camera, point).pixels, pixels, 1e-9);
    EXPECT_TRUE(moved.displacement(camera, point).isInColumn);
    EXPECT_FALSE(moved.displacement(camera, point).isBelow);
    const PlacedSurfaces both(
        {{plain(), placed}, {square(), glm::translate(Mat4(1), Vec3(50, 50, 5.75))}});
    EXPECT_NEAR(both.displacement(camera, point).pixels, pixels / 4, 1e-9);
    EXPECT_TRUE(std::isnan(moved.displacement(camera, {5000, 0, 0}).pixels)) << "beside the plain";
    EXPECT_NEAR(both.displacement(camera, {50, 300, 5.75}).pixels,
                PlacedSurfaces({{square(), glm::translate(Mat4(1), Vec3(50, 50, 5.75))}})
                    .displacement(camera, {50, 300, 5.75})
                    .pixels,
                1e-9)
        << "only one of them has a counterpart";
    EXPECT_NEAR(both.displacementFrom(0, camera, point).pixels, pixels, 1e-9);
    EXPECT_NEAR(both.displacementFrom(1, camera, point).pixels, pixels / 4, 1e-9);
    EXPECT_TRUE(std::isnan(both.displacementFrom(0, camera, {5000, 0, 0}).pixels));
}

}  // namespace
}  // namespace eyrie::truth
