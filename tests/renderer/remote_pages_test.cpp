// SPDX-License-Identifier: Apache-2.0
// Terrain and meshes at URLs, drawn while its server does what it should not.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "fabric/log.h"
#include "renderer/gl/debug_output.h"
#include "renderer/import/mesh_import.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/image_codec.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/page_server.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using fabric::ChannelResult;
using fabric::Completeness;
using std::chrono::seconds;
using std::chrono::steady_clock;
using test::Mood;

constexpr int kWidth = 320;
constexpr int kHeight = 180;

std::string textOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

class RemotePages : public testing::TestWithParam<Mood> {
protected:
    void SetUp() override {
        setenv("GDAL_HTTP_LOW_SPEED_TIME", "1", 1);
        setenv("GDAL_HTTP_CONNECTTIMEOUT", "1", 1);
        spdlog::set_level(spdlog::level::err);
        gl::setOnGlError(gl::OnGlError::Abort);
        auto scene = test::sampleScene(test::SampleKind::Terrain);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        server_ = std::make_unique<test::PageServer>(textOf(scene_.objects[0].path));
    }

    std::unique_ptr<Renderer> open(const std::string& path, bool isCached = true) {
        RendererOptions options;
        if (isCached)
            options.remote.cacheFolder = folder_.path() / "cache";
        auto renderer = Renderer::create(options);
        EXPECT_TRUE(renderer.ok()) << renderer.status();
        fabric::Scene scene = scene_;
        scene.objects[0].path = path;
        const auto info = (*renderer)->openScene(scene);
        EXPECT_TRUE(info.ok()) << info.status();
        bounds_ = info.ok() ? info->bounds : fabric::Box();
        return *std::move(renderer);
    }
    std::string url() const { return server_->url("terrain.eyt"); }

    ChannelResult draw(Renderer& renderer, Completeness completeness) const {
        fabric::FrameData frame;
        frame.camera.target = bounds_.centre();
        frame.camera.eye = frame.camera.target + fabric::Vec3(100, 200, 3000);
        frame.camera.up = {0, 1, 0};
        frame.tauPixels = 0.25;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.wantsDepth = true;
        task.completeness = completeness;
        auto result = renderer.render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? *std::move(result) : ChannelResult();
    }

    static void expectEqual(const ChannelResult& a, const ChannelResult& b) {
        EXPECT_TRUE(a.image.depth == b.image.depth);
        EXPECT_TRUE(a.image.colour == b.image.colour);
        EXPECT_EQ(a.statistics.tauAchievedPixels, b.statistics.tauAchievedPixels);
    }

    static std::size_t uncovered(const ChannelResult& result) {
        return static_cast<std::size_t>(std::count_if(result.image.depth.begin(),
                                                      result.image.depth.end(),
                                                      [](float depth) { return depth <= 0; }));
    }

    fabric::Scene scene_;
    fabric::Box bounds_;
    test::TemporaryFolder folder_;
    std::unique_ptr<test::PageServer> server_;
};

TEST_F(RemotePages, MakeTheLocalPicture) {
    const ChannelResult local = draw(*open(scene_.objects[0].path), Completeness::Complete);
    EXPECT_TRUE(local.statistics.complete);
    const ChannelResult remote = draw(*open(url()), Completeness::Complete);
    EXPECT_TRUE(remote.statistics.complete);
    expectEqual(local, remote);
    const int before = server_->gets();
    expectEqual(local, draw(*open(url()), Completeness::Complete));
    EXPECT_EQ(server_->gets(), before + 1) << "the second renderer asks for the header alone";
}

double inMilliseconds(steady_clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

/// Which share of all the time was spent in frames that took more than `limit`.
double shareOfSlow(const std::vector<double>& milliseconds, double limit) {
    double all = 0;
    double slow = 0;
    for (const double time : milliseconds) {
        all += time;
        slow += time > limit ? time : 0;
    }
    return slow / all;
}

TEST_P(RemotePages, ThatDoNotComeNeitherStallAFrameNorLeaveAHoleAndHeal) {
    const ChannelResult local = draw(*open(scene_.objects[0].path), Completeness::Complete);
    ASSERT_EQ(uncovered(local), 0U) << "the test wants terrain everywhere";
    const auto renderer = open(url(), false);
    server_->set(GetParam());
    const auto end = steady_clock::now() + seconds(3);
    std::vector<double> times;
    while (steady_clock::now() < end) {
        const auto begin = steady_clock::now();
        const ChannelResult result = draw(*renderer, Completeness::Interactive);
        times.push_back(inMilliseconds(steady_clock::now() - begin));
        EXPECT_EQ(uncovered(result), 0U);
        EXPECT_FALSE(result.statistics.complete);
        EXPECT_GT(result.statistics.pagesMissing, 0U);
        EXPECT_GT(result.statistics.tauAchievedPixels, local.statistics.tauAchievedPixels);
    }
    // Far less than the second that a request waits for.
    EXPECT_LT(*std::max_element(times.begin(), times.end()), 700);
    EXPECT_GE(draw(*renderer, Completeness::Interactive).statistics.pagesFailed, 1U);
    const auto begin = steady_clock::now();
    EXPECT_EQ(uncovered(draw(*renderer, Completeness::Complete)), 0U);
    EXPECT_LT(steady_clock::now() - begin, seconds(8)) << "a complete frame gives up, too";

    server_->set(Mood::Good);
    const auto deadline = steady_clock::now() + seconds(30);
    ChannelResult healed;
    while (!healed.statistics.complete || healed.image.depth.empty()) {
        ASSERT_LT(steady_clock::now(), deadline) << "the server is back";
        healed = draw(*renderer, Completeness::Interactive);
    }
    expectEqual(local, healed);

    // Frames that waited for the server took longer than those of a good one, which draw more. A
    // busy machine makes a few of them slow, too.
    std::vector<double> goodTimes(30);
    for (double& time : goodTimes) {
        const auto start = steady_clock::now();
        draw(*renderer, Completeness::Interactive);
        time = inMilliseconds(steady_clock::now() - start);
    }
    std::sort(goodTimes.begin(), goodTimes.end());
    EXPECT_LT(shareOfSlow(times, 3 * goodTimes[goodTimes.size() / 2] + 50), 0.4);
}

INSTANTIATE_TEST_SUITE_P(Moods, RemotePages,
                         testing::Values(Mood::Stalls, Mood::NotFound, Mood::ServerError,
                                         Mood::ClosesMidway));

TEST_F(RemotePages, OfAServerThatIsBusyForAMomentAreWaitedFor) {
    const auto renderer = open(url(), false);
    server_->set(Mood::Busy);
    std::thread recovery([this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        server_->set(Mood::Good);
    });
    const ChannelResult result = draw(*renderer, Completeness::Complete);
    recovery.join();
    EXPECT_TRUE(result.statistics.complete);
}

TEST_F(RemotePages, OfAServerThatIsDownKeepTheSceneFromOpening) {
    server_->set(Mood::HangsUp);
    auto renderer = Renderer::create({});
    ASSERT_TRUE(renderer.ok());
    fabric::Scene scene = scene_;
    scene.objects[0].path = url();
    const absl::Status status = (*renderer)->openScene(scene).status();
    EXPECT_TRUE(absl::IsUnavailable(status)) << status;
    EXPECT_NE(status.ToString().find(url()), std::string::npos);
}

/// Textures are read when the scene opens, and not again.
TEST_F(RemotePages, OfATextureThatDoNotComeKeepTheSceneFromOpening) {
    import::TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.textureCoordinates = {{0, 1}, {1, 1}, {0, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.materials = {{.image = 0}};
    mesh.materialOf = {0, 0, 0};
    mesh.images = {
        mesh::encodeImage({512, 512, 0}, std::vector<fabric::Rgba>(512 * 512, {9, 99, 199, 255}))};
    const std::string path = folder_.path("sheet.eym");
    ASSERT_TRUE(import::importMesh(std::move(mesh), path).ok());
    const auto file = mesh::EymFile::open(path);
    ASSERT_TRUE(file.ok()) << file.status();
    ASSERT_EQ(file->images().size(), 1U);
    const mesh::ImageRecord& image = file->images()[0];
    server_->setContent(textOf(path));
    server_->refuseOnce(static_cast<std::int64_t>(image.offset + image.bytes / 2));

    auto renderer = Renderer::create({});
    ASSERT_TRUE(renderer.ok());
    fabric::Scene scene;
    scene.objects.push_back(
        {.name = "sheet", .kind = fabric::ObjectKind::Mesh, .path = server_->url("sheet.eym")});
    const absl::Status status = (*renderer)->openScene(scene).status();
    EXPECT_TRUE(absl::IsUnavailable(status)) << status;
    EXPECT_NE(status.ToString().find("image 0"), std::string::npos) << status;
    const auto again = (*renderer)->openScene(scene);
    EXPECT_TRUE(again.ok()) << again.status();
}

}  // namespace
}  // namespace eyrie
