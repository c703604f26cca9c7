// SPDX-License-Identifier: Apache-2.0
// What a line of sight meets of the finest data, held against double-precision rays at the source:
// the truth's own, which share no code with it.
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/import/terrain_import.h"
#include "tests/integration/pick_pair.h"
#include "tests/renderer/lod/wall.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::Vec2;
using fabric::Vec3;
using import::TriangleMesh;
using test::camerasOver;
using test::GridKind;
using test::meshPair;
using test::NamedCamera;
using test::PickPair;
using test::PickTally;
using test::placesAround;
using test::terrainPair;

TEST(HardCase22, PicksOfTerrainAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(22);
    int picked = 0;
    for (const GridKind kind : {GridKind::Smooth, GridKind::Noise, GridKind::Cliff,
                                GridKind::Spikes, GridKind::Checkerboard, GridKind::Plane}) {
        const terrain::HeightGrid grid = test::hardGrid(kind, 161, 150, 5);
        const PickPair pair = terrainPair(folder, grid);
        const fabric::Vec2 middle = grid.origin + grid.perColumn * 80.3 + grid.perRow * 70.6;
        const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(80, 70)));
        for (const auto& [name, camera] : camerasOver(ground)) {
            PickTally tally;
            for (const Vec2& place : placesAround(camera, ground, 600, 420, engine))
                pair.hold(camera, place, tally);
            fmt::print("{} at {}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n",
                       test::name(kind), name, tally.picked, tally.missed, tally.slipped,
                       tally.mayBeMissed, tally.medianSpread());
            EXPECT_EQ(tally.slipped, 0) << test::name(kind) << " at " << name;
            picked += tally.picked;
        }
    }
    EXPECT_GT(picked, 5000);
}

TEST(HardCase22, PicksOfMeshesAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(23);
    const fabric::Mat4 moved = glm::scale(
        glm::rotate(glm::translate(fabric::Mat4(1), Vec3(5e5, -4.4e6, 120)), 0.7, Vec3(1, 2, 3)),
        Vec3(300));
    const PickPair pair =
        meshPair(folder, import::synthesizeMesh(6000, 3), moved, {.leafTriangles = 500});
    const Vec3 centre(moved[3]);
    const auto on = pair.pick({centre + Vec3(0, -2000, 0), centre},
                              {PickPair::kWidth / 2.0, PickPair::kHeight / 2.0});
    ASSERT_TRUE(on.ok() && on->has_value());
    int picked = 0;
    for (const auto& [name, camera] : camerasOver((*on)->worldMetres)) {
        PickTally tally;
        for (const Vec2& place : placesAround(camera, centre, 400, 2500, engine))
            pair.hold(camera, place, tally);
        fmt::print("mesh at {}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n", name,
                   tally.picked, tally.missed, tally.slipped, tally.mayBeMissed,
                   tally.medianSpread());
        EXPECT_EQ(tally.slipped, 0) << name;
        picked += tally.picked;
    }
    EXPECT_GT(picked, 3000);
}

/// Single triangles in a ball: a ray that misses one meets nothing beside it.
TriangleMesh confetti(std::uint32_t triangles, std::mt19937& engine) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto point = [&] { return Vec3(unit(engine), unit(engine), unit(engine)); };
    TriangleMesh mesh;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const Vec3 middle = point();
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + 0.06 * point());
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

/// What rounding moves is a good part of what triangles are wide. Where outlines are within the
/// error of the ray, it may meet what it does not in the source, and the other way round.
TEST(HardCase22, PicksOfRoughlyRoundedMeshesAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(26);
    const NamedCamera cameras[] = {{"beside", {{0, -4, 0.5}, {0, 0, 0}}},
                                   {"inside", {{0.1, 0.2, 0.1}, {1, 1, 0}, {0, 0, 1}, 120}}};
    for (const bool isClosed : {true, false}) {
        const PickPair pair =
            meshPair(folder, isClosed ? import::synthesizeMesh(6000, 5) : confetti(1500, engine),
                     fabric::Mat4(1), {.leafTriangles = 500, .pack = {.latticeBits = 10}});
        PickTally tally;
        for (const auto& [name, camera] : cameras)
            for (const Vec2& place : placesAround(camera, {0, 0, 0}, 1.1, 900, engine))
                pair.hold(camera, place, tally);
        fmt::print("{}: {} picked, {} missed, {} slipped, {} uncertain, {:.3g} px\n",
                   isClosed ? "ball" : "confetti", tally.picked, tally.missed, tally.slipped,
                   tally.mayBeMissed, tally.medianSpread());
        EXPECT_GT(tally.picked, 300);
        EXPECT_LT(tally.slipped, 60);
        EXPECT_LT(tally.mayBeMissed, tally.picked / 2);
    }
}

void holdElevation(const fabric::PickedPoint& point, float height) {
    EXPECT_LE(std::abs(*point.elevationMetres - static_cast<double>(height)),
              point.elevationErrorMetres);
    EXPECT_LT(point.elevationErrorMetres, 0.2);
    EXPECT_NEAR(*point.elevationMetres, height, 0.01);
}

TEST(HardCase22, PicksOfExaggeratedTerrainAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(24);
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 90, 90, 5);
    const fabric::Vec2 middle = grid.origin + grid.perColumn * 45.0 + grid.perRow * 45.0;
    for (const double exaggeration : {-1.0, 0.0, 1e-3, 0.125, 4.0}) {
        const PickPair pair = terrainPair(folder, grid, exaggeration);
        const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(45, 45)) * exaggeration);
        PickTally tally;
        for (const auto& [name, camera] : camerasOver(ground))
            for (const Vec2& place : placesAround(camera, ground, 300, 100, engine))
                pair.hold(camera, place, tally);
        EXPECT_EQ(tally.slipped, 0);
        EXPECT_GT(tally.picked, 150);
        const auto level = pair.pick({ground + Vec3(0, 0, 1e6), ground, {0, 1, 0}}, {640, 360});
        ASSERT_TRUE(level.ok() && level->has_value());
        holdElevation(**level, grid.at(45, 45));
    }
}

TEST(HardCase22, PicksOfScaledTerrainTellItsOwnElevation) {
    const test::TemporaryFolder folder;
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 90, 90, 5);
    const std::string path = folder.path("terrain.eyt");
    ASSERT_TRUE(import::importTerrain(grid, {"grid", "", 0}, path, {}).ok());
    const fabric::Vec2 at = grid.origin + grid.perColumn * 45.0 + grid.perRow * 45.0;
    for (const double scale : {0.001, 50.0}) {
        const auto picker =
            test::openPicker({.name = "scaled",
                              .kind = fabric::ObjectKind::Terrain,
                              .path = path,
                              .worldFromObject = glm::scale(fabric::Mat4(1), Vec3(1, 1, scale))});
        const auto picked =
            picker->pick({{{at.x, at.y, 90'000}, {at.x, at.y, 0}, {0, 1, 0}}, 100, 100, {50, 50}});
        ASSERT_TRUE(picked.ok() && picked->has_value()) << scale;
        holdElevation(**picked, grid.at(45, 45));
    }
}

/// Walls that stand aslant, seen by an eye beside the camera.
TEST(HardCase22, PicksThroughObliqueWallsAreWhereRaysMeetTheSource) {
    const test::TemporaryFolder folder;
    test::Dice dice(27);
    const PickPair mesh =
        meshPair(folder, import::synthesizeMesh(6000, 3), fabric::Mat4(1), {.leafTriangles = 500});
    const terrain::HeightGrid grid = test::hardGrid(GridKind::Smooth, 161, 150, 5);
    const PickPair terrain = terrainPair(folder, grid);
    const fabric::Vec2 middle = grid.origin + grid.perColumn * 80.3 + grid.perRow * 70.6;
    const Vec3 ground(middle.x, middle.y, static_cast<double>(grid.at(80, 70)));
    PickTally ofMesh;
    PickTally ofTerrain;
    for (int i = 0; i < 300; ++i) {
        const test::Wall wall = test::randomWall(dice);
        const Vec3 eye = test::randomEye(dice);
        for (int k = 0; k < 8; ++k) {
            const Vec2 place(dice.in(0, PickPair::kWidth), dice.in(0, PickPair::kHeight));
            mesh.holdThrough(wall, eye, {dice.direction() * 2.5, {0, 0, 0}}, place, ofMesh);
            const Camera over{ground + Vec3(dice.in(-400, 400), dice.in(-400, 400), 500), ground};
            terrain.holdThrough(wall, eye, over, place, ofTerrain);
        }
    }
    for (const PickTally& tally : {ofMesh, ofTerrain}) {
        fmt::print("through walls: {} picked, {} missed, {} slipped, {} uncertain\n", tally.picked,
                   tally.missed, tally.slipped, tally.mayBeMissed);
        EXPECT_EQ(tally.slipped, 0);
        EXPECT_GT(tally.picked, 400);
    }
}

TEST(HardCase22, PicksOfMeshesThatKeepTheirPositionsAreExact) {
    const test::TemporaryFolder folder;
    std::mt19937 engine(25);
    const PickPair pair = meshPair(folder, import::synthesizeMesh(4000, 3), fabric::Mat4(1),
                                   {.leafTriangles = 500, .pack = {.keepsExact = true}});
    const Camera camera{{0, -3, 0}, {0, 0, 0}};
    PickTally tally;
    for (const Vec2& place : placesAround(camera, {0, 0, 0}, 1, 500, engine)) {
        pair.hold(camera, place, tally);
        const auto picked = pair.pick(camera, place);
        ASSERT_TRUE(picked.ok());
        if (picked->has_value()) {
            EXPECT_LT((*picked)->errorMetres, 1e-13);
        }
    }
    EXPECT_EQ(tally.slipped, 0);
    EXPECT_GT(tally.picked, 200);
}

TEST(HardCase22, PicksOfMeshesThatKeepTheirPositionsTellWhatReadingRounded) {
    constexpr double kRounding = 0.01;
    const test::TemporaryFolder folder;
    TriangleMesh ball = import::synthesizeMesh(4000, 3);
    ball.roundingMetres = kRounding;
    const PickPair pair = meshPair(folder, std::move(ball), fabric::Mat4(1),
                                   {.leafTriangles = 500, .pack = {.keepsExact = true}});
    const auto picked =
        pair.pick({{0, -3, 0}, {0, 0, 0}}, {PickPair::kWidth / 2.0, PickPair::kHeight / 2.0});
    ASSERT_TRUE(picked.ok() && picked->has_value()) << picked.status();
    EXPECT_NEAR((*picked)->errorMetres, kRounding, 1e-6);
    EXPECT_GE((*picked)->errorMetres, kRounding);
}

}  // namespace
}  // namespace eyrie
