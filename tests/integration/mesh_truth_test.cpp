// SPDX-License-Identifier: Apache-2.0
// The mesh promise: at every pixel the picture's surface is, on the screen, no farther from the
// source's than the frame says. The judge casts double-precision rays at the triangles of the
// source.
#include <cmath>
#include <memory>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_reader.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/renderer.h"
#include "renderer/truth/depth_comparison.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/pinhole.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 270;
/// What rasterisation may add to what is promised: corners are rounded to 1/256 pixel.
constexpr double kRasterPixels = 1.0 / 256;

class MeshTruth : public testing::Test {
protected:
    void open(import::TriangleMesh mesh) {
        source_ = std::make_unique<truth::MeshRayCaster>(
            truth::TriangleMesh{mesh.positions, mesh.triangles});
        const std::string path = folder_.path("mesh.eym");
        const auto report = import::importMesh(std::move(mesh), path);
        ASSERT_TRUE(report.ok()) << report.status();
        ASSERT_GE(report->levels.size(), 2U);
        renderer_ = test::makeRenderer();
        fabric::Scene scene;
        scene.objects.push_back({.name = "mesh", .kind = fabric::ObjectKind::Mesh, .path = path});
        auto info = renderer_->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
    }

    /// From a random side, so far away that the mesh is about `share` of the picture high.
    fabric::Camera camera(std::mt19937& engine, double share) const {
        std::normal_distribution<double> normal;
        const fabric::Vec3 side =
            glm::normalize(fabric::Vec3(normal(engine), normal(engine), normal(engine)));
        fabric::Camera camera;
        camera.target = bounds_.centre();
        camera.up = std::abs(side.z) < 0.9 ? fabric::Vec3(0, 0, 1) : fabric::Vec3(1, 0, 0);
        camera.fovYDegrees = 40;
        const double distance = glm::length(bounds_.size()) / 2 / std::tan(M_PI / 9) / share;
        camera.eye = camera.target + distance * side;
        return camera;
    }

    absl::StatusOr<fabric::ChannelResult> render(const fabric::Camera& camera, double tauPixels,
                                                 const fabric::PixelViewport& part = {0, 0, kWidth,
                                                                                      kHeight}) {
        const fabric::FrameData frame{.version = 1, .camera = camera, .tauPixels = tauPixels};
        fabric::ChannelTask task;
        task.frameDataVersion = 1;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = part;
        task.wantsDepth = true;
        return renderer_->render(frame, task);
    }

    void check(const fabric::Camera& camera, double tauPixels) {
        const auto drawn = render(camera, tauPixels);
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        fabric::Image whole = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
        fabric::paste(drawn->image, whole);
        std::vector<float> metres;
        for (const float reversed : whole.depth)
            metres.push_back(
                static_cast<float>(fabric::viewDepthMetres(reversed, fabric::kNearMetres)));
        const double promised = drawn->statistics.tauAchievedPixels;
        const auto found = truth::compareDepth(truth::Pinhole(camera, kWidth, kHeight), metres,
                                               *source_, static_cast<int>(std::ceil(promised)) + 1);
        fmt::print(
            "tau {:.1f}: promised {:.3f} px, measured {:.3f}, {} triangles; {} pixels, {} "
            "holes, {} false, {} misplaced\n",
            tauPixels, promised, found.maxPixels, drawn->statistics.triangles, found.compared,
            found.holes, found.falseHits, found.misplaced);
        EXPECT_LE(promised, tauPixels);
        EXPECT_LE(found.maxPixels, promised + kRasterPixels);
        EXPECT_EQ(found.holes, 0U);
        EXPECT_EQ(found.falseHits, 0U);
        EXPECT_EQ(found.misplaced, 0U);
        EXPECT_GT(found.compared, 50U);
    }

    /// A picture put together of two halves is that of one channel, bit by bit.
    void checkParts(const fabric::Camera& camera) {
        fabric::Image whole = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
        fabric::Image halves = whole;
        const auto drawn = render(camera, 1);
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        fabric::paste(drawn->image, whole);
        for (const int x : {0, kWidth / 2}) {
            const auto half = render(camera, 1, {x, 0, kWidth / 2, kHeight});
            ASSERT_TRUE(half.ok()) << half.status();
            fabric::paste(half->image, halves);
        }
        EXPECT_EQ(whole.depth, halves.depth);
        EXPECT_EQ(whole.colour, halves.colour);
    }

    void checkCameras() {
        std::mt19937 engine(7);
        for (const double share : {0.1, 0.4, 1.0, 2.0})
            for (const double tau : {0.5, 1.0, 2.0, 8.0}) check(camera(engine, share), tau);
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<truth::MeshRayCaster> source_;
    fabric::Box bounds_;
};

TEST_F(MeshTruth, HoldsOnABumpyBall) {
    ASSERT_NO_FATAL_FAILURE(open(import::synthesizeMesh(300000, 2)));
    checkCameras();
}

TEST_F(MeshTruth, HoldsOnAScan) {
    auto mesh = import::readPly(EYRIE_SOURCE_DIR "/demo/rocker_arm.ply");
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_NO_FATAL_FAILURE(open(*std::move(mesh)));
    checkCameras();
}

/// A pocket that is inside out: its backs are what is seen of it.
TEST_F(MeshTruth, HoldsBesideABallThatIsInsideOut) {
    import::TriangleMesh mesh = import::synthesizeMesh(150000, 3);
    const import::TriangleMesh ball = import::synthesizeMesh(5000, 4);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const fabric::Vec3& position : ball.positions)
        mesh.positions.push_back(0.2 * position + fabric::Vec3(1.5, 0, 0));
    for (const auto& [a, b, c] : ball.triangles)
        mesh.triangles.push_back({first + a, first + c, first + b});
    mesh.normals.clear();
    ASSERT_NO_FATAL_FAILURE(open(std::move(mesh)));
    checkCameras();
}

/// Through wide holes most of the backs are seen, from some sides.
TEST_F(MeshTruth, HoldsOnAnOpenBall) {
    import::TriangleMesh mesh = import::synthesizeMesh(100000, 6);
    std::erase_if(mesh.triangles, [&](const auto& triangle) {
        const fabric::Vec3 at = glm::normalize(mesh.positions[triangle[0]]);
        return at.x > 0.9 || at.y < -0.7 || glm::dot(at, fabric::Vec3(-0.6, 0.0, 0.8)) > 0.95;
    });
    ASSERT_NO_FATAL_FAILURE(open(std::move(mesh)));
    const auto file = mesh::EymFile::open(folder_.path("mesh.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    EXPECT_EQ(file->lids().size(), 3U);
    EXPECT_GT(file->nodes()[0].frontIndexCount, file->nodes()[0].indexCount / 2);
    std::mt19937 engine(11);
    for (int i = 0; i < 8; ++i) {
        const fabric::Camera from = camera(engine, 0.8);
        check(from, 1 + i % 2);
        checkParts(from);
    }
}

TEST_F(MeshTruth, OfASolidItsWallsAreSeenFromInside) {
    ASSERT_NO_FATAL_FAILURE(open(import::synthesizeMesh(100000, 2)));
    std::mt19937 engine(3);
    fabric::Camera inside = camera(engine, 1);
    inside.eye = bounds_.centre();
    inside.target = bounds_.max;
    const auto drawn = render(inside, 1);
    ASSERT_TRUE(drawn.ok()) << drawn.status();
    fabric::Image whole = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
    fabric::paste(drawn->image, whole);
    for (const float depth : whole.depth) ASSERT_GT(depth, 0.0F);
}

}  // namespace
}  // namespace eyrie
