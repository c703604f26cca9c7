// SPDX-License-Identifier: Apache-2.0
// Real renderer processes behind a real coordinator: each decomposition, at twenty cameras, must
// give the picture that one renderer in this process gives.
#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "coordinator/coordinator.h"
#include "renderer/renderer.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::FrameRequest;
using fabric::Vec3;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr unsigned kSeed = 20261121;
constexpr int kCameras = 20;

/// Cameras around and close above the scene, the same ones in every run.
std::vector<FrameRequest> randomViews(const fabric::Box& bounds) {
    std::mt19937 random(kSeed);
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<FrameRequest> views(kCameras);
    for (FrameRequest& view : views) {
        const Vec3 size = bounds.size();
        view.camera.target = bounds.min + size * Vec3(in(0.2, 0.8), in(0.2, 0.8), in(0.2, 0.8));
        const double azimuth = in(0, 2 * M_PI);
        const double height = in(0.1, 1.2);
        view.camera.eye =
            view.camera.target + glm::length(size) * in(0.15, 1.2) *
                                     Vec3(std::cos(azimuth) * std::cos(height),
                                          std::sin(azimuth) * std::cos(height), std::sin(height));
        view.camera.fovYDegrees = in(20, 80);
        view.wantsDepth = true;
    }
    return views;
}

std::size_t differentPixels(const fabric::Image& a, const fabric::Image& b) {
    if (a.colour.size() != b.colour.size() || a.depth.size() != b.depth.size())
        return std::max(a.colour.size(), b.colour.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i)
        different += a.colour[i] == b.colour[i] && a.depth[i] == b.depth[i] ? 0 : 1;
    return different;
}

class RendererProcesses : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        const auto make = [](const std::string& kind, const std::string& size,
                             const std::string& source, const std::string& data) {
            ASSERT_TRUE(test::succeeded(
                {"synth", kind, "--size", size, "--seed", "5", "-o", folder_->path(source)}));
            ASSERT_TRUE(test::succeeded(
                {"import", kind, folder_->path(source), "-o", folder_->path(data)}));
        };
        make("terrain", "1025", "dem.tif", "dem.eyt");
        make("mesh", "150000", "ball.ply", "ball.eym");
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static fabric::Scene scene(fabric::ObjectKind kind) {
        fabric::Scene scene;
        const bool mesh = kind == fabric::ObjectKind::Mesh;
        scene.objects.push_back(
            {.name = "data", .kind = kind, .path = folder_->path(mesh ? "ball.eym" : "dem.eyt")});
        return scene;
    }

    /// What one renderer in this process makes of the views.
    static std::vector<fabric::Image> expectedPictures(const fabric::Scene& scene,
                                                       const std::vector<FrameRequest>& views,
                                                       Renderer& renderer) {
        std::vector<fabric::Image> pictures;
        for (const FrameRequest& view : views) {
            fabric::FrameData frame{
                .version = 1, .camera = view.camera, .tauPixels = view.tauPixels};
            fabric::ChannelTask task;
            task.frameDataVersion = 1;
            task.viewWidth = view.width;
            task.viewHeight = view.height;
            task.pixelViewport = {0, 0, view.width, view.height};
            task.wantsDepth = true;
            auto result = renderer.render(frame, task);
            EXPECT_TRUE(result.ok()) << result.status();
            pictures.push_back(fabric::makeImage(task.pixelViewport, scene.background, true));
            if (result.ok())
                fabric::paste(result->image, pictures.back());
        }
        return pictures;
    }

    static void compare(const fabric::Scene& scene, const std::vector<FrameRequest>& views,
                        const std::vector<fabric::Image>& expected, const std::string& layout,
                        std::size_t count) {
        auto coordinator = coordinator::Coordinator::start(
            {.grpcAddresses = {"127.0.0.1:0"}, .layout = layout, .scene = scene});
        ASSERT_TRUE(coordinator.ok()) << coordinator.status();
        std::vector<std::unique_ptr<test::Process>> renderers;
        for (std::size_t i = 0; i < count; ++i)
            renderers.push_back(std::make_unique<test::Process>(test::eyrieCommand(
                {"renderer", "--coordinator", (*coordinator)->grpcAddresses().front()})));
        coordinator::FrameSource& frames = (*coordinator)->frames();
        ASSERT_TRUE(test::eventually(seconds(30), [&] {
            return frames.status().renderers.size() == count && frames.status().problem.empty();
        })) << renderers.front()->errors();
        std::size_t worst = 0;
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto frame = frames.renderFrame(views[i]);
            ASSERT_TRUE(frame.ok()) << frame.status();
            EXPECT_TRUE(frame->statistics.complete);
            const std::size_t different = differentPixels(frame->image, expected[i]);
            worst = std::max(worst, different);
            EXPECT_EQ(different, 0U) << "camera " << i;
        }
        const std::string metrics = (*coordinator)->telemetry()->metrics.text({}, {});
        EXPECT_THAT(metrics, HasSubstr("\neyrie_renderer_pictures_total{way=\"messages\"} 0\n"));
        // Of direct-send what renderers finish comes otherwise, and nothing else has to.
        const bool noneInMemory =
            metrics.find("\neyrie_renderer_pictures_total{way=\"memory\"} 0\n") !=
            std::string::npos;
        EXPECT_FALSE(noneInMemory && layout != "direct-send");
        fmt::print("{} over {} processes: at most {} of 921600 pixels differ, {} cameras\n", layout,
                   count, worst, views.size());
    }

    static void expectEveryDecompositionEqual(fabric::ObjectKind kind) {
        const fabric::Scene scene = RendererProcesses::scene(kind);
        auto renderer = Renderer::create({});
        ASSERT_TRUE(renderer.ok()) << renderer.status();
        const auto info = (*renderer)->openScene(scene);
        ASSERT_TRUE(info.ok()) << info.status();
        const auto views = randomViews(info->bounds);
        const auto expected = expectedPictures(scene, views, **renderer);
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "2D", 2));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "DB-2D", 4));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "DB dynamic", 2));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "direct-send", 3));
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> RendererProcesses::folder_;

TEST_F(RendererProcesses, DrawATerrainAsOneRendererDoes) {
    expectEveryDecompositionEqual(fabric::ObjectKind::Terrain);
}

TEST_F(RendererProcesses, DrawAMeshAsOneRendererDoes) {
    expectEveryDecompositionEqual(fabric::ObjectKind::Mesh);
}

}  // namespace
}  // namespace eyrie
