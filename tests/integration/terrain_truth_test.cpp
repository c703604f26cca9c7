// SPDX-License-Identifier: Apache-2.0
// The terrain promise: at every pixel the picture's surface is, on the screen, no farther from the
// source than the frame says. The judge casts double-precision rays at the posts that GDAL reads.
// bench/terrain_promise holds more cameras and data sets against it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/import/geotiff_writer.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "renderer/truth/terrain_cameras.h"
#include "renderer/truth/terrain_promise.h"
#include "tests/integration/dem_posts.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using truth::TerrainCameras;
using truth::TerrainPromise;

constexpr unsigned kSeed = 20261121;
constexpr double kTauPixels = 1;

class TerrainTruth : public testing::Test {
protected:
    void SetUp() override { renderer_ = test::makeRenderer(); }

    /// `gdalPath` names the same file to GDAL.
    void open(const std::string& dem, const std::string& gdalPath) {
        auto posts = test::readPosts(gdalPath);
        ASSERT_TRUE(posts.ok()) << posts.status();
        ground_ = std::make_unique<truth::TerrainRayCaster>(*std::move(posts));
        const std::string terrain = folder_.path("terrain.eyt");
        const auto report = import::importTerrain({dem}, terrain, {}, {});
        ASSERT_TRUE(report.ok()) << report.status();
        scene_.objects = {
            {.name = "terrain", .kind = fabric::ObjectKind::Terrain, .path = terrain}};
        auto info = renderer_->openScene(scene_);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
        auto file = terrain::EytFile::open(terrain);
        ASSERT_TRUE(file.ok()) << file.status();
        promise_ = std::make_unique<TerrainPromise>(*renderer_, *ground_, *file);
    }

    void checkCamera(const std::string& name, const Camera& camera, int width, int height) {
        const auto kept = promise_->hold(camera, kTauPixels, width, height);
        ASSERT_TRUE(kept.ok()) << kept.status();
        ASSERT_TRUE(kept->statistics.complete) << name;
        const truth::DepthComparison& found = kept->measured;
        fmt::print(
            "{:>11} {:4}x{:<4} promised {:8.4f} px, measured {:.4f} px (p99 {:.4f}) at {},{}; {} "
            "pixels, {} holes, {} false, {} misplaced, {} suspects, {} triangles\n",
            name, width, height, kept->promisedPixels, found.maxPixels, found.p99Pixels,
            found.worstX, found.worstY, found.compared, found.holes, found.falseHits,
            found.misplaced, found.suspects, kept->statistics.triangles);
        EXPECT_TRUE(std::isfinite(kept->promisedPixels)) << name << ": the eye is above ground";
        EXPECT_LE(kept->measuredPixels, kept->promisedPixels + TerrainPromise::kRasterPixels)
            << name;
        EXPECT_EQ(found.holes, 0U) << name;
        EXPECT_EQ(found.falseHits, 0U) << name;
        EXPECT_EQ(found.misplaced, 0U) << name;
        EXPECT_LE(found.suspects * pixelsForASuspect_, found.compared)
            << name << ": too much is judged by the drawn triangles";
        EXPECT_GT(found.compared, 1000U) << name << ": the camera should see the terrain";
        if (kept->promisedPixels > kTauPixels)  // the data end
            expectNoFinerData(name, camera, width, height, kept->promisedPixels);
    }

    /// Less would be promised if the data had it.
    void expectNoFinerData(const std::string& name, const Camera& camera, int width, int height,
                           double promised) {
        const auto finest = promise_->hold(camera, fabric::kMinTauPixels, width, height);
        ASSERT_TRUE(finest.ok()) << finest.status();
        EXPECT_EQ(finest->promisedPixels, promised) << name << ": more than was asked for";
    }

    /// Of a picture that does not wait for its data.
    static fabric::ChannelTask interactive(int width, int height) {
        fabric::ChannelTask task;
        task.frameDataVersion = 1;
        task.viewWidth = width;
        task.viewHeight = height;
        task.pixelViewport = {0, 0, width, height};
        task.wantsDepth = true;
        task.completeness = fabric::Completeness::Interactive;
        return task;
    }

    void checkTwentyCameras() {
        TerrainCameras cameras(*ground_, bounds_, kSeed);
        for (int i = 0; i < 20; ++i) {
            const int kind = i % TerrainCameras::kKinds;
            // The larger picture for one of each kind: the judge casts several rays a pixel.
            const bool isLarge = i < TerrainCameras::kKinds;
            checkCamera(fmt::format("{} {}", TerrainCameras::kNames[static_cast<std::size_t>(kind)],
                                    i / TerrainCameras::kKinds),
                        cameras.make(static_cast<TerrainCameras::Kind>(kind)), isLarge ? 1280 : 640,
                        isLarge ? 720 : 360);
        }
    }

    test::TemporaryFolder folder_;
    fabric::Scene scene_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<truth::TerrainRayCaster> ground_;
    std::unique_ptr<TerrainPromise> promise_;
    fabric::Box bounds_;
    std::size_t pixelsForASuspect_ = 10'000;
};

TEST_F(TerrainTruth, HoldsOnASyntheticTerrain) {
    const std::string dem = folder_.path("synthetic.tif");
    const absl::Status written = import::writeGeoTiff(import::synthesizeTerrain(1025, 7), dem);
    ASSERT_TRUE(written.ok()) << written;
    ASSERT_NO_FATAL_FAILURE(open(dem, dem));
    checkTwentyCameras();
}

TEST_F(TerrainTruth, HoldsInTheSanGabrielMountains) {
    const std::string dem = EYRIE_SOURCE_DIR "/../shared/data/terrain/bigtujunga.tif.gz";
    ASSERT_NO_FATAL_FAILURE(open(dem, "/vsigzip/" + dem));
    checkTwentyCameras();
}

/// Frames that do not wait, as those are that hold a frame time, from the first one on: each is
/// held against what it itself promises, in pictures of two sizes.
TEST_F(TerrainTruth, HoldsOfWhatStandsInForPagesThatAreNotThereYet) {
    const std::string dem = folder_.path("synthetic.tif");
    ASSERT_TRUE(import::writeGeoTiff(import::synthesizeTerrain(513, 9), dem).ok());
    ASSERT_NO_FATAL_FAILURE(open(dem, dem));
    TerrainCameras cameras(*ground_, bounds_, kSeed);
    int standIns = 0;
    for (int kind = 0; kind < TerrainCameras::kKinds; ++kind) {
        const Camera camera = cameras.make(static_cast<TerrainCameras::Kind>(kind));
        const int width = kind % 2 == 0 ? 320 : 480;
        const auto fresh = test::makeRenderer();
        ASSERT_TRUE(fresh->openScene(scene_).ok());
        const truth::ReferenceView view =
            truth::castView(truth::Pinhole(camera, width, width * 9 / 16), *ground_);
        bool isComplete = false;
        for (int i = 0; i < 200 && !isComplete; ++i) {
            const auto drawn = fresh->render({.version = 1, .camera = camera, .tauPixels = 0.5},
                                             interactive(width, width * 9 / 16));
            ASSERT_TRUE(drawn.ok()) << drawn.status();
            isComplete = drawn->statistics.complete;
            const double promised = drawn->statistics.tauAchievedPixels;
            if (i % 10 != 0 && !isComplete)
                continue;
            standIns += !isComplete && std::isfinite(promised) ? 1 : 0;
            const int edge =
                static_cast<int>(std::min(std::ceil(promised) + 1, static_cast<double>(width)));
            const auto found = truth::compareDepth(
                view, truth::depthMetres(drawn->image, {0, 0, width, width * 9 / 16}), edge, {},
                truth::LookAround::All);
            const std::string name = fmt::format("camera {}, frame {}", kind, i);
            EXPECT_LE(found.maxPixels, promised + TerrainPromise::kRasterPixels) << name;
            EXPECT_EQ(found.holes + found.falseHits + found.misplaced, 0U) << name;
        }
        EXPECT_TRUE(isComplete) << "the pages should have come";
    }
    EXPECT_GT(standIns, 0);
}

/// Walls a thousand times as high as wide, seen along their planes and from between them, and gaps
/// through which one sees below the ground: what a judge gets wrong first.
TEST_F(TerrainTruth, HoldsBetweenSpiresAndVoids) {
    terrain::HeightGrid grid = import::synthesizeTerrain(257, 3);
    for (int j = 0; j < 257; ++j)
        for (int i = 0; i < 257; ++i)
            grid.heights[static_cast<std::size_t>(j * 257 + i)] =
                i % 3 == 0 && j % 3 == 0   ? std::nanf("")
                : i % 7 == 3 && j % 5 == 2 ? 30'000.0F
                                           : 0.0F;
    const std::string dem = folder_.path("spires.tif");
    ASSERT_TRUE(import::writeGeoTiff(grid, dem).ok());
    ASSERT_NO_FATAL_FAILURE(open(dem, dem));
    pixelsForASuspect_ = 200;
    TerrainCameras cameras(*ground_, bounds_, kSeed);
    for (int kind = 0; kind < TerrainCameras::kKinds; ++kind)
        checkCamera(std::string(TerrainCameras::kNames[static_cast<std::size_t>(kind)]),
                    cameras.make(static_cast<TerrainCameras::Kind>(kind)), 640, 360);
}

/// Two triangles as wide as the data would be exact, and are drawn in single precision: what a
/// corner 100 km away is rounded by is pixels at one's feet.
TEST_F(TerrainTruth, HoldsRightAboveAWidePlain) {
    terrain::HeightGrid grid{.columns = 1025,
                             .rows = 1025,
                             .heights = std::vector<float>(1025 * 1025, 0.0F),
                             .perColumn = {97, 0},
                             .perRow = {0, 97}};
    const std::string dem = folder_.path("plain.tif");
    ASSERT_TRUE(import::writeGeoTiff(grid, dem).ok());
    ASSERT_NO_FATAL_FAILURE(open(dem, dem));
    for (const double height : {2.0, 0.5, 0.1}) {
        Camera camera;
        camera.eye = {bounds_.centre().x + 11, bounds_.min.y + 0.3 * bounds_.size().y, height};
        camera.target = camera.eye + fabric::Vec3(0.3, 1, -0.1);
        const auto kept = promise_->hold(camera, kTauPixels, 640, 360);
        ASSERT_TRUE(kept.ok()) << kept.status();
        EXPECT_GT(kept->promisedPixels, 0) << height;
        EXPECT_LT(kept->promisedPixels, 2 / height) << height;
        EXPECT_LE(kept->measuredPixels, kept->promisedPixels + TerrainPromise::kRasterPixels)
            << height;
        EXPECT_EQ(kept->measured.falseHits + kept->measured.misplaced, 0U) << height;
    }
}

/// A plain, and broken ground behind a ridge across it; `change` is done to the heights.
terrain::HeightGrid plainBeforeARidge(const std::function<void(std::vector<float>&)>& change,
                                      int side) {
    terrain::HeightGrid grid = import::synthesizeTerrain(side, 3);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            float& height = grid.heights[static_cast<std::size_t>(j * side + i)];
            if (j < 310)
                height = j > 270 ? 3000 : 0;
        }
    change(grid.heights);
    return grid;
}

/// What is promised looking north over the plain from its middle.
class TerrainBehindARidge : public TerrainTruth {
protected:
    void open(const std::function<void(std::vector<float>&)>& change, int side = 513) {
        const std::string dem = folder_.path("ridge.tif");
        ASSERT_TRUE(import::writeGeoTiff(plainBeforeARidge(change, side), dem).ok());
        ASSERT_NO_FATAL_FAILURE(TerrainTruth::open(dem, dem));
        const fabric::Vec3 size = bounds_.size();
        camera_.eye = {bounds_.min.x + size.x / 2, bounds_.min.y + size.y * 128 / side, 40};
        camera_.target = camera_.eye + fabric::Vec3(0, 1, 0);
        camera_.fovYDegrees = 40;
    }

    double promised(const fabric::Look& look = {}) {
        fabric::FrameData frame{.version = ++version_, .camera = camera_, .tauPixels = tauPixels_};
        frame.look = look;
        fabric::ChannelTask task;
        task.frameDataVersion = version_;
        task.viewWidth = 640;
        task.viewHeight = 360;
        task.pixelViewport = {0, 0, 640, 360};
        const auto drawn = renderer_->render(frame, task);
        EXPECT_TRUE(drawn.ok()) << drawn.status();
        return drawn.ok() ? drawn->statistics.tauAchievedPixels : 0;
    }

    /// The same where something else is in the picture, so that nothing counts as hidden.
    double promisedOfAll() {
        fabric::Look look;
        look.tileBounds = true;
        return promised(look);
    }

    Camera camera_;
    double tauPixels_ = kTauPixels;
    std::uint64_t version_ = 0;
};

TEST_F(TerrainBehindARidge, IsNotPromisedFor) {
    ASSERT_NO_FATAL_FAILURE(open([](auto&) {}));
    EXPECT_LT(promised(), 0.5 * promisedOfAll());
    checkCamera("ridge", camera_, 640, 360);
}

TEST_F(TerrainBehindARidge, CountsWhereItIsSeenThroughAHole) {
    ASSERT_NO_FATAL_FAILURE(open([](std::vector<float>& heights) {
        for (int j = 200; j < 210; ++j) std::fill_n(heights.begin() + j * 513, 513, std::nanf(""));
    }));
    EXPECT_EQ(promised(), promisedOfAll());
}

TEST_F(TerrainBehindARidge, IsNotPromisedForBecauseOfAHoleElsewhere) {
    ASSERT_NO_FATAL_FAILURE(open([](std::vector<float>& heights) {
        for (int j = 20; j < 30; ++j)
            std::fill_n(heights.begin() + j * 513 + 20, 10, std::nanf(""));
    }));
    EXPECT_LT(promised(), 0.5 * promisedOfAll());
    checkCamera("ridge and hole", camera_, 640, 360);
}

TEST_F(TerrainBehindARidge, IsNotPromisedForBecauseOfAHoleBehindTheRidge) {
    ASSERT_NO_FATAL_FAILURE(open([](std::vector<float>& heights) {
        for (int j = 312; j < 316; ++j) std::fill_n(heights.begin() + j * 513, 513, std::nanf(""));
    }));
    EXPECT_LT(promised(), 0.5 * promisedOfAll());
    checkCamera("ridge before hole", camera_, 640, 360);
}

TEST_F(TerrainBehindARidge, IsNotPromisedForNorAreItsOutlines) {
    constexpr int kSide = 1025;
    const auto pierce = [](std::vector<float>& heights) {
        for (int j = 704; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i)
                if (i / 5 % 3 == 0 && j / 5 % 3 == 0)
                    heights[static_cast<std::size_t>(j * kSide + i)] = std::nanf("");
    };
    ASSERT_NO_FATAL_FAILURE(open(pierce, kSide));
    tauPixels_ = 8;  // levels that blur outlines are drawn
    EXPECT_LT(promised(), 0.6 * promisedOfAll());
    checkCamera("ridge before holes", camera_, 640, 360);
}

TEST_F(TerrainBehindARidge, CountsFromUnderground) {
    ASSERT_NO_FATAL_FAILURE(open([](auto&) {}));
    camera_.eye.z = camera_.target.z = -40;
    EXPECT_EQ(promised(), promisedOfAll());
}

}  // namespace
}  // namespace eyrie
