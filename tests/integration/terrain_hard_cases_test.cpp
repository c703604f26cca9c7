// SPDX-License-Identifier: Apache-2.0
// What breaks terrain engines, by name: pictures of grids and from cameras that are small and
// nasty, each held against a double-precision ray cast of its posts. docs/errors.md lists where the
// other hard cases are tested.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/truth/terrain_promise.h"
#include "tests/renderer/terrain/hard_grids.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::Vec3;
using terrain::HeightGrid;
using test::GridKind;
using truth::TerrainPromise;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

/// A grid of whole-metre heights, 16 m apart from (0, 0): every number has an exact float.
HeightGrid gridOf(std::int32_t columns, std::int32_t rows,
                  const std::function<double(std::int32_t, std::int32_t)>& height) {
    HeightGrid grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.origin = {0, 0};
    grid.perColumn = {16, 0};
    grid.perRow = {0, 16};
    for (std::int32_t j = 0; j < rows; ++j)
        for (std::int32_t i = 0; i < columns; ++i)
            grid.heights.push_back(static_cast<float>(std::round(height(i, j))));
    return grid;
}

double hills(std::int32_t i, std::int32_t j) {
    return 900 + 500 * std::sin(i * 0.05) * std::cos(j * 0.037) + 40 * std::sin(i * 0.9 + j * 0.7);
}

/// A terrain on the renderer and its judge.
class Scene {
public:
    explicit Scene(HeightGrid grid) : grid_(std::move(grid)) {
        const std::string path = folder_.path("terrain.eyt");
        const auto report = import::importTerrain(grid_, {"grid", "", 0}, path, {});
        EXPECT_TRUE(report.ok()) << report.status();
        renderer_ = test::makeRenderer();
        fabric::Scene scene;
        scene.objects.push_back({"terrain", fabric::ObjectKind::Terrain, path});
        EXPECT_TRUE(renderer_->openScene(scene).ok());
        ground_ = std::make_unique<truth::TerrainRayCaster>(truth::HeightGrid{
            grid_.columns, grid_.rows, grid_.heights, grid_.origin, grid_.perColumn, grid_.perRow});
        file_ = *terrain::EytFile::open(path);
    }

    const HeightGrid& grid() const { return grid_; }
    const terrain::EytIndex& index() const { return file_->index(); }

    /// The forms of vertices that the terrain's tiles have.
    std::set<int> wordsPerVertex() const {
        const terrain::Quadtree& quadtree = index().quadtree;
        std::set<int> forms;
        for (std::uint32_t number = 0; number < quadtree.tileCount(); ++number) {
            const terrain::TileId id = quadtree.tileOf(number);
            if (index().tile(id).triangles == 0)
                continue;
            const auto page = file_->readPage(quadtree.pageIndex(id));
            EXPECT_TRUE(page.ok()) << page.status();
            if (page.ok())
                forms.insert((*page)->tile(terrain::Quadtree::placeInPage(id)).wordsPerVertex);
        }
        return forms;
    }

    /// World position of a place on the grid, `above` metres over the post before it.
    Vec3 at(double i, double j, double above) const {
        const fabric::Vec2 xy = grid_.origin + grid_.perColumn * i + grid_.perRow * j;
        return {xy.x, xy.y,
                static_cast<double>(
                    grid_.at(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j))) +
                    above};
    }

    fabric::ChannelResult draw(const Camera& camera, double tauPixels) {
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.wantsDepth = true;
        auto result = renderer_->render({.camera = camera, .tauPixels = tauPixels}, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? *std::move(result) : fabric::ChannelResult{};
    }

    /// Draws a picture and fails unless it is what it promises to be.
    truth::PromiseKept hold(const std::string& name, const Camera& camera, double tauPixels = 1) {
        const auto kept =
            TerrainPromise(*renderer_, *ground_, file_).hold(camera, tauPixels, kWidth, kHeight);
        EXPECT_TRUE(kept.ok()) << name << ": " << kept.status();
        if (!kept.ok())
            return {};
        EXPECT_TRUE(kept->statistics.complete) << name;
        EXPECT_FALSE(std::isnan(kept->promisedPixels)) << name;
        EXPECT_LE(kept->measuredPixels, kept->promisedPixels + TerrainPromise::kRasterPixels)
            << name << " at " << kept->measured.worstX << ", " << kept->measured.worstY;
        EXPECT_EQ(kept->measured.holes, 0U) << name;
        EXPECT_EQ(kept->measured.falseHits, 0U) << name;
        EXPECT_EQ(kept->measured.misplaced, 0U) << name;
        return *kept;
    }

private:
    test::TemporaryFolder folder_;
    HeightGrid grid_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<truth::TerrainRayCaster> ground_;
    std::shared_ptr<const terrain::EytFile> file_;
};

/// From four sides, from far and near, steep and flat.
std::vector<Camera> camerasAround(const fabric::Box& bounds) {
    std::vector<Camera> cameras;
    const double extent = glm::length(bounds.size());
    for (int k = 0; k < 4; ++k) {
        Camera camera;
        camera.target = bounds.centre();
        const double azimuth = 0.4 + 1.6 * k;
        const double elevation = 0.25 + 0.35 * k;
        camera.eye =
            camera.target + extent * (k % 2 == 0 ? 0.9 : 0.45) *
                                Vec3(std::cos(azimuth) * std::cos(elevation),
                                     std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
        camera.eye.z = std::max(camera.eye.z, bounds.max.z + 50);
        cameras.push_back(camera);
    }
    return cameras;
}

void holdAround(HeightGrid grid, const std::string& name) {
    Scene scene(std::move(grid));
    int number = 0;
    std::size_t compared = 0;
    for (const Camera& camera : camerasAround(scene.index().bounds()))
        compared +=
            scene.hold(fmt::format("{} camera {}", name, number++), camera).measured.compared;
    EXPECT_GT(compared, 2000U) << name << ": the cameras should see the terrain";
}

/// Hard case 1. Floats that large are 4096 m apart; lattice points minus the camera's are exact.
TEST(HardCase1, PicturesAreTheSameBits2To31PostsFromTheOrigin) {
    const HeightGrid near = gridOf(300, 300, hills);
    HeightGrid far = near;
    const fabric::Vec2 offset(16.0 * (std::int64_t{1} << 31), -16.0 * (std::int64_t{1} << 31));
    far.origin += offset;
    Scene nearScene(near);
    Scene farScene(far);
    for (int k = 0; k < 20; ++k) {
        Camera camera;
        camera.eye = nearScene.at(60 + 9 * k, 40 + 11 * k, 64 + 16 * k);
        camera.target = camera.eye + Vec3(64 - 8 * k, 32, -32);
        Camera moved = camera;
        moved.eye += Vec3(offset, 0);
        moved.target += Vec3(offset, 0);
        EXPECT_EQ(nearScene.draw(camera, 1).image, farScene.draw(moved, 1).image) << k;
    }
}

/// Hard case 1. Where origin and camera lie between the lattice's points, pictures are what rays
/// at the posts say, as elsewhere.
TEST(HardCase1, FarFromTheOriginPicturesDoNotDrift) {
    HeightGrid grid = gridOf(200, 200, hills);
    grid.origin = {6378137.3, -6356752.7};
    holdAround(std::move(grid), "far");
}

/// Hard case 2, beside TerrainCracks' thousand steep views: level along borders of tiles, where
/// columns of the picture are vertical planes and nothing below terrain may be open.
TEST(HardCase2, NoHoleOpensBelowTheHorizonAlongBorders) {
    Scene scene(gridOf(513, 513, hills));
    for (int k = 0; k < 150; ++k) {
        const int side = 32 << k % 3;
        const int border = side * (1 + k % (512 / side - 1));
        const double along = 20 + (k * 37) % 470;
        Camera camera;
        camera.eye = k % 2 == 0 ? scene.at(border, along, 0) : scene.at(along, border, 0);
        camera.eye.z += 5 * std::exp2(k % 7);
        camera.target = camera.eye + Vec3(std::cos(k * 0.7), std::sin(k * 0.7), 0);
        const double tau = std::exp2(k % 5 - 1);
        fabric::Image whole = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
        if (const auto drawn = scene.draw(camera, tau); !drawn.image.area.isEmpty())
            fabric::paste(drawn.image, whole);
        int holes = 0;
        for (std::size_t x = 0; x < kWidth; ++x) {
            bool isBelow = false;
            for (std::size_t y = kHeight; y-- > 0;) {
                const bool isCovered = whole.depth[y * kWidth + x] > 0;
                holes += isBelow && !isCovered ? 1 : 0;
                isBelow = isBelow || isCovered;
            }
        }
        EXPECT_EQ(holes, 0) << "view " << k;
    }
}

/// Hard case 4: a step of 4000 m between two posts, columns of 0 and 4000 m in turn, single posts.
TEST(HardCase4, CliffsCombsAndSpikesKeepThePromise) {
    for (const GridKind kind : {GridKind::Cliff, GridKind::Comb, GridKind::Spikes})
        holdAround(test::hardGrid(kind, 200, 170, 7), test::name(kind));
}

/// Hard case 5. A plane needs four triangles a tile (corners and centre), and every depth is that
/// of the plane, to what is left of a float after the vertex transform: less than 0.001 pixels on
/// llvmpipe, 0.0014 on an H100.
TEST(HardCase5, PlanesHaveFourTrianglesATileAndNoNoise) {
    for (const GridKind kind : {GridKind::Flat, GridKind::Plane}) {
        Scene scene(test::hardGrid(kind, 257, 257, 1));
        for (const terrain::TileRecord& tile : scene.index().tiles) EXPECT_EQ(tile.triangles, 4U);
        for (const Camera& camera : camerasAround(scene.index().bounds())) {
            const truth::PromiseKept kept = scene.hold(test::name(kind), camera);
            EXPECT_LE(kept.measured.maxPixels, kept.promisedPixels + 0.001);
            EXPECT_LE(kept.promisedPixels, kind == GridKind::Flat ? 0 : 0.1);
        }
    }
}

/// Hard case 6: +-20 m in turn, which no midpoint sees.
TEST(HardCase6, ACheckerboardKeepsThePromise) {
    holdAround(test::hardGrid(GridKind::Checkerboard, 150, 140, 7), "checkerboard");
}

/// Hard case 7: vertices of one word up to a relief of 4095 steps, of two from there on; both forms
/// side by side, from the deepest sea to the highest mountain.
TEST(HardCase7, TilesOfShortAndLongVerticesMeet) {
    for (const int base : {-11034, 0, 8849 - 4097})
        for (const int relief : {4095, 4096, 4097})
            holdAround(gridOf(65, 65,
                              [&](std::int32_t i, std::int32_t j) {
                                  const int top = i < 40 ? relief - 2 : relief;
                                  return base + ((i + 3 * j) % 7 == 0 ? top : (i * j) % 5);
                              }),
                       fmt::format("base {} relief {}", base, relief));
}

/// Hard case 7, in one grid: the deepest sea, a slope of 20 km in two kilometres, and the highest
/// mountain, of vertices of both forms.
TEST(HardCase7, OneGridFromTheDeepestSeaToTheHighestMountainKeepsThePromise) {
    const HeightGrid grid = gridOf(300, 200, [](std::int32_t i, std::int32_t j) {
        constexpr double kDeepest = -11034;
        constexpr double kHighest = 8849;
        const double share = std::clamp((i + j / 9 - 80) / 128.0, 0.0, 1.0);
        const int rough = (i * i + 3 * j) % 7;
        return std::clamp(kDeepest + share * (kHighest - kDeepest) + (share < 1 ? rough : -rough),
                          kDeepest, kHighest);
    });
    const auto [lowest, highest] = std::ranges::minmax(grid.heights);
    EXPECT_EQ(lowest, -11034);
    EXPECT_EQ(highest, 8849);
    Scene scene(grid);
    EXPECT_THAT(scene.wordsPerVertex(), testing::ElementsAre(1, 2));
    int number = 0;
    for (const Camera& camera : camerasAround(scene.index().bounds()))
        for (const double tau : {0.25, 4.0})
            scene.hold(fmt::format("sea to mountain, camera {}", number++ / 2), camera, tau);
}

/// Hard case 8: holes of one post, a row on a border, a corner of four tiles, a whole page.
TEST(HardCase8, NodataIsOpenAndNothingElseIs) {
    HeightGrid grid = gridOf(300, 300, hills);
    const auto cut = [&](std::int32_t i0, std::int32_t j0, std::int32_t i1, std::int32_t j1) {
        for (std::int32_t j = j0; j <= j1; ++j)
            for (std::int32_t i = i0; i <= i1; ++i)
                grid.row(j)[i] = std::numeric_limits<float>::quiet_NaN();
    };
    cut(77, 45, 77, 45);
    cut(130, 96, 290, 96);
    cut(64, 64, 64, 64);
    cut(129, 129, 256, 256);
    Scene scene(std::move(grid));
    for (const Camera& camera : camerasAround(scene.index().bounds()))
        scene.hold("nodata", camera, 0.25);
}

/// A plain and a void, or a step of 400 m beside it: outlines alone can be off.
TEST(HardCase8, OutlinesAreSeenToMoveAndKeepThePromise) {
    double outlines = 0;
    for (const double step : {0, 400}) {
        HeightGrid grid = gridOf(
            300, 300, [&](std::int32_t i, std::int32_t) { return i > 145 ? 100 + step : 100; });
        for (std::int32_t j = 0; j < 300; ++j)
            for (std::int32_t i = 123 + j / 9; i < 137 + j / 9; ++i)
                grid.row(j)[i] = std::numeric_limits<float>::quiet_NaN();
        Scene scene(std::move(grid));
        for (const Camera& camera : camerasAround(scene.index().bounds())) {
            const truth::PromiseKept kept = scene.hold("outlines", camera, 4);
            outlines = std::max(outlines, kept.measuredPixels - kept.surfacePixels);
        }
    }
    EXPECT_GT(outlines, 0.1) << "the judge does not look at outlines";
}

/// Hard case 9: grids as small, as thin and as awkward as they come; posts that are no squares.
TEST(HardCase9, GridsOfOddSizesAndShapesKeepThePromise) {
    for (const auto& [columns, rows] :
         {std::pair{2, 2}, {3, 3}, {128, 3}, {129, 128}, {130, 129}, {4097, 33}}) {
        Scene scene(gridOf(columns, rows, hills));
        for (const Camera& camera : camerasAround(scene.index().bounds()))
            scene.hold(fmt::format("{}x{}", columns, rows), camera);
    }
    HeightGrid oblong = gridOf(180, 90, hills);
    oblong.perColumn = {10, 0};
    oblong.perRow = {0, 37};
    holdAround(std::move(oblong), "oblong");
    HeightGrid turned = gridOf(120, 140, hills);
    turned.perColumn = {12, 9};
    turned.perRow = {-9, 12};
    holdAround(std::move(turned), "turned");
}

struct Place {
    const char* name;
    double i, j;   ///< posts
    double above;  ///< metres over post (i, j)
    Vec3 direction;
};

/// Hard case 11. In whole metres the finest level is exact, so even a millimetre above it nothing
/// but tau is promised.
TEST(HardCase11, CamerasWhereverTheyStandKeepThePromise) {
    Scene scene(gridOf(400, 400, hills));
    const double grazing = 0.01 * M_PI / 180;
    for (const Place& place : {
             Place{"1 mm above a post", 150, 170, 0.001, {1, 0.3, 0}},
             Place{"1 m above a corner of tiles", 128, 128, 1, {1, 1, -0.2}},
             Place{"2 m above a border", 192, 201, 2, {0, 1, 0}},
             Place{"under ground", 150, 170, -400, {1, 0.3, 0.2}},
             Place{"under ground, looking up", 150, 170, -400, {0, 0, 1}},
             Place{"straight down", 200, 180, 900, {0, 0, -1}},
             Place{"straight up", 200, 180, 900, {0, 0, 1}},
             Place{"straight down from 10,000 km", 200, 200, 1e7, {0, 0, -1}},
             Place{"from 10,000 km aside", -6e5, 0, 1e4, {1, 0.0003, -0.001}},
             Place{"along the horizon", 2, 200, 700, {std::cos(grazing), 0, -std::sin(grazing)}},
         }) {
        Camera camera;
        camera.eye = place.i < 0 ? Vec3(place.i * 16, 3200, place.above)
                                 : scene.at(place.i, place.j, place.above);
        camera.target = camera.eye + 100.0 * place.direction;
        camera.up =
            place.direction.x == 0 && place.direction.y == 0 ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
        camera.fovYDegrees = glm::length(camera.eye) > 1e6 ? 1 : 50;
        const truth::PromiseKept kept = scene.hold(place.name, camera);
        EXPECT_LE(kept.promisedPixels, 1) << place.name;
    }
}

/// Hard case 15, for lenses as narrow and as wide as there are: expected is what rays say.
TEST(HardCase15, FromOneDegreeTo170TerrainKeepsThePromise) {
    Scene scene(gridOf(300, 300, hills));
    for (const auto& [fov, tau] :
         {std::pair{1.0, 0.5}, {10.0, 4.0}, {90.0, 0.5}, {150.0, 4.0}, {170.0, 1.0}}) {
        Camera camera;
        camera.eye = scene.at(100, 120, std::max(100.0, 6e4 / (fov * fov)));
        camera.target = scene.at(130, 140, 0);
        camera.fovYDegrees = fov;
        const auto kept = scene.hold(fmt::format("{} degrees", fov), camera, tau);
        EXPECT_LE(kept.promisedPixels, tau) << fov;
        EXPECT_GT(kept.measured.compared, 1000U) << fov;
    }
}

/// How many of the pictures' pixels are not alike: of depth, by more than that share of it.
std::size_t unlike(const fabric::ChannelResult& a, const fabric::ChannelResult& b, float share) {
    const fabric::PixelViewport whole{0, 0, kWidth, kHeight};
    const std::vector<float> ofA = truth::depthMetres(a.image, whole);
    const std::vector<float> ofB = truth::depthMetres(b.image, whole);
    std::size_t count = 0;
    for (std::size_t k = 0; k < ofA.size(); ++k) {
        const bool isAlike =
            ofA[k] == ofB[k] || std::abs(ofA[k] - ofB[k]) <= share * std::min(ofA[k], ofB[k]);
        count += isAlike ? 0 : 1;
    }
    return count;
}

/// Hard case 21, drawn: the camera walks in steps of a quarter of a metre, less than a pixel of all
/// that it sees, past a post to which positions snap. A whole number of posts from the origin its
/// pictures are those at the origin, bit by bit; anywhere else, but for pixels at outlines. No
/// picture jumps from the one before.
TEST(HardCase21, PicturesMoveAsSteadilyFarFromTheOrigin) {
    const HeightGrid grid = gridOf(300, 300, hills);
    const std::array<fabric::Vec2, 3> places = {
        fabric::Vec2(0), {6'400'000, -6'400'000}, {6378137.3, -6356752.7}};
    std::vector<std::unique_ptr<Scene>> scenes;
    for (const fabric::Vec2& place : places) {
        HeightGrid there = grid;
        there.origin += place;
        scenes.push_back(std::make_unique<Scene>(std::move(there)));
    }
    constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
    std::size_t mostApart = 0;
    std::size_t mostMoved = 0;
    fabric::ChannelResult before;
    for (int k = 0; k < 80; ++k) {
        std::array<fabric::ChannelResult, 3> drawn;
        for (std::size_t n = 0; n < places.size(); ++n) {
            Camera camera;
            camera.eye = Vec3(1600 + 0.25 * k, 1200 + 0.125 * k, 2200) + Vec3(places[n], 0);
            camera.target = camera.eye + Vec3(64, 128, -64);
            drawn[n] = scenes[n]->draw(camera, 0.25);
        }
        EXPECT_EQ(drawn[0].image, drawn[1].image) << "step " << k;
        mostApart = std::max(mostApart, unlike(drawn[0], drawn[2], 1e-5F));
        if (k > 0)
            mostMoved = std::max(mostMoved, unlike(drawn[2], before, 1e-3F));
        before = drawn[2];
    }
    fmt::print("of {} pixels {} are unlike those at the origin, {} unlike those before\n", kPixels,
               mostApart, mostMoved);
    EXPECT_LE(mostApart, kPixels / 1000);
    EXPECT_LE(mostMoved, kPixels / 100);
}

/// The eye on the surface itself: anything may be promised, but there is a picture.
TEST(HardCase11, AnEyeExactlyOnAPostDoesNoHarm) {
    Scene scene(gridOf(400, 400, hills));
    Camera camera;
    camera.eye = scene.at(128, 128, 0);
    camera.target = camera.eye + Vec3(1, 1, 0);
    const auto drawn = scene.draw(camera, 1);
    EXPECT_GE(drawn.statistics.tauAchievedPixels, 0);
    for (const float depth : drawn.image.depth) EXPECT_FALSE(std::isnan(depth));
}

/// Where the data are not exact, a promise from close above them is of these data, and finite.
TEST(HardCase11, CloseAboveRoundedDataThePromiseIsFiniteAndKept) {
    Scene scene(import::synthesizeTerrain(257, 3));
    for (const double above : {0.3, 1.0, 3.0})
        for (int k = 0; k < 4; ++k) {
            Camera camera;
            camera.eye = scene.at(100 + 7 * k, 90 + 11 * k, above);
            camera.target = camera.eye + Vec3(std::cos(1.3 * k), std::sin(1.3 * k), 0.05);
            const auto kept = scene.hold(fmt::format("{} m above, {}", above, k), camera);
            EXPECT_TRUE(std::isfinite(kept.promisedPixels)) << above;
        }
}

}  // namespace
}  // namespace eyrie
