// SPDX-License-Identifier: Apache-2.0
// Real renderer processes behind a real coordinator: each layout that is made of them, and each
// decomposition, at twenty cameras, must give the picture that one renderer in this process gives.
#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/different_pixels.h"
#include "tests/support/local_pictures.h"
#include "tests/support/program.h"
#include "tests/support/random_views.h"
#include "tests/support/renderer_farm.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using coordinator::FrameRequest;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr int kCameras = 20;

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

    static void compare(const fabric::Scene& scene, const std::vector<FrameRequest>& views,
                        const std::vector<fabric::Image>& expected, const std::string& layout,
                        int count) {
        const auto farm =
            test::RendererFarm::start(EYRIE_BINARY, count, {.layout = layout, .scene = scene});
        ASSERT_TRUE(farm.ok()) << farm.status();
        ASSERT_TRUE((*farm)->awaitAllReady(seconds(30))) << (*farm)->renderer(0).errors();
        std::size_t worst = 0;
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto frame = (*farm)->frames().renderFrame(views[i]);
            ASSERT_TRUE(frame.ok()) << frame.status();
            EXPECT_TRUE(frame->statistics.complete);
            const std::size_t different = test::differentPixels(frame->image, expected[i]);
            worst = std::max(worst, different);
            EXPECT_EQ(different, 0U) << "camera " << i;
        }
        const std::string metrics = (*farm)->coordinator().telemetry()->metrics.text({}, {});
        EXPECT_THAT(metrics, HasSubstr("\neyrie_renderer_pictures_total{way=\"messages\"} 0\n"));
        // Of direct-send what renderers finish comes otherwise, and nothing else has to.
        const bool noneInMemory =
            metrics.find("\neyrie_renderer_pictures_total{way=\"memory\"} 0\n") !=
            std::string::npos;
        EXPECT_FALSE(noneInMemory && layout != "direct-send");
        fmt::print("{} over {} processes: at most {} of 921600 pixels differ, {} cameras\n", layout,
                   count, worst, views.size());
    }

    static void expectEveryLayoutEqual(fabric::ObjectKind kind) {
        const fabric::Scene scene = RendererProcesses::scene(kind);
        const auto here = test::LocalPictures::open(scene);
        ASSERT_TRUE(here.ok()) << here.status();
        auto views = test::randomViews((*here)->bounds(), kCameras);
        for (FrameRequest& view : views) view.wantsDepth = true;
        std::vector<fabric::Image> expected;
        for (const FrameRequest& view : views) {
            fabric::ChannelTask task;
            task.pixelViewport = {0, 0, view.width, view.height};
            task.wantsDepth = true;
            const auto picture = (*here)->draw(view, task);
            ASSERT_TRUE(picture.ok()) << picture.status();
            expected.push_back(*picture);
        }
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "2D", 2));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "DB-2D", 4));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "DB dynamic", 2));
        ASSERT_NO_FATAL_FAILURE(compare(scene, views, expected, "direct-send", 3));
    }

    /// Small; bench/decompositions does it at any size.
    static void expectEveryDecompositionRight(const std::string& data) {
        const test::Outcome outcome =
            test::run({EYRIE_DECOMPOSITIONS_BINARY, EYRIE_BINARY, folder_->path(data), "192x108"},
                      std::chrono::minutes(5));
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors << outcome.output;
        fmt::print("{}:\n{}", data, outcome.output);
    }

    static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> RendererProcesses::folder_;

TEST_F(RendererProcesses, DrawATerrainAsOneRendererDoes) {
    expectEveryLayoutEqual(fabric::ObjectKind::Terrain);
}

TEST_F(RendererProcesses, DrawAMeshAsOneRendererDoes) {
    expectEveryLayoutEqual(fabric::ObjectKind::Mesh);
}

TEST_F(RendererProcesses, DrawATerrainInEveryDecompositionAsItIsDefined) {
    expectEveryDecompositionRight("dem.eyt");
}

TEST_F(RendererProcesses, DrawAMeshInEveryDecompositionAsItIsDefined) {
    expectEveryDecompositionRight("ball.eym");
}

}  // namespace
}  // namespace eyrie
