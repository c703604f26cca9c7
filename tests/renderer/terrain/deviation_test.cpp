// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/renderer/terrain/grid_model.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/renderer/terrain/reference_surface.h"

namespace eyrie::terrain {
namespace {

using test::GridKind;
using test::Random;

/// The greatest distance to either diagonal's reading, on a lattice of 1 / density posts.
double sampledDeviation(const HeightGrid& grid, const Triangle& triangle, int density) {
    double worst = 0;
    test::forEachSample(triangle, density, [&](double x, double y, double drawn) {
        for (const double source : test::readings(grid, x, y))
            worst = std::max(worst, std::abs(drawn - source));
    });
    return worst;
}

/// The greatest distance at the posts themselves.
double deviationAtPosts(const HeightGrid& grid, const Triangle& triangle) {
    double worst = 0;
    test::forEachSample(triangle, 1, [&](double x, double y, double drawn) {
        worst = std::max(worst, std::abs(drawn - static_cast<double>(grid.at(
                                                     static_cast<int>(x), static_cast<int>(y)))));
    });
    return worst;
}

Triangle withHeights(const HeightGrid& grid, Triangle triangle, double offset, Random& random) {
    for (Corner& corner : triangle)
        corner.z =
            static_cast<double>(grid.at(corner.i, corner.j)) + offset * (random.unit() - 0.5);
    return triangle;
}

/// A right isosceles triangle inside the grid: legs along the axes, or the hypotenuse.
Triangle randomAligned(const HeightGrid& grid, Random& random, int largestLeg = 4) {
    for (;;) {
        const std::int32_t leg = 1 << random.integer(0, largestLeg);
        const std::int32_t i = random.integer(0, grid.columns - 1);
        const std::int32_t j = random.integer(0, grid.rows - 1);
        const std::int32_t dx = random.integer(0, 1) == 0 ? leg : -leg;
        const std::int32_t dy = random.integer(0, 1) == 0 ? leg : -leg;
        Triangle triangle;
        switch (random.integer(0, 2)) {
            case 0:
                triangle = {Corner{i, j, 0}, Corner{i + dx, j, 0}, Corner{i, j + dy, 0}};
                break;
            case 1:
                triangle = {Corner{i, j + dy, 0}, Corner{i - leg, j, 0}, Corner{i + leg, j, 0}};
                break;
            default:
                triangle = {Corner{i + dx, j, 0}, Corner{i, j - leg, 0}, Corner{i, j + leg, 0}};
        }
        const auto isIn = [&](const Corner& c) {
            return c.i >= 0 && c.j >= 0 && c.i < grid.columns && c.j < grid.rows;
        };
        if (isIn(triangle[0]) && isIn(triangle[1]) && isIn(triangle[2]))
            return triangle;
    }
}

Triangle randomGeneral(const HeightGrid& grid, Random& random) {
    for (;;) {
        Triangle t;
        for (Corner& corner : t)
            corner = {random.integer(0, grid.columns - 1), random.integer(0, grid.rows - 1), 0};
        if ((t[1].i - t[0].i) * (t[2].j - t[0].j) != (t[2].i - t[0].i) * (t[1].j - t[0].j))
            return t;
    }
}

/// All that an aligned triangle's deviation can peak at lies on the lattice of half posts.
TEST(Deviation, OfAlignedTrianglesIsWhatSamplingFindsToTheLastBit) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const auto kind = static_cast<GridKind>(round % test::kGridKinds);
        const HeightGrid grid = test::hardGrid(kind, 37, 34, random.next());
        test::GridModel model(grid);
        SourceSurface& surface = model.surface();
        const double offset = round % 3 == 0 ? 0 : 0.5;
        const Triangle place = randomAligned(grid, random);
        const Triangle triangle = withHeights(grid, place, offset, random);
        const bool liesOnPosts = deviationAtPosts(grid, withHeights(grid, place, 0, random)) <=
                                 surface.postToleranceMetres();
        const double expected =
            liesOnPosts ? deviationAtPosts(grid, triangle) : sampledDeviation(grid, triangle, 2);
        EXPECT_NEAR(surface.ofAligned(triangle), expected, 1e-9)
            << name(kind) << " round " << round;
    }
}

TEST(Deviation, OfGeneralTrianglesIsNeverBelowAndCloseToDenseSamples) {
    Random random(2);
    double largestShortfall = 0;
    for (int round = 0; round < 400; ++round) {
        const auto kind = static_cast<GridKind>(round % test::kGridKinds);
        const HeightGrid grid = test::hardGrid(kind, 19, 23, random.next());
        test::GridModel model(grid);
        SourceSurface& surface = model.surface();
        const Triangle triangle = withHeights(grid, randomGeneral(grid, random), 0.5, random);
        const double sampled = sampledDeviation(grid, triangle, 8);
        const double computed = surface.ofGeneral(triangle);
        EXPECT_GE(computed, sampled - 1e-9) << name(kind) << " round " << round;
        if (kind == GridKind::Smooth)
            largestShortfall = std::max(largestShortfall, computed - sampled);
    }
    // The lattice of 1/8 posts misses the peak by at most 1/8 post of the steepest slope, 34 m.
    EXPECT_LT(largestShortfall, 34.0 / 8);
}

/// Over the borders of the raster's tiles, where blocks are left out that cannot matter.
TEST(Deviation, OfWideTrianglesIsWhatSamplingFinds) {
    Random random(4);
    for (int round = 0; round < 60; ++round) {
        const auto kind = static_cast<GridKind>(round % test::kGridKinds);
        const HeightGrid grid = test::hardGrid(kind, 270, 263, random.next());
        test::GridModel model(grid);
        Triangle triangle;
        do {
            triangle = randomAligned(grid, random, 8);
        } while (std::abs(triangle[0].i - triangle[1].i) + std::abs(triangle[0].j - triangle[1].j) <
                 64);
        const Triangle drawn = withHeights(grid, triangle, 20, random);
        EXPECT_NEAR(model.surface().ofAligned(drawn), sampledDeviation(grid, drawn, 2), 1e-9)
            << name(kind) << " round " << round;
        const Triangle any = withHeights(grid, randomGeneral(grid, random), 20, random);
        EXPECT_GE(model.surface().ofGeneral(any), sampledDeviation(grid, any, 2) - 1e-9);
    }
}

TEST(Deviation, WithAGoalIsTheSameWhereItMatters) {
    Random random(5);
    const std::array<double, 7> steps{0.01, 1, 2, 4, 40, 80, 400};
    for (int round = 0; round < 600; ++round) {
        const auto kind = static_cast<GridKind>(round % test::kGridKinds);
        HeightGrid grid = test::hardGrid(kind, 270, 263, random.next());
        if (round % 4 == 0)
            grid.row(random.integer(0, 262))[random.integer(0, 269)] = kNodata;
        test::GridModel model(grid);
        SourceSurface& surface = model.surface();
        const bool isAligned = round % 2 == 0;
        const Triangle triangle = withHeights(
            grid, isAligned ? randomAligned(grid, random, 8) : randomGeneral(grid, random), 2,
            random);
        const auto measured = [&](const DeviationGoal& goal) {
            return isAligned ? surface.ofAligned(triangle, goal)
                             : surface.ofGeneral(triangle, goal);
        };
        const double whole = measured({});
        const double floor = whole * random.unit() * 2;
        EXPECT_EQ(measured({floor}), std::max(floor, whole)) << name(kind) << " round " << round;
        const auto stepsBelow = [&](double deviation) {
            return std::count_if(steps.begin(), steps.end(),
                                 [&](double step) { return deviation > step; });
        };
        const double first = steps[static_cast<std::size_t>(random.integer(0, 6))];
        EXPECT_EQ(stepsBelow(measured({first, steps})), stepsBelow(std::max(first, whole)))
            << name(kind) << " round " << round;
    }
}

/// VertexLevels leaves triangles out by this.
TEST(Deviation, OfATriangleIsNoMoreThanOfItsHalvesAndItsMiddlesMove) {
    Random random(12);
    for (int kind = 0; kind < test::kGridKinds; ++kind) {
        const HeightGrid grid = test::hardGrid(static_cast<GridKind>(kind), 129, 129, 5);
        test::GridModel model(grid);
        SourceSurface& surface = model.surface();
        const auto corner = [&](std::int32_t i, std::int32_t j) {
            return Corner{i, j, static_cast<double>(grid.at(i, j))};
        };
        for (int k = 0; k < 200; ++k) {
            Triangle t = withHeights(grid, randomAligned(grid, random, 6), 0, random);
            if ((t[1].i + t[2].i) % 2 != 0 || (t[1].j + t[2].j) % 2 != 0)
                continue;  // its middle is no post
            const Corner middle = corner((t[1].i + t[2].i) / 2, (t[1].j + t[2].j) / 2);
            const double moved = std::abs(middle.z - (t[1].z + t[2].z) / 2);
            const double halves = std::max(surface.inside({middle, t[0], t[1]}, 0).greatest,
                                           surface.inside({middle, t[2], t[0]}, 0).greatest);
            const auto whole = surface.inside(t, 0);
            EXPECT_LE(whole.greatest, (moved + halves) * (1 + 1e-12)) << kind << " " << k;
            EXPECT_EQ(whole.deviation, surface.ofAligned(t)) << kind << " " << k;
            EXPECT_LE(whole.deviation, whole.greatest) << kind << " " << k;
        }
    }
}

TEST(Deviation, OfAPlaneInWholeMetresIsExactlyZero) {
    HeightGrid grid = test::hardGrid(GridKind::Flat, 65, 65, 0);
    for (std::int32_t j = 0; j < grid.rows; ++j)
        for (std::int32_t i = 0; i < grid.columns; ++i)
            grid.row(j)[i] = static_cast<float>(-11034 + 7 * i - 3 * j);
    test::GridModel model(grid);
    SourceSurface& surface = model.surface();
    Random random(3);
    for (int round = 0; round < 200; ++round)
        EXPECT_EQ(surface.ofAligned(withHeights(grid, randomAligned(grid, random), 0, random)), 0);
}

TEST(Deviation, SeesARidgeThatTheHypotenuseMidpointMisses) {
    HeightGrid grid = test::hardGrid(GridKind::Flat, 17, 17, 0);
    grid.row(3)[5] = 100;
    test::GridModel model(grid);
    SourceSurface& surface = model.surface();
    EXPECT_EQ(surface.ofAligned({Corner{16, 0, 0}, Corner{0, 0, 0}, Corner{16, 16, 0}}), 100);
    EXPECT_EQ(surface.ofGeneral({Corner{0, 0, 0}, Corner{15, 1, 0}, Corner{7, 16, 0}}), 100);
}

TEST(Deviation, OfDataMixedWithNodataIsTheLongestEdge) {
    HeightGrid grid = test::hardGrid(GridKind::Flat, 17, 17, 0);
    grid.row(4)[2] = kNodata;
    test::GridModel model(grid);
    SourceSurface& surface = model.surface();
    const Triangle mixed = {Corner{0, 0, 0}, Corner{8, 0, 0}, Corner{0, 8, 0}};
    EXPECT_NEAR(surface.ofAligned(mixed), 80 * std::sqrt(2), 1e-9);
    EXPECT_NEAR(surface.ofGeneral(mixed), 80 * std::sqrt(2), 1e-9);
    const Triangle cornerMissing = {Corner{2, 4, kNodata}, Corner{6, 4, 0}, Corner{2, 8, 0}};
    EXPECT_NEAR(surface.ofAligned(cornerMissing), 40 * std::sqrt(2), 1e-9);
    EXPECT_EQ(surface.ofAligned({Corner{8, 8, 0}, Corner{16, 8, 0}, Corner{8, 16, 0}}), 0);
}

TEST(Deviation, OfNothingButNodataIsZero) {
    HeightGrid grid = test::hardGrid(GridKind::Noise, 9, 9, 0);
    std::fill(grid.heights.begin(), grid.heights.end(), kNodata);
    test::GridModel model(grid);
    SourceSurface& surface = model.surface();
    EXPECT_EQ(
        surface.ofAligned({Corner{0, 0, kNodata}, Corner{8, 0, kNodata}, Corner{0, 8, kNodata}}),
        0);
}

}  // namespace
}  // namespace eyrie::terrain
