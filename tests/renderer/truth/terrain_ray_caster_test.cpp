// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/terrain_ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/truth/triangle.h"

namespace eyrie::truth {
namespace {

using fabric::Vec2;
using fabric::Vec3;

constexpr auto kMain = static_cast<std::size_t>(CellSurface::MainDiagonal);
constexpr auto kOther = static_cast<std::size_t>(CellSurface::OtherDiagonal);
constexpr auto kBilinear = static_cast<std::size_t>(CellSurface::Bilinear);
constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();

/// Posts 30 m apart from (5e5, 5e6) to the east and south, as a UTM raster has them.
HeightGrid gridOf(int columns, int rows, const std::function<double(int, int)>& height) {
    HeightGrid grid{.columns = columns,
                    .rows = rows,
                    .heights = {},
                    .origin = {5e5, 5e6},
                    .perColumn = {30, 0},
                    .perRow = {0, -30}};
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) grid.heights.push_back(static_cast<float>(height(i, j)));
    return grid;
}

Vec3 world(double i, double j, double z) { return {5e5 + 30 * i, 5e6 - 30 * j, z}; }

Ray rayTo(const Vec3& eye, const Vec3& target) { return {eye, target - eye}; }

TEST(TerrainRayCaster, HitsAPlaneWhereItIs) {
    const TerrainRayCaster caster(gridOf(100, 60, [](int i, int j) { return 2.0 * i + 3.0 * j; }));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> column(0.01, 98.99), row(0.01, 58.99), high(400, 4000);
    for (int n = 0; n < 2000; ++n) {
        const double i = column(random), j = row(random);
        const Vec3 target = world(i, j, 2 * i + 3 * j);
        const Vec3 eye = world(column(random), row(random), high(random));
        for (const double hit : caster.firstHits(rayTo(eye, target))) EXPECT_NEAR(hit, 1, 1e-9);
    }
}

TEST(TerrainRayCaster, ReadsACellByEitherDiagonalOrBilinearly) {
    // One raised corner: at the middle the main diagonal is down, the other is halfway.
    const TerrainRayCaster caster(
        gridOf(2, 2, [](int i, int j) { return i == 1 && j == 0 ? 8.0 : 0.0; }));
    const auto hits = caster.firstHits({world(0.5, 0.5, 100), {0, 0, -1}});
    EXPECT_NEAR(hits[kMain], 100, 1e-9);
    EXPECT_NEAR(hits[kOther], 96, 1e-9);
    EXPECT_NEAR(hits[kBilinear], 98, 1e-9);
    const auto heights = caster.heightsAt(world(0.5, 0.5, 0).x, world(0.5, 0.5, 0).y);
    EXPECT_NEAR(heights[kMain], 0, 1e-9);
    EXPECT_NEAR(heights[kOther], 4, 1e-9);
    EXPECT_NEAR(heights[kBilinear], 2, 1e-9);
}

TEST(TerrainRayCaster, HitsTheNearSideOfAStepFirst) {
    const TerrainRayCaster caster(gridOf(64, 64, [](int i, int) { return i < 40 ? 0.0 : 500.0; }));
    // Level at 250 m, going east: the step rises from post 39 to post 40, halfway at 39.5.
    const auto hits = caster.firstHits(rayTo(world(3, 20.3, 250), world(4, 20.3, 250)));
    for (const double hit : hits) EXPECT_NEAR(hit, 36.5, 1e-9);
    // From the west and above, over the edge: lands on the plateau.
    for (const double hit : caster.firstHits(rayTo(world(3, 20.3, 900), world(50, 20.3, 500))))
        EXPECT_NEAR(hit, 1, 1e-9);
}

TEST(TerrainRayCaster, NeverSlipsThroughTheSeamsOfCells) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> height(0, 300);
    const TerrainRayCaster caster(gridOf(90, 90, [&](int, int) { return height(random); }));
    std::uniform_int_distribution<int> post(1, 88);
    std::uniform_real_distribution<double> coordinate(1, 88);
    for (int n = 0; n < 5000; ++n) {
        const int i = post(random), j = post(random);
        const Vec3 eye = world(coordinate(random), coordinate(random), 1000);
        // Exactly through posts, along grid lines and down onto them.
        for (const Ray& ray : {rayTo(eye, world(i, j, 0)), rayTo(world(i, 1, 900), world(i, 88, 0)),
                               Ray{world(i, j, 1000), {0, 0, -1}}})
            for (const double hit : caster.firstHits(ray)) {
                ASSERT_LE(hit, 1000);
                ASSERT_GT(hit, 0);
            }
    }
}

TEST(TerrainRayCaster, AgreesWithAMarchOverTheHeights) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> height(0, 400), coordinate(1, 62);
    const TerrainRayCaster caster(gridOf(64, 64, [&](int, int) { return height(random); }));
    for (int n = 0; n < 40; ++n) {
        const Ray ray = rayTo(world(coordinate(random), coordinate(random), 450),
                              world(coordinate(random), coordinate(random), -10));
        const auto hits = caster.firstHits(ray);
        std::array<double, kCellSurfaces> marched{kNoHit, kNoHit, kNoHit};
        constexpr int kSteps = 40000;
        for (int step = 0; step <= kSteps; ++step) {
            const Vec3 p = ray.at(step / double{kSteps});
            const auto heights = caster.heightsAt(p.x, p.y);
            for (std::size_t s = 0; s < kCellSurfaces; ++s)
                if (marched[s] == kNoHit && p.z <= heights[s])
                    marched[s] = step / double{kSteps};
        }
        for (std::size_t s = 0; s < kCellSurfaces; ++s) {
            EXPECT_LE(hits[s], marched[s] + 1e-9) << "seed 3, ray " << n;
            EXPECT_GE(hits[s], marched[s] - 1.0 / kSteps - 1e-9) << "seed 3, ray " << n;
        }
    }
}

/// Whatever diagonal each cell is cut along, cell by cell.
TEST(TerrainRayCaster, HitRangeHoldsEveryMixtureOfReadings) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> height(0, 100), coordinate(0, 8), share(0, 1);
    const HeightGrid grid = gridOf(9, 9, [&](int, int) { return height(random); });
    const TerrainRayCaster caster(grid);
    for (int n = 0; n < 60; ++n) {
        const Ray ray = rayTo(world(coordinate(random), coordinate(random), 150),
                              world(coordinate(random), coordinate(random), -10));
        const ReferenceSurface::HitRange range = caster.hitRange(ray);
        std::array<double, 81> mixture;
        for (double& s : mixture) s = share(random);
        double marched = kNoHit;
        constexpr int kSteps = 40000;
        for (int step = 0; step <= kSteps && marched == kNoHit; ++step) {
            const Vec3 p = ray.at(step / double{kSteps});
            const auto heights = caster.heightsAt(p.x, p.y);
            const Vec2 cell = (Vec2(p) - grid.origin) / Vec2(grid.perColumn.x, grid.perRow.y);
            const double s = mixture[static_cast<std::size_t>(std::floor(cell.x)) +
                                     9 * static_cast<std::size_t>(std::floor(cell.y))];
            if (p.z <= heights[kMain] * s + heights[kOther] * (1 - s))
                marched = step / double{kSteps};
        }
        EXPECT_GE(marched, range.first - 1e-9);
        EXPECT_LE(marched, range.last + 1.0 / kSteps + 1e-9);
    }
}

/// The triangles of cells that are each cut along the main diagonal or the other; none at holes.
std::vector<Triangle> cutCells(const HeightGrid& grid,
                               const std::function<bool(int, int)>& isMain) {
    const auto post = [&](int i, int j) {
        return world(i, j, grid.heights[static_cast<std::size_t>(j * grid.columns + i)]);
    };
    std::vector<Triangle> triangles;
    for (int j = 0; j + 1 < grid.rows; ++j)
        for (int i = 0; i + 1 < grid.columns; ++i) {
            const std::array<Vec3, 4> around{post(i, j), post(i + 1, j), post(i + 1, j + 1),
                                             post(i, j + 1)};
            const std::size_t from = isMain(i, j) ? 0 : 1;
            for (const std::size_t k : {from, from + 2}) {
                const Triangle triangle{around[k], around[(k + 1) % 4], around[(k + 2) % 4]};
                if (!std::isnan(triangle[0].z + triangle[1].z + triangle[2].z))
                    triangles.push_back(triangle);
            }
        }
    return triangles;
}

/// Also from below, where holes let rays through.
TEST(TerrainRayCaster, HitRangeHoldsEveryMixtureOfDiagonalsAboveAndBelowTheGround) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> height(0, 100), coordinate(0, 8), level(-60, 160);
    std::uniform_int_distribution<int> one(0, 4);
    const HeightGrid grid =
        gridOf(9, 9, [&](int, int) { return one(random) == 0 ? kNoData : height(random); });
    const TerrainRayCaster caster(grid);
    int between = 0;
    for (int n = 0; n < 4000; ++n) {
        const auto triangles = cutCells(grid, [&](int, int) { return one(random) < 2; });
        const Ray ray = rayTo(world(coordinate(random), coordinate(random), level(random)),
                              world(coordinate(random), coordinate(random), level(random)));
        const WatertightRay watertight(ray);
        double hit = kNoHit;
        for (const Triangle& triangle : triangles) hit = std::min(hit, watertight.hit(triangle));
        const ReferenceSurface::HitRange range = caster.hitRange(ray);
        ASSERT_GE(hit, range.first - 1e-9) << "seed 6, ray " << n;
        ASSERT_TRUE(hit == range.last || hit <= range.last + 1e-9) << "seed 6, ray " << n;
        between += hit > range.first && hit < range.last ? 1 : 0;
    }
    EXPECT_GT(between, 100) << "the mixtures are some";
}

TEST(TerrainRayCaster, LooksThroughHolesInTheData) {
    const TerrainRayCaster caster(
        gridOf(5, 5, [](int i, int j) { return i == 2 && j == 2 ? kNoData : 10.0; }));
    for (const double hit : caster.firstHits({world(2, 2, 100), {0, 0, -1}}))
        EXPECT_EQ(hit, kNoHit);
    for (const double hit : caster.firstHits({world(0.5, 0.5, 100), {0, 0, -1}}))
        EXPECT_NEAR(hit, 90, 1e-9);
    EXPECT_FALSE(caster.counterpart(world(2, 2, 0)));
}

TEST(TerrainRayCaster, EndsAtNodataAndAtItsRim) {
    HeightGrid grid{.columns = 41,
                    .rows = 31,
                    .heights = std::vector<float>(41 * 31, 7),
                    .origin = {100, 1000},
                    .perColumn = {10, 0},
                    .perRow = {0, -20}};
    grid.heights[15 * 41 + 20] = std::numeric_limits<float>::quiet_NaN();
    const TerrainRayCaster terrain(grid);
    const auto endsOf = [&](double x, double y, double reach) {
        std::vector<fabric::Vec3> ends;
        EXPECT_FALSE(terrain.endsWithin({x, y, 7}, reach, [&](const fabric::Vec3& end) {
            ends.push_back(end);
            return false;
        }));
        return ends;
    };
    EXPECT_EQ(endsOf(300, 700, 20).size(), 8U) << "around the gap, the middle one has no height";
    EXPECT_TRUE(endsOf(250, 700, 39).empty());
    EXPECT_EQ(endsOf(250, 700, 40).size(), 3U);
    EXPECT_EQ(endsOf(100, 600, 5).size(), 1U);
    EXPECT_EQ(endsOf(100, 600, 5)[0], fabric::Vec3(100, 600, 7));
    EXPECT_TRUE(endsOf(-1000, -1000, 50).empty()) << "far outside";
    EXPECT_TRUE(terrain.endsWithin({300, 700, 7}, 1e9, [](const auto&) { return true; }));
    // Every end once, wherever it lies: all around the rim, and around the gap.
    EXPECT_EQ(endsOf(300, 700, 1e9).size(), 2U * 41 + 2U * 29 + 8);
}

/// Of most blocks of posts none is an end, and these are not looked through.
TEST(TerrainRayCaster, EndsAreThoseOfEveryPost) {
    constexpr int kColumns = 203;
    constexpr int kRows = 97;
    HeightGrid grid{
        .columns = kColumns, .rows = kRows, .heights = std::vector<float>(kColumns * kRows, 7)};
    std::mt19937 random(5);
    for (int gaps = 0; gaps < 3; ++gaps)
        grid.heights[random() % grid.heights.size()] = std::numeric_limits<float>::quiet_NaN();
    const auto isGap = [&](int i, int j) {
        return i < 0 || j < 0 || i >= kColumns || j >= kRows ||
               std::isnan(grid.heights[static_cast<std::size_t>(j * kColumns + i)]);
    };
    std::set<std::pair<int, int>> expected;
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i)
            for (int k = 0; k < 9; ++k)
                if (!isGap(i, j) && isGap(i + k % 3 - 1, j + k / 3 - 1))
                    expected.emplace(i, j);
    std::set<std::pair<int, int>> found;
    TerrainRayCaster(grid).endsWithin({0, 0, 7}, 1e9, [&](const fabric::Vec3& end) {
        EXPECT_TRUE(found.emplace(std::lround(end.x), std::lround(-end.y)).second);
        return false;
    });
    EXPECT_EQ(found, expected);
}

TEST(TerrainRayCaster, EndsFarAwayAreFound) {
    HeightGrid grid{.columns = 3001, .rows = 5, .heights = std::vector<float>(3001 * 5, 7)};
    grid.heights[2 * 3001 + 2500] = std::numeric_limits<float>::quiet_NaN();
    const TerrainRayCaster terrain(grid);
    const auto isBesideTheGap = [](const fabric::Vec3& end) {
        return end.x == 2499 && end.y == -2;
    };
    EXPECT_TRUE(terrain.endsWithin({500, -2, 7}, 1999.5, isBesideTheGap));
    EXPECT_FALSE(terrain.endsWithin({500, -2, 7}, 1998.5, isBesideTheGap));
}

TEST(TerrainRayCaster, MissesBesideAndAboveThePosts) {
    const TerrainRayCaster caster(gridOf(20, 20, [](int, int) { return 10.0; }));
    for (const Ray& ray : {Ray{world(-0.01, 5, 100), {0, 0, -1}}, Ray{world(5, 5, 100), {0, 0, 1}},
                           Ray{world(5, 5, 100), {1, 0.3, 0}}})
        EXPECT_EQ(caster.hitRange(ray).first, kNoHit);
    EXPECT_FALSE(caster.counterpart(world(-0.01, 5, 0)));
}

TEST(TerrainRayCaster, TakesRotatedGridsAsTheyAre) {
    HeightGrid grid = gridOf(20, 20, [](int i, int) { return 10.0 * i; });
    grid.perColumn = {20, 20};
    grid.perRow = {20, -20};
    const Vec2 p = grid.origin + 7.25 * grid.perColumn + 3.5 * grid.perRow;
    const TerrainRayCaster caster(std::move(grid));
    EXPECT_NEAR(caster.hitRange({{p.x, p.y, 1000}, {0, 0, -1}}).first, 1000 - 72.5, 1e-8);
}

}  // namespace
}  // namespace eyrie::truth
