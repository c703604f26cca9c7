// SPDX-License-Identifier: Apache-2.0
// The promise of pictures that are seen through walls or sample a view otherwise than at its
// pixels' centres. The judge casts a ray through each point of a wall that is named by the wall's
// three corners; it knows no frustum.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fabric/image.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/ply_reader.h"
#include "renderer/import/terrain_import.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/terrain_cameras.h"
#include "renderer/truth/terrain_promise.h"
#include "tests/integration/dem_posts.h"
#include "tests/renderer/lod/wall.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::Camera;
using fabric::ChannelTask;
using fabric::Raster;
using fabric::Vec2;
using fabric::Vec3;
using truth::Pinhole;
using truth::TerrainPromise;

constexpr unsigned kSeed = 20261122;
constexpr int kWidth = 240;
constexpr int kHeight = 160;

/// A picture by a task, and the same by a wall's corners.
struct Seen {
    ChannelTask task;
    Pinhole judge;

    /// What a raster samples of it.
    Seen sampled(const Raster& raster) const {
        Seen other{task, judge.sampled(raster.origin, raster.step, raster.width, raster.height)};
        other.task.raster = raster;
        return other;
    }
    Vec2 step() const { return task.raster ? task.raster->step : Vec2(1); }
};

ChannelTask wholeView() {
    ChannelTask task;
    task.viewWidth = kWidth;
    task.viewHeight = kHeight;
    return task;
}

/// Pixels are as wide or high as comes.
Seen throughAWall(const Camera& camera, test::Dice& dice) {
    const test::Wall wall = test::randomWall(dice);
    const Vec3 eye = test::randomEye(dice);
    const test::Wall inWorld = test::inWorld(camera, wall);
    Seen seen{wholeView(),
              Pinhole(test::inWorld(camera, eye),
                      {inWorld.lowerLeft, inWorld.lowerRight, inWorld.upperLeft}, kWidth, kHeight)};
    seen.task.sight = test::sightThrough(wall, eye);
    return seen;
}

Seen straightAhead(const Camera& camera) { return {wholeView(), Pinhole(camera, kWidth, kHeight)}; }

struct NamedRaster {
    const char* name;
    Raster raster;
};

/// As pixel, subpixel and zoom compounds, and dynamic resolution, have them.
const std::vector<NamedRaster> kRasters = {
    {"every third column", {kWidth / 3, kHeight, {1 + 0.5 - 1.5, 0}, {3, 1}}},
    {"every second row and column", {kWidth / 2, kHeight / 2, {0.5, -0.5}, {2, 2}}},
    {"beside the centres", {kWidth, kHeight, {0.31, -0.44}, {1, 1}}},
    {"twice as fine", {2 * kWidth, 2 * kHeight, {0, 0}, {0.5, 0.5}}},
    {"at 0.7 of the resolution", {168, 112, {0, 0}, {kWidth / 168.0, kHeight / 112.0}}},
};

/// Terrain around Segovia, 601 x 410 posts 25 m apart.
class SightTerrain : public testing::Test {
protected:
    void SetUp() override {
        const std::string dem = EYRIE_SOURCE_DIR "/../shared/data/terrain/qgis_dem25_spain.tif.gz";
        auto posts = test::readPosts("/vsigzip/" + dem);
        ASSERT_TRUE(posts.ok()) << posts.status();
        ground_ = std::make_unique<truth::TerrainRayCaster>(*std::move(posts));
        const std::string terrain = folder_.path("terrain.eyt");
        const auto report = import::importTerrain({dem}, terrain, {}, {});
        ASSERT_TRUE(report.ok()) << report.status();
        renderer_ = test::makeRenderer();
        fabric::Scene scene;
        scene.objects.push_back(
            {.name = "terrain", .kind = fabric::ObjectKind::Terrain, .path = terrain});
        const auto info = renderer_->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        auto file = terrain::EytFile::open(terrain);
        ASSERT_TRUE(file.ok()) << file.status();
        promise_ = std::make_unique<TerrainPromise>(*renderer_, *ground_, *file);
        cameras_ = std::make_unique<truth::TerrainCameras>(*ground_, info->bounds, kSeed);
    }

    Camera camera(int i) {
        return cameras_->make(
            static_cast<truth::TerrainCameras::Kind>(i % truth::TerrainCameras::kKinds));
    }

    void check(const std::string& name, const Camera& camera, double tauPixels, const Seen& seen) {
        const auto kept = promise_->hold(camera, tauPixels, seen.task, seen.judge);
        ASSERT_TRUE(kept.ok()) << kept.status();
        const truth::DepthComparison& found = kept->measured;
        fmt::print(
            "{:>28}, tau {:3.1f}: promised {:7.3f} px, measured {:6.3f}; {} pixels, {} holes, {} "
            "false, {} misplaced, {} suspects\n",
            name, tauPixels, kept->promisedPixels, kept->measuredPixels, found.compared,
            found.holes, found.falseHits, found.misplaced, found.suspects);
        EXPECT_LE(kept->measuredPixels,
                  kept->promisedPixels + TerrainPromise::rasterPixels(seen.step()))
            << name;
        EXPECT_EQ(found.holes + found.falseHits + found.misplaced, 0U) << name;
        compared_ += found.compared;
        kept_ += kept->promisedPixels <= tauPixels ? 1 : 0;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<truth::TerrainRayCaster> ground_;
    std::unique_ptr<TerrainPromise> promise_;
    std::unique_ptr<truth::TerrainCameras> cameras_;
    std::size_t compared_ = 0;
    int kept_ = 0;
};

TEST_F(SightTerrain, IsWhereItIsPromisedThroughObliqueWalls) {
    test::Dice dice(kSeed);
    for (int i = 0; i < 8; ++i) {
        const Camera camera = this->camera(i);
        check(fmt::format("wall {}", i), camera, i < 4 ? 1 : 4, throughAWall(camera, dice));
    }
    EXPECT_GT(compared_, 4U * kWidth * kHeight);
    EXPECT_GE(kept_, 3) << "some should be as near as was asked for";
}

TEST_F(SightTerrain, IsWhereItIsPromisedAtThePointsOfEveryRaster) {
    test::Dice dice(kSeed);
    int i = 0;
    for (const NamedRaster& one : kRasters) {
        const Camera camera = this->camera(i);
        const Seen view = ++i % 2 == 0 ? straightAhead(camera) : throughAWall(camera, dice);
        check(one.name, camera, 6, view.sampled(one.raster));
    }
    EXPECT_GT(compared_, 1U * kWidth * kHeight);
}

/// The Stanford dragon of 47,794 triangles.
class SightMesh : public testing::Test {
protected:
    void SetUp() override {
        auto mesh = import::readPly(
            inflated(EYRIE_SOURCE_DIR "/../shared/data/meshes/dragon_vrip_res3.ply.gz"));
        ASSERT_TRUE(mesh.ok()) << mesh.status();
        source_ = std::make_unique<truth::MeshRayCaster>(
            truth::TriangleMesh{mesh->positions, mesh->triangles});
        const std::string path = folder_.path("mesh.eym");
        const auto report = import::importMesh(*std::move(mesh), path);
        ASSERT_TRUE(report.ok()) << report.status();
        renderer_ = test::makeRenderer();
        fabric::Scene scene;
        scene.objects.push_back({.name = "mesh", .kind = fabric::ObjectKind::Mesh, .path = path});
        const auto info = renderer_->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
    }

    std::string inflated(const std::string& path) {
        const std::string plain = folder_.path("mesh.ply");
        std::ofstream out(plain, std::ios::binary);
        VSILFILE* file = VSIFOpenL(("/vsigzip/" + path).c_str(), "rb");
        EXPECT_NE(file, nullptr) << path;
        std::vector<char> some(1 << 16);
        for (std::size_t n = 1; file != nullptr && n > 0;) {
            n = VSIFReadL(some.data(), 1, some.size(), file);
            out.write(some.data(), static_cast<std::streamsize>(n));
        }
        if (file != nullptr)
            VSIFCloseL(file);
        return plain;
    }

    /// Near enough to fill much of the picture.
    Camera camera(test::Dice& dice) const {
        Camera camera;
        camera.target = bounds_.centre();
        camera.eye = camera.target + dice.direction() * glm::length(bounds_.size()) * 0.9;
        camera.up = dice.direction();
        return camera;
    }

    /// The room is as large as the mesh is small.
    Seen throughAWall(const Camera& camera, test::Dice& dice) const {
        test::Wall wall = test::randomWall(dice);
        Vec3 eye = test::randomEye(dice);
        const double size = glm::length(bounds_.size()) * 0.25;
        for (Vec3* point : {&wall.lowerLeft, &wall.lowerRight, &wall.upperLeft, &eye})
            *point *= size;
        const test::Wall inWorld = test::inWorld(camera, wall);
        Seen seen{wholeView(), Pinhole(test::inWorld(camera, eye),
                                       {inWorld.lowerLeft, inWorld.lowerRight, inWorld.upperLeft},
                                       kWidth, kHeight)};
        seen.task.sight = test::sightThrough(wall, eye);
        return seen;
    }

    void check(const std::string& name, const Camera& camera, double tauPixels, const Seen& seen) {
        const fabric::FrameData frame{.version = 1, .camera = camera, .tauPixels = tauPixels};
        ChannelTask task = seen.task;
        task.pixelViewport = fabric::pictureOf(task);
        task.wantsDepth = true;
        const auto drawn = renderer_->render(frame, task);
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        fabric::Image whole = fabric::makeImage(task.pixelViewport, {}, true);
        fabric::paste(drawn->image, whole);
        std::vector<float> metres;
        for (const float reversed : whole.depth)
            metres.push_back(
                static_cast<float>(fabric::viewDepthMetres(reversed, fabric::kNearMetres)));
        const double promised = drawn->statistics.tauAchievedPixels;
        const double finest = std::min(seen.step().x, seen.step().y);
        const auto found = truth::compareDepth(seen.judge, metres, *source_,
                                               static_cast<int>(std::ceil(promised / finest)) + 1);
        fmt::print(
            "{:>28}, tau {:3.1f}: promised {:7.3f} px, measured {:6.3f}, {} triangles; {} pixels, "
            "{} holes, {} false, {} misplaced\n",
            name, tauPixels, promised, found.maxPixels, drawn->statistics.triangles, found.compared,
            found.holes, found.falseHits, found.misplaced);
        EXPECT_LE(promised, tauPixels) << name;
        EXPECT_LE(found.maxPixels, promised + TerrainPromise::rasterPixels(seen.step())) << name;
        EXPECT_EQ(found.holes + found.falseHits + found.misplaced, 0U) << name;
        compared_ += found.compared;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<truth::MeshRayCaster> source_;
    fabric::Box bounds_;
    std::size_t compared_ = 0;
};

TEST_F(SightMesh, IsWhereItIsPromisedThroughObliqueWallsAndAtThePointsOfEveryRaster) {
    test::Dice dice(kSeed);
    for (int i = 0; i < 8; ++i) {
        const Camera camera = this->camera(dice);
        check(fmt::format("wall {}", i), camera, i < 4 ? 1 : 4, throughAWall(camera, dice));
    }
    int i = 0;
    for (const NamedRaster& one : kRasters) {
        const Camera camera = this->camera(dice);
        const Seen view = ++i % 2 == 0 ? straightAhead(camera) : throughAWall(camera, dice);
        check(one.name, camera, 6, view.sampled(one.raster));
    }
    EXPECT_GT(compared_, 1U * kWidth * kHeight);
}

}  // namespace
}  // namespace eyrie
