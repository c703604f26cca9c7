// SPDX-License-Identifier: Apache-2.0
// Real renderer processes behind a real coordinator: each layout that is made of them, and each
// decomposition, at twenty cameras, must give the picture that one renderer in this process gives.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>

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
        const auto noneCame = [&](const std::string& way) {
            return metrics.find("\neyrie_renderer_pictures_total{way=\"" + way + "\"} 0\n") !=
                   std::string::npos;
        };
        // What renderers put together among themselves comes in messages, and nothing else.
        EXPECT_NE(noneCame("messages"), layout == "direct-send" || layout == "DB-2D");
        EXPECT_FALSE(noneCame("memory") && layout != "direct-send");
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

/// bench/distribution: of as many pictures as it says, eight or all of a shorter orbit.
TEST_F(RendererProcesses, AreToldToDrawAsOneInThisProcessDoes) {
    for (const auto& [frames, pictures] : {std::pair(3, 3), {12, 8}}) {
        const test::Outcome outcome =
            test::run({EYRIE_DISTRIBUTION_BINARY, EYRIE_BINARY, folder_->path("dem.eyt"), "2D",
                       std::to_string(frames), "192x108", "4", "1"},
                      std::chrono::minutes(2));
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors << outcome.output;
        EXPECT_THAT(outcome.output,
                    testing::HasSubstr(fmt::format("\n0 pixels of {} pictures differ", pictures)));
    }
}

TEST_F(RendererProcesses, DrawATerrainAsOneRendererDoes) {
    expectEveryLayoutEqual(fabric::ObjectKind::Terrain);
}

TEST_F(RendererProcesses, DrawAMeshAsOneRendererDoes) {
    expectEveryLayoutEqual(fabric::ObjectKind::Mesh);
}

/// Machines that have the data in different places, none of which is where the scene says.
TEST_F(RendererProcesses, ReadWhatASceneNamesWhereEachHasIt) {
    std::filesystem::create_directories(folder_->path("copies/b"));
    std::filesystem::copy_file(folder_->path("ball.eym"), folder_->path("copies/b/ball.eym"));
    std::filesystem::copy_file(folder_->path("dem.eyt"), folder_->path("copies/other.eyt"));
    fabric::Scene scene = RendererProcesses::scene(fabric::ObjectKind::Mesh);
    scene.objects[0].path = "/nowhere/data/ball.eym";
    const auto farm =
        test::RendererFarm::start(EYRIE_BINARY, 3, {.layout = "DB dynamic", .scene = scene},
                                  {{"--data", folder_->path().string()},
                                   {"--data-at", "/nowhere=/elsewhere", "--data-at",
                                    "/nowhere/data=" + folder_->path("copies/b")},
                                   {"--data-at", "/nowhere=" + folder_->path("copies")}});
    ASSERT_TRUE(farm.ok()) << farm.status();
    const auto ready = [&] {
        const coordinator::Status status = (*farm)->frames().status();
        return (*farm)->conditionOf(0, status) == coordinator::RendererCondition::Ready &&
               (*farm)->conditionOf(1, status) == coordinator::RendererCondition::Ready;
    };
    ASSERT_TRUE(test::eventually(seconds(30), ready)) << (*farm)->renderer(1).errors();
    // The third has none of that name.
    EXPECT_TRUE(test::eventually(seconds(10), [&] {
        const coordinator::Status status = (*farm)->frames().status();
        return std::ranges::any_of(status.renderers, [&](const coordinator::RendererStatus& one) {
            return one.why.find(folder_->path("copies/data/ball.eym")) != std::string::npos;
        });
    }));
    const auto here = test::LocalPictures::open(RendererProcesses::scene(fabric::ObjectKind::Mesh));
    ASSERT_TRUE(here.ok()) << here.status();
    FrameRequest view = test::randomViews((*here)->bounds(), 1).front();
    view.wantsDepth = true;
    fabric::ChannelTask task;
    task.pixelViewport = {0, 0, view.width, view.height};
    task.wantsDepth = true;
    const auto expected = (*here)->draw(view, task);
    const auto frame = (*farm)->frames().renderFrame(view);
    ASSERT_TRUE(expected.ok() && frame.ok()) << expected.status() << frame.status();
    EXPECT_EQ(test::differentPixels(frame->image, *expected), 0U);
}

TEST_F(RendererProcesses, DrawATerrainInEveryDecompositionAsItIsDefined) {
    expectEveryDecompositionRight("dem.eyt");
}

TEST_F(RendererProcesses, DrawAMeshInEveryDecompositionAsItIsDefined) {
    expectEveryDecompositionRight("ball.eym");
}

}  // namespace
}  // namespace eyrie
