// SPDX-License-Identifier: Apache-2.0
#include "fabric/ground.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "fabric/look.h"

namespace eyrie::fabric {
namespace {

constexpr double kCellMetres = 100;

/// Random heights from -200 to 800 m, cells of 100 m, its corner at (1000, 2000, 30).
GroundGrid anyGrid(std::mt19937& random) {
    GroundGrid grid;
    grid.columns = std::uniform_int_distribution(1, 9)(random);
    grid.rows = std::uniform_int_distribution(1, 9)(random);
    std::uniform_real_distribution<float> height(-200, 800);
    for (int i = 0; i < grid.columns * grid.rows; ++i) {
        const auto [low, high] = std::minmax({height(random), height(random)});
        grid.highest.push_back(high);
        grid.lowest.push_back(low);
    }
    grid.worldFromGrid = glm::scale(glm::translate(Mat4(1.0), Vec3(1000, 2000, 30)),
                                    Vec3(kCellMetres, -kCellMetres, 1));
    return grid;
}

double in(std::mt19937& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

/// A camera in and around the grid, above ground or below.
Camera anyCamera(std::mt19937& random, const GroundGrid& grid) {
    const auto point = [&] {
        return Vec3(grid.worldFromGrid * Vec4(in(random, -2, grid.columns + 2.0),
                                              in(random, -2, grid.rows + 2.0),
                                              in(random, -500, 1500), 1));
    };
    return {.eye = point(), .target = point()};
}

/// Of the cell, drawn times `scale`.
double topAt(const GroundGrid& grid, double u, double v, double scale) {
    const int x = static_cast<int>(std::floor(u));
    const int y = static_cast<int>(std::floor(v));
    const auto cell = static_cast<std::size_t>(y * grid.columns + x);
    return std::max(scale * grid.highest[cell], scale * grid.lowest[cell]);
}

double anyScale(std::mt19937& random) { return in(random, -3, 3); }

RC_GTEST_PROP(GroundCeiling, IsNeverBelowTheCellNorBelowItsNeighboursOnTheirBorder, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const GroundGrid grid = anyGrid(random);
    const double u = in(random, 0, grid.columns - 1e-9);
    const double v = in(random, 0, grid.rows - 1e-9);
    for (const double scale : {1.0, -1.0, anyScale(random)}) {
        RC_ASSERT(ceilingAt(grid, u, v, scale) >= topAt(grid, u, v, scale));
        RC_ASSERT(ceilingAt(grid, std::floor(u) + 0.5, std::floor(v) + 0.5, scale) ==
                  topAt(grid, u, v, scale));
        if (u >= 1)
            RC_ASSERT(ceilingAt(grid, std::floor(u), v, scale) >=
                      topAt(grid, std::floor(u) - 1, v, scale));
    }
}

RC_GTEST_PROP(GroundCeiling, DoesNotJumpAnywhere, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const GroundGrid grid = anyGrid(random);
    // All of the relief within a quarter of a cell, along both axes; beyond, within one.
    const double scale = anyScale(random);
    const double steepest = 8 * (1000 * std::abs(scale) + kCellMetres);
    const double u = in(random, -2, grid.columns + 2.0);
    const double v = in(random, -2, grid.rows + 2.0);
    const double du = in(random, -0.01, 0.01);
    const double dv = in(random, -0.01, 0.01);
    RC_ASSERT(std::abs(ceilingAt(grid, u + du, v + dv, scale) - ceilingAt(grid, u, v, scale)) <=
              steepest * std::hypot(du, dv) + 1e-9);
}

RC_GTEST_PROP(GroundCeiling, FallsBeyondTheGridHoweverFlatOrUpsideDownItIsDrawn, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const GroundGrid grid = anyGrid(random);
    const double v = in(random, 0, grid.rows);
    const double cells = in(random, 0, 1000);
    for (const double scale : {1.0, 0.5, 1e-3, 1e-9, 0.0, -1e-9, -1e-3, -1.0, anyScale(random)})
        for (const double edge : {0.0, static_cast<double>(grid.columns)})
            RC_ASSERT(ceilingAt(grid, edge + (edge == 0 ? -cells : cells), v, scale) <=
                      ceilingAt(grid, edge, v, scale) - cells * kCellMetres + 1e-6);
}

/// The ground's height above its own zero, exaggerated, and the eye's; written out for a grid that
/// is only moved and scaled.
double heightAboveCeiling(const GroundGrid& grid, const Vec3& eye, double exaggeration) {
    const double u = (eye.x - 1000) / kCellMetres;
    const double v = (eye.y - 2000) / -kCellMetres;
    return eye.z - 30 - ceilingAt(grid, u, v, exaggeration == 0 ? 1e-9 : exaggeration);
}

RC_GTEST_PROP(AboveGround, KeepsItsClearanceAndLeavesAloneWhatHasIt, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const GroundGrid grid = anyGrid(random);
    const double exaggeration =
        *rc::gen::element(1.0, 0.0, -0.0, 1e-3, 10.0, 100.0, -1e-3, -1.0, -3.0);
    const Camera camera = anyCamera(random, grid);
    const Camera lifted = aboveGround(camera, {grid}, {.exaggeration = exaggeration});
    RC_ASSERT(heightAboveCeiling(grid, lifted.eye, exaggeration) >= kGroundClearanceMetres - 2e-6);
    if (heightAboveCeiling(grid, camera.eye, exaggeration) >= kGroundClearanceMetres)
        RC_ASSERT(lifted == camera);
    RC_ASSERT(lifted.eye.x == camera.eye.x && lifted.eye.y == camera.eye.y);
    RC_ASSERT(lifted.target == camera.target);
    RC_ASSERT(aboveGround(lifted, {grid}, {.exaggeration = exaggeration}) == lifted);
}

RC_GTEST_PROP(AboveGround, ACameraLedIntoTheGroundSlidesAlongIt, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const GroundGrid grid = anyGrid(random);
    const Camera from = anyCamera(random, grid);
    const Camera to = anyCamera(random, grid);
    constexpr int kSteps = 2000;
    const double step = glm::length(to.eye - from.eye) / kSteps;
    Vec3 last = aboveGround(from, {grid}, {}).eye;
    for (int i = 1; i <= kSteps; ++i) {
        const Vec3 eye =
            aboveGround({.eye = glm::mix(from.eye, to.eye, static_cast<double>(i) / kSteps),
                         .target = to.target + Vec3(1e4, 0, 0)},
                        {grid}, {})
                .eye;
        RC_ASSERT(glm::length(eye - last) <=
                  step * (1 + 8 * (1000 + kCellMetres) / kCellMetres) + 1e-5);
        last = eye;
    }
}

RC_GTEST_PROP(AboveGround, HoldsUnderAnyTransformOfTheTerrain, ()) {
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    GroundGrid grid = anyGrid(random);
    const Mat4 worldFromObject =
        glm::scale(glm::rotate(glm::translate(Mat4(1.0), Vec3(3e5, -4e6, 70)), in(random, 0, 6),
                               Vec3(in(random, -1, 1), in(random, -1, 1), 1)),
                   Vec3(in(random, 0.1, 5)));
    grid.worldFromGrid = worldFromObject * grid.worldFromGrid;
    const Camera camera = anyCamera(random, grid);
    const Camera lifted = aboveGround(camera, {grid}, {});
    const Vec3 place = Vec3(glm::inverse(grid.worldFromGrid) * Vec4(lifted.eye, 1));
    const double above =
        (place.z - ceilingAt(grid, place.x, place.y)) * glm::length(Vec3(grid.worldFromGrid[2]));
    RC_ASSERT(above >= kGroundClearanceMetres - 1e-4);
}

TEST(AboveGround, LeavesAloneAnEyeFarBesideTheTerrainAtAnyExaggeration) {
    GroundGrid grid;
    grid.columns = grid.rows = 16;
    grid.highest.assign(256, 700);
    grid.lowest.assign(256, 350);
    grid.worldFromGrid =
        glm::scale(glm::translate(Mat4(1.0), Vec3(500000, 5200000, 0)), Vec3(960, 960, 1));
    const Camera camera{.eye = {650000, 5350000, -5000}, .target = {507000, 5207000, 0}};
    for (const double exaggeration : {2.0, 1.0, 0.5, 0.001, 0.0, -0.001, -1.0, -2.0})
        EXPECT_EQ(aboveGround(camera, {grid}, {.exaggeration = exaggeration}), camera)
            << exaggeration;
}

TEST(AboveGround, UpsideDownTheEyeIsHeldByTheCellsAroundItAlone) {
    GroundGrid grid;
    grid.columns = 3;
    grid.rows = 1;
    grid.highest = {900, 900, 900};
    grid.lowest = {-400, 100, 300};
    const Camera camera{.eye = {2.5, 0.5, -1000}, .target = {0, 0.5, 0}};
    EXPECT_DOUBLE_EQ(aboveGround(camera, {grid}, {.exaggeration = -1}).eye.z, -298);
    EXPECT_DOUBLE_EQ(aboveGround(camera, {grid}, {.exaggeration = -2}).eye.z, -598);
}

TEST(AboveGround, DoesNotHinderWhereTheTerrainIsHidden) {
    GroundGrid grid;
    grid.columns = grid.rows = 1;
    grid.highest = {100};
    grid.lowest = {0};
    grid.object = 3;
    const Camera camera{.eye = {0.5, 0.5, -50}, .target = {8, 0.5, 0}};
    EXPECT_EQ(aboveGround(camera, {grid}, {.hidden = {{2}}}).eye.z, 102);
    EXPECT_EQ(aboveGround(camera, {grid}, {.hidden = {{2, 3}}}), camera);
}

TEST(AboveGround, LiftsTheTargetTooWhereItWouldBeLookedAtFromItself) {
    GroundGrid grid;
    grid.columns = grid.rows = 1;
    grid.highest = {100};
    grid.lowest = {0};
    const Camera camera{.eye = {0.5, 0.5, -50}, .target = {0.5, 0.5, 102}, .up = {0, 1, 0}};
    const Camera lifted = aboveGround(camera, {grid}, {});
    EXPECT_EQ(lifted.eye.z, 102);
    EXPECT_EQ(lifted.target.z, 254);
    EXPECT_TRUE(validate(lifted).ok());
}

TEST(Exaggerated, ByOneChangesNoBitAndByNothingStaysInvertible) {
    const Mat4 any = glm::rotate(glm::translate(Mat4(1.0), Vec3(1e5, 2, 3)), 0.3, Vec3(1, 2, 3));
    EXPECT_EQ(exaggerated(any, 1), any);
    EXPECT_GT(glm::determinant(Mat3(exaggerated(any, 0))), 0);
    EXPECT_EQ(exaggerated(any, -0.0), exaggerated(any, 0));
    EXPECT_LT(glm::determinant(Mat3(exaggerated(any, -1))), 0);
    EXPECT_EQ(exaggerated(any, 100)[2], any[2] * 100.0);
}

}  // namespace
}  // namespace eyrie::fabric
