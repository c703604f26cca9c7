// SPDX-License-Identifier: Apache-2.0
#include "renderer/truth/depth_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/placed_surfaces.h"
#include "renderer/truth/shown_surface.h"
#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::truth {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// A ridge across the view, with ground before and behind it.
TerrainRayCaster ridge(double raisedMetres) {
    HeightGrid grid{.columns = 101,
                    .rows = 101,
                    .heights = {},
                    .origin = {0, 1000},
                    .perColumn = {10, 0},
                    .perRow = {0, -10}};
    for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i)
            grid.heights.push_back(
                static_cast<float>(raisedMetres + std::max(0, 150 - 10 * std::abs(j - 50))));
    return TerrainRayCaster(std::move(grid));
}

Pinhole southernView(int width = kWidth) {
    return Pinhole({.eye = {500, -300, 300}, .target = {500, 500, 50}, .fovYDegrees = 45}, width,
                   kHeight);
}

std::vector<float> depthOf(const ReferenceSurface& surface, const Pinhole& camera) {
    std::vector<float> depth;
    for (int y = 0; y < camera.height(); ++y)
        for (int x = 0; x < camera.width(); ++x)
            depth.push_back(
                static_cast<float>(surface.hitRange(camera.rayThrough(x + 0.5, y + 0.5)).first));
    return depth;
}

TEST(Percentile, IsTheNearestRank) {
    for (const std::size_t count : {1U, 2U, 50U, 99U, 100U}) {
        std::vector<double> values(count);
        std::iota(values.begin(), values.end(), 1);
        EXPECT_EQ(percentile(values, 99), std::ceil(0.99 * static_cast<double>(count)));
        EXPECT_EQ(percentile(values, 50), std::ceil(0.5 * static_cast<double>(count)));
    }
    std::vector<double> values(150);
    std::iota(values.rbegin(), values.rend(), 1);
    EXPECT_EQ(percentile(values, 99), 149);
}

TEST(CompareDepth, FindsNoFaultWithTheReferenceItself) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    const DepthComparison result = compareDepth(camera, depthOf(reference, camera), reference, 1);
    EXPECT_LT(result.maxPixels, 1e-4);
    EXPECT_GT(result.compared, 5000U);
    EXPECT_EQ(result.holes + result.falseHits + result.misplaced, 0U);
}

TEST(CompareDepth, MeasuresHowFarASurfaceMovedOnTheScreen) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    const DepthComparison result = compareDepth(camera, depthOf(ridge(2), camera), reference, 2);
    // 2 m at the nearest 300 m from the eye and f = 145 px, seen from somewhat above.
    const double nearestPixels = camera.focalPixels() * 2 / 300;
    EXPECT_LT(result.maxPixels, nearestPixels);
    EXPECT_GT(result.maxPixels, nearestPixels / 3);
    EXPECT_LE(result.p99Pixels, result.maxPixels);
    EXPECT_EQ(result.misplaced, 0U);
}

TEST(CompareDepth, OfTheFarthestOnlyTellsNoLessAndTheSameOfThose) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    const ReferenceView view = castView(camera, reference);
    const auto depth = depthOf(ridge(2), camera);
    std::vector<float> all, few;
    const DepthComparison exact = compareDepth(view, depth, 2, {}, LookAround::All, &all);
    const DepthComparison quick = compareDepth(view, depth, 2, {}, LookAround::Farthest, &few);
    EXPECT_EQ(quick.compared, exact.compared);
    EXPECT_GE(quick.p50Pixels, exact.p50Pixels);
    EXPECT_LT(quick.p50Pixels, exact.p50Pixels + 0.02);
    EXPECT_GE(quick.maxPixels, exact.maxPixels);
    EXPECT_LT(quick.maxPixels, exact.maxPixels + 0.02);
    ASSERT_EQ(all.size(), depth.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(std::isnan(all[i]), std::isinf(depth[i]));
        EXPECT_FALSE(few[i] < all[i]);
    }
    EXPECT_FLOAT_EQ(*std::max_element(few.begin(), few.end(),
                                      [](float a, float b) {
                                          return !std::isnan(b) && (std::isnan(a) || a < b);
                                      }),
                    static_cast<float>(quick.maxPixels));
}

TEST(CompareDepth, CountsHoles) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    auto depth = depthOf(reference, camera);
    for (const std::size_t pixel : {30U * kWidth + 80U, 31U * kWidth + 20U})
        depth[pixel] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(compareDepth(camera, depth, reference, 1).holes, 2U);
}

/// A gap in the data right behind the crest, which hides it: its outline moved is no mistake.
TEST(CompareDepth, AllowsForHolesThatAreHidden) {
    const Pinhole camera = southernView();
    HeightGrid grid = ridge(0).grid();
    for (const int j : {48, 49})
        for (int i = 48; i < 53; ++i)
            grid.heights[static_cast<std::size_t>(j * grid.columns + i)] =
                std::numeric_limits<float>::quiet_NaN();
    const TerrainRayCaster reference(grid);
    auto depth = depthOf(reference, camera);
    const auto crest = camera.project({500, 500, 148});
    ASSERT_TRUE(crest);
    const auto pixel = [&](int dx, int dy) {
        return static_cast<std::size_t>(crest->y + dy) * kWidth +
               static_cast<std::size_t>(crest->x + dx);
    };
    for (int dy = -3; dy <= 0; ++dy)
        ASSERT_TRUE(std::isfinite(depth[pixel(0, dy)])) << "nothing of the gap is seen";
    const auto holesWithout = [&](int dx, int dy) {
        auto drawn = depth;
        drawn[pixel(dx, dy)] = std::numeric_limits<float>::infinity();
        return compareDepth(camera, drawn, reference, 2).holes;
    };
    EXPECT_EQ(holesWithout(0, -2), 0U);
    EXPECT_EQ(holesWithout(0, -9), 1U) << "too far below";
    EXPECT_EQ(holesWithout(15, -6), 1U) << "too far beside";
    EXPECT_EQ(compareDepth(camera, depth, reference, 2).holes, 0U);
}

TEST(CompareDepth, LooksForWhatTheNearPlaneLeaves) {
    const auto plateAt = [](double y) {
        return TriangleMesh{{{-9, y, -9}, {9, y, -9}, {0, y, 9}}, {{0, 1, 2}}};
    };
    TriangleMesh plates = plateAt(0.0005);
    plates.positions.insert(plates.positions.end(), {{-9, 4, -9}, {9, 4, -9}, {0, 4, 9}});
    plates.triangles.push_back({3, 4, 5});
    const MeshRayCaster reference(plates);
    const Pinhole camera({.eye = {0, 0, 0}, .target = {0, 1, 0}, .fovYDegrees = 45}, kWidth,
                         kHeight);
    const auto behind = depthOf(MeshRayCaster(plateAt(4)), camera);
    EXPECT_EQ(compareDepth(camera, behind, reference, 1).misplaced, 0U);
    EXPECT_EQ(compareDepth(camera, behind, reference, 1).holes, 0U);
    const auto farther = depthOf(MeshRayCaster(plateAt(6)), camera);
    EXPECT_GT(compareDepth(camera, farther, reference, 1).misplaced, 1000U);
}

TEST(CompareDepth, CountsPixelsDrawnInTheSky) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    auto depth = depthOf(reference, camera);
    depth[(kHeight - 2) * kWidth + 80] = 1000;
    EXPECT_EQ(compareDepth(camera, depth, reference, 1).falseHits, 1U);
}

TEST(CompareDepth, SeesThatTheGroundBehindAMissingRidgeIsWrongAlthoughItIsReal) {
    const TerrainRayCaster reference = ridge(0);
    HeightGrid flat{.columns = 2,
                    .rows = 2,
                    .heights = {0, 0, 0, 0},
                    .origin = {0, 1000},
                    .perColumn = {1000, 0},
                    .perRow = {0, -1000}};
    const Pinhole camera = southernView();
    const DepthComparison result =
        compareDepth(camera, depthOf(TerrainRayCaster(flat), camera), reference, 1);
    EXPECT_GT(result.misplaced, 200U);
}

TEST(CompareDepth, JudgesMisplacedPixelsByTheDrawnPointWhereOneIsKnown) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    auto depth = depthOf(reference, camera);
    const std::size_t pixel = 30U * kWidth + 80U;
    const double right = depth[pixel];
    depth[pixel] = static_cast<float>(0.5 * right);  // a plane's depth beside its triangle
    const auto misplacedWhereIs = [&](double shownDepth, bool mayHaveDepth = true) {
        const Suspects suspects{.shown = [=, &camera](double x, double y, double) {
            return std::optional(
                DrawnPoint{camera.rayThrough(x, y).at(shownDepth), 0, mayHaveDepth});
        }};
        return compareDepth(camera, depth, reference, 1, suspects).misplaced;
    };
    EXPECT_EQ(compareDepth(camera, depth, reference, 1).misplaced, 1U);
    EXPECT_EQ(misplacedWhereIs(right), 0U);
    EXPECT_EQ(misplacedWhereIs(0.6 * right), 1U) << "what is drawn is there";
    EXPECT_EQ(misplacedWhereIs(right, false), 1U) << "it is not what has the depth";
}

/// The ridge's own triangles, as a drawing of it has them.
class DrawnRidge : public testing::Test {
protected:
    explicit DrawnRidge(int width = kWidth) : camera_(southernView(width)) {
        const HeightGrid& grid = reference_.grid();
        const auto corner = [&](int i, int j) {
            return fabric::Vec3(10 * i, 1000 - 10 * j,
                                grid.heights[static_cast<std::size_t>(j * grid.columns + i)]);
        };
        for (int j = 0; j + 1 < grid.rows; ++j)
            for (int i = 0; i + 1 < grid.columns; ++i) {
                triangles_.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
                triangles_.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
            }
        surface_.emplace(triangles_, camera_);
    }

    DepthComparison judged(const std::vector<float>& depth, double promised) const {
        const Suspects suspects{
            promised, [this](double x, double y, double metres) {
                const auto found = surface_->at(x, y, metres);
                return found ? std::optional(
                                   DrawnPoint{found->point, 0, found->mayHaveDepth, found->isAtEnd})
                             : std::nullopt;
            }};
        return compareDepth(castView(camera_, reference_), depth, static_cast<int>(promised) + 1,
                            suspects, LookAround::Farthest);
    }

    const TerrainRayCaster reference_ = ridge(0);
    const Pinhole camera_;
    std::vector<Triangle> triangles_;
    std::optional<ShownSurface> surface_;
};

TEST_F(DrawnRidge, KeepsWhatItPromises) {
    const DepthComparison found = judged(depthOf(reference_, camera_), 0.1);
    EXPECT_LT(found.maxPixels, 0.1);
    EXPECT_EQ(found.holes + found.falseHits + found.misplaced, 0U);
}

/// That its triangles are where the source is does not excuse what was made of them.
TEST_F(DrawnRidge, IsNotLetOffDepthsThatItsTrianglesCannotHave) {
    const std::vector<float> right = depthOf(reference_, camera_);
    for (const float scale : {0.98F, 1.005F, 1.02F}) {
        std::vector<float> depth = right;
        for (float& metres : depth) metres *= scale;
        const double byDepths = compareDepth(camera_, depth, reference_, 8).maxPixels;
        const DepthComparison found = judged(depth, 0.1);
        ASSERT_GT(byDepths, 0.3) << scale;
        EXPECT_NEAR(found.maxPixels, byDepths, 0.05) << scale;
        EXPECT_GT(found.suspects, found.compared / 2) << scale;
    }
}

TEST_F(DrawnRidge, IsNotLetOffWhatWasNotDrawnOfIt) {
    std::vector<float> depth = depthOf(reference_, camera_);
    for (std::size_t y = 30; y < 60; ++y)
        for (std::size_t x = 60; x < 100; ++x)
            depth[y * kWidth + x] = std::numeric_limits<float>::infinity();
    EXPECT_GT(judged(depth, 0.1).holes, 1000U);
}

TEST_F(DrawnRidge, IsNotLetOffWhatItHides) {
    const std::vector<float> right = depthOf(reference_, camera_);
    std::vector<float> depth = right;
    for (std::size_t y = 30; y < 60; ++y)
        for (std::size_t x = 60; x < 100; ++x) depth[y * kWidth + x] = 5000;
    EXPECT_GT(judged(depth, 0.1).misplaced, 1000U);
}

/// In its middle column pixels' centres lie on sides of triangles.
class DrawnRidgeWithSides : public DrawnRidge {
protected:
    DrawnRidgeWithSides() : DrawnRidge(kWidth + 1) {}
};

TEST_F(DrawnRidgeWithSides, IsNotLetOffCracksBetweenItsTriangles) {
    const std::vector<float> right = depthOf(reference_, camera_);
    const DepthComparison whole = judged(right, 0.1);
    EXPECT_EQ(whole.holes + whole.misplaced, 0U);
    for (const float seen : {std::numeric_limits<float>::infinity(), 5000.0F}) {
        std::vector<float> depth = right;
        for (std::size_t y = 30; y < 60; ++y) depth[y * (kWidth + 1) + kWidth / 2] = seen;
        const DepthComparison found = judged(depth, 0.1);
        EXPECT_EQ(found.holes + found.misplaced, 30U) << seen;
    }
}

/// Over a terrain's nodata there is nothing to hold its triangles against, but their outline.
TEST(CompareDepth, HoldsADrawnPointAgainstItsOwnSource) {
    const auto ground = std::make_shared<TerrainRayCaster>(ridge(0));
    const auto elsewhere = std::make_shared<MeshRayCaster>(
        TriangleMesh{{{500, 900, 400}, {510, 900, 400}, {500, 910, 400}}, {{0, 1, 2}}});
    const PlacedSurfaces reference({{ground, fabric::Mat4(1)}, {elsewhere, fabric::Mat4(1)}});
    const Pinhole camera = southernView();
    auto depth = depthOf(reference, camera);
    const fabric::Vec3 overhang(500, 1010, 100);  // beyond the posts
    const auto at = camera.project(overhang);
    ASSERT_TRUE(at);
    depth[static_cast<std::size_t>(at->y) * kWidth + static_cast<std::size_t>(at->x)] =
        static_cast<float>(camera.depth(overhang));
    const auto maxFrom = [&](std::size_t source) {
        const Suspects suspects{.abovePixels = 1, .shown = [&](double, double, double) {
                                    return std::optional(DrawnPoint{overhang, source, true});
                                }};
        return compareDepth(camera, depth, reference, 1, suspects).maxPixels;
    };
    EXPECT_LT(maxFrom(0), 1);
    EXPECT_GT(maxFrom(1), 20);
}

/// What is drawn over nodata, as far as outlines are promised, is not of the other terrain that
/// lies there far below.
TEST(CompareDepth, HoldsWhatIsBesideAnEndAgainstNoOtherSource) {
    const auto above = std::make_shared<TerrainRayCaster>(ridge(0));
    const auto below = std::make_shared<TerrainRayCaster>(
        HeightGrid{2, 2, {-500, -500, -500, -500}, {-5000, 6000}, {11000, 0}, {0, -11000}});
    const PlacedSurfaces reference({{above, fabric::Mat4(1)}, {below, fabric::Mat4(1)}});
    const Pinhole camera = southernView();
    const auto maxOf = [&](const fabric::Vec3& drawn) {
        auto depth = depthOf(reference, camera);
        const auto at = camera.project(drawn);
        EXPECT_TRUE(at);
        depth[static_cast<std::size_t>(at->y) * kWidth + static_cast<std::size_t>(at->x)] =
            static_cast<float>(camera.depth(drawn));
        return compareDepth(camera, depth, reference, 3, {.abovePixels = 2, .shown = {}}).maxPixels;
    };
    const double endMetres = 1000;
    EXPECT_LT(maxOf({500, endMetres + 10, 0}), 2);
    EXPECT_GT(maxOf({500, endMetres + 400, 0}), 20) << "nothing ends there";
    EXPECT_GT(maxOf({500, endMetres + 10, -400}), 2) << "far below what ends";
}

TEST(CompareDepth, LooksThroughSlitsBesideWhatIsDrawnOnly) {
    const TerrainRayCaster reference = ridge(0);
    const Pinhole camera = southernView();
    auto depth = depthOf(reference, camera);
    const std::size_t pixel = 30U * kWidth + 80U;
    const double right = depth[pixel];
    const auto misplacedAt = [&](double seen, double drawn, bool isAtEnd = true) {
        depth[pixel] = static_cast<float>(seen);
        // Of what is drawn here, it names what is nearest to the depth it is asked for.
        const Suspects suspects{.shown = [&](double x, double y, double asked) {
            const double nearest = std::abs(asked - seen) < std::abs(asked - drawn) ? seen : drawn;
            return std::optional(
                DrawnPoint{camera.rayThrough(x, y).at(nearest), 0, nearest == asked, isAtEnd});
        }};
        return compareDepth(camera, depth, reference, 1, suspects).misplaced;
    };
    EXPECT_EQ(misplacedAt(2 * right, right), 0U);
    EXPECT_EQ(misplacedAt(2 * right, right, false), 1U) << "it covers the pixel";
    EXPECT_EQ(misplacedAt(2 * right, 0.5 * right), 1U) << "there is nothing beside it";
    EXPECT_EQ(misplacedAt(0.5 * right, right), 1U) << "it hides what is there";
}

/// Seen from the origin to the north: a wall 20 m away; before it, 10 m away, one of a left half
/// and of two right quarters that share no corner with it, which meet just right of the centres of
/// column 100; and 5 m away a wire, thinner than anything, just right of those of column 60.
MeshRayCaster wallsAndWire(double focalPixels) {
    const auto across = [&](double column, double metres) {
        return (column - kWidth / 2.0) / focalPixels * metres;
    };
    TriangleMesh mesh;
    const auto add = [&](double left, double right, double low, double high, double metres) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const fabric::Vec3& corner :
             {fabric::Vec3(left, metres, low), fabric::Vec3(right, metres, low),
              fabric::Vec3(right, metres, high), fabric::Vec3(left, metres, high)})
            mesh.positions.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    };
    const double seam = across(100.5 + 1.0 / 512, 10);
    const double wire = across(60.5 + 1.0 / 300, 5);
    add(-30, 30, -30, 30, 20);
    add(-20, seam, -20, 20, 10);
    add(seam, 20, -20, 0.1, 10);
    add(seam, 20, 0.1, 20, 10);
    add(wire, wire + 1e-6, -9, 9, 5);
    return MeshRayCaster(std::move(mesh));
}

TEST(CompareDepth, KnowsWhatIsSeenThroughSeamsAndOfWiresBetweenRays) {
    const Pinhole camera({.eye = {0, 0, 0}, .target = {0, 1, 0}, .fovYDegrees = 45}, kWidth,
                         kHeight);
    const MeshRayCaster reference = wallsAndWire(camera.focalPixels());
    const std::vector<float> depth = depthOf(reference, camera);
    const auto faultsWith = [&](int x, int y, float metres) {
        std::vector<float> changed = depth;
        changed[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] = metres;
        const DepthComparison result = compareDepth(camera, changed, reference, 1);
        return result.holes + result.falseHits + result.misplaced;
    };
    EXPECT_EQ(faultsWith(100, 40, 10), 0U);
    EXPECT_EQ(faultsWith(100, 40, 20), 0U) << "through the seam";
    EXPECT_EQ(faultsWith(100, 40, std::numeric_limits<float>::infinity()), 1U);
    EXPECT_EQ(faultsWith(98, 40, 20), 1U) << "there is none";
    EXPECT_EQ(faultsWith(60, 40, 5), 0U) << "the wire";
    EXPECT_EQ(faultsWith(58, 40, 5), 1U) << "beside it";
    EXPECT_EQ(faultsWith(60, 40, 6), 1U) << "behind it";
    // The halves of a wall share their diagonal: no seam.
    const double seam = (100.5 + 1.0 / 512 - kWidth / 2.0) / camera.focalPixels() * 10;
    const Ray onDiagonal{{0, 0, 0}, {-20 + 0.25 * (seam + 20), 10, -10}};
    EXPECT_NEAR(reference.throughSeams(onDiagonal, 1e-4).last, 1, 1e-12);
    const Ray onSeam{{0, 0, 0}, {seam - 1e-5, 10, -10}};
    EXPECT_NEAR(reference.throughSeams(onSeam, 1e-4).last, 2, 1e-12);
    EXPECT_NEAR(reference.hitRange(onSeam).last, 1, 1e-12);
}

}  // namespace
}  // namespace eyrie::truth
