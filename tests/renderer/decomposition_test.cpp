// SPDX-License-Identifier: Apache-2.0
// One renderer, one process: every decomposition must give the picture of the single channel.
#include <cstdlib>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/memory_limit.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

using fabric::ChannelTask;
using fabric::FrameData;
using fabric::Image;
using fabric::PixelViewport;
using fabric::Range;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr PixelViewport kView{0, 0, kWidth, kHeight};
constexpr unsigned kSeed = 20261121;

/// Cameras around and close above the scene, the same ones in every run.
FrameData randomFrame(std::mt19937& random, const fabric::Box& bounds) {
    const auto in = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const fabric::Vec3 size = bounds.size();
    FrameData frame;
    frame.version = 1;
    frame.camera.target =
        bounds.min + size * fabric::Vec3(in(0.2, 0.8), in(0.2, 0.8), in(0.2, 0.8));
    const double azimuth = in(0, 6.283);
    const double height = in(0.1, 1.2);
    frame.camera.eye = frame.camera.target + glm::length(size) * in(0.15, 1.2) *
                                                 fabric::Vec3(std::cos(azimuth) * std::cos(height),
                                                              std::sin(azimuth) * std::cos(height),
                                                              std::sin(height));
    frame.camera.fovYDegrees = in(20, 80);
    return frame;
}

ChannelTask wholeView() {
    ChannelTask task;
    task.frameDataVersion = 1;
    task.viewWidth = kWidth;
    task.viewHeight = kHeight;
    task.pixelViewport = kView;
    task.wantsDepth = true;
    return task;
}

class DecompositionTest : public testing::TestWithParam<test::SampleKind> {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        auto scene = test::sampleScene(GetParam());
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        auto info = renderer_->openScene(scene_);
        ASSERT_TRUE(info.ok()) << info.status();
        info_ = *info;
    }

    Image draw(const FrameData& frame, const ChannelTask& task) {
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        return result.ok() ? std::move(result->image) : Image{};
    }

    Image blank() const { return fabric::makeImage(kView, scene_.background, true); }

    Image single(const FrameData& frame) {
        Image whole = blank();
        fabric::paste(draw(frame, wholeView()), whole);
        return whole;
    }

    Image sortFirst(const FrameData& frame, int count) {
        Image whole = blank();
        for (const PixelViewport& part : fabric::split(kView, fabric::equalCuts(count))) {
            ChannelTask task = wholeView();
            task.pixelViewport = part;
            fabric::paste(draw(frame, task), whole);
        }
        return whole;
    }

    Image sortLast(const FrameData& frame, int count) {
        Image whole = blank();
        for (const Range& range : fabric::split(Range{}, fabric::equalCuts(count))) {
            ChannelTask task = wholeView();
            task.range = range;
            fabric::mergeDepth(draw(frame, task), whole);
        }
        return whole;
    }

    static void expectEqual(const Image& expected, const Image& actual, const std::string& what) {
        std::size_t different = 0;
        for (std::size_t i = 0; i < expected.colour.size(); ++i)
            different +=
                expected.colour[i] == actual.colour[i] && expected.depth[i] == actual.depth[i] ? 0
                                                                                               : 1;
        EXPECT_EQ(different, 0U) << what << " differs in so many pixels of "
                                 << expected.colour.size();
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
    fabric::SceneInfo info_;
};

TEST_P(DecompositionTest, EveryDecompositionEqualsTheSingleChannelAtTwentyCameras) {
    std::mt19937 random(kSeed);
    std::size_t covered = 0;
    for (int camera = 0; camera < 20; ++camera) {
        const FrameData frame = randomFrame(random, info_.bounds);
        const Image expected = single(frame);
        for (const float depth : expected.depth) covered += depth > 0 ? 1 : 0;
        const std::string name = "camera " + std::to_string(camera) + ", ";
        expectEqual(expected, sortFirst(frame, 2), name + "2D over 2");
        expectEqual(expected, sortFirst(frame, 4), name + "2D over 4");
        expectEqual(expected, sortLast(frame, 2), name + "DB over 2");
        expectEqual(expected, sortLast(frame, 3), name + "DB over 3");
        expectEqual(expected, single(frame), name + "drawn again");
    }
    EXPECT_GT(covered, 20U * kWidth * kHeight / 10) << "the cameras should see something";
}

TEST_P(DecompositionTest, AViewThatTheDeviceHasNoMemoryForFailsAlone) {
    std::mt19937 random(kSeed);
    const FrameData frame = randomFrame(random, info_.bounds);
    const Image expected = single(frame);
    {
        const test::MemoryLimit limit(rlim_t{512} << 20);
        ChannelTask large = wholeView();
        large.viewWidth = large.viewHeight = fabric::kMaxViewPixels;
        large.pixelViewport = {0, 0, 16, 16};
        const absl::Status status = renderer_->render(frame, large).status();
        // A GPU has memory of its own, which may be enough.
        EXPECT_TRUE(absl::IsResourceExhausted(status) ||
                    (status.ok() && !renderer_->device().software))
            << status;
    }
    for (int again = 0; again < 3; ++again) expectEqual(expected, single(frame), "afterwards");
}

/// Half of what the view takes as asked for: every channel comes to the same tau.
TEST_P(DecompositionTest, ABudgetGivesThePictureOfTheTauThatItReports) {
    std::mt19937 random(kSeed);
    int raised = 0;
    for (int camera = 0; camera < 4; ++camera) {
        FrameData frame = randomFrame(random, info_.bounds);
        frame.tauPixels = 0.5;
        frame.budget = fabric::FrameBudget{33, 3, 0, 0};
        const auto unlimited = renderer_->render(frame, wholeView());
        ASSERT_TRUE(unlimited.ok()) << unlimited.status();
        ASSERT_EQ(unlimited->statistics.budget->tauPixels, 0.5);
        const auto triangles = static_cast<double>(unlimited->statistics.budget->triangles);
        ASSERT_GE(triangles, static_cast<double>(unlimited->statistics.triangles) / 2);
        frame.budget->millisecondsATriangle = 60 / triangles;
        const auto limited = renderer_->render(frame, wholeView());
        ASSERT_TRUE(limited.ok()) << limited.status();
        const fabric::FrameStatistics& statistics = limited->statistics;
        EXPECT_EQ(statistics.tauAskedPixels, 0.5);
        EXPECT_EQ(statistics.budget->milliseconds, 33);
        raised += statistics.budget->tauPixels > 0.5 && statistics.budget->isMet() ? 1 : 0;

        const std::string name = "camera " + std::to_string(camera) + ", ";
        const Image asOne = single(frame);
        FrameData atTau = frame;
        atTau.budget.reset();
        atTau.tauPixels = statistics.budget->tauPixels;
        const auto told = renderer_->render(atTau, wholeView());
        ASSERT_TRUE(told.ok()) << told.status();
        EXPECT_EQ(statistics.tauAchievedPixels, told->statistics.tauAchievedPixels) << name;
        EXPECT_EQ(statistics.triangles, told->statistics.triangles) << name;
        expectEqual(single(atTau), asOne, name + "that tau");
        expectEqual(asOne, sortFirst(frame, 3), name + "2D over 3");
        expectEqual(asOne, sortLast(frame, 3), name + "DB over 3");
    }
    EXPECT_GE(raised, 2);
}

TEST_P(DecompositionTest, MeasuringStagesLeavesThePictureAsItIs) {
    std::mt19937 random(kSeed);
    const FrameData frame = randomFrame(random, info_.bounds);
    const Image expected = single(frame);
    ChannelTask task = wholeView();
    task.measuresStages = true;
    const auto measured = renderer_->render(frame, task);
    ASSERT_TRUE(measured.ok()) << measured.status();
    const fabric::StageMilliseconds& ms = measured->statistics.milliseconds;
    EXPECT_GT(ms.vertices, 0);
    EXPECT_DOUBLE_EQ(ms.vertices + ms.fill, ms.draw);
    Image whole = blank();
    fabric::paste(measured->image, whole);
    expectEqual(expected, whole, "measured");
    expectEqual(expected, single(frame), "drawn after it");
}

struct NamedLook {
    const char* name;
    fabric::Look look;
    fabric::Shading shading = fabric::Shading::Smooth;
};

std::vector<NamedLook> looks(const fabric::Camera& frozen) {
    fabric::TransferFunction boxes;
    boxes.primitives = {{fabric::PrimitiveShape::Box, 0.2, 0.1, {0.8, 0.1, 0.1}, 0.7},
                        {fabric::PrimitiveShape::Smooth, 0.6, 0.4, {0.2, 0.4, 0.9}, 1}};
    return {
        {"transfer function and contours",
         {.transfer = boxes, .contours = fabric::ContourLines{20, 1.5}}},
        {"adjusted", {.slopeShading = 0.2, .saturation = 1.7, .levelTint = true}},
        {"wireframe", {}, fabric::Shading::Wireframe},
        {"bounds", {.tileBounds = true, .pageBounds = true}},
        {"bounds of a wireframe, upside down",
         {.exaggeration = -1, .tileBounds = true, .pageBounds = true},
         fabric::Shading::Wireframe},
        {"flat", {.exaggeration = 0, .contours = fabric::ContourLines{50, 2}}},
        {"thin", {.exaggeration = 1e-3}},
        {"steep, one normal a triangle", {.exaggeration = 10}, fabric::Shading::Flat},
        {"very steep", {.exaggeration = 100}},
        {"frozen", {.tileBounds = true, .pageBounds = true, .cutCamera = frozen}},
    };
}

TEST_P(DecompositionTest, EveryLookDecomposesAlike) {
    std::mt19937 random(kSeed);
    const fabric::Camera frozen = randomFrame(random, info_.bounds).camera;
    for (const NamedLook& one : looks(frozen)) {
        FrameData frame = randomFrame(random, info_.bounds);
        frame.look = one.look;
        frame.shading = one.shading;
        const Image expected = single(frame);
        expectEqual(expected, sortFirst(frame, 3), std::string(one.name) + ", 2D over 3");
        expectEqual(expected, sortLast(frame, 3), std::string(one.name) + ", DB over 3");
    }
}

/// Tiles are off-axis views: each has its own part of the one frustum. Expected is the picture that
/// is drawn at once.
TEST(Poster, InTilesOf512PixelsIsTheOnePictureToTheBit) {
    constexpr PixelViewport kPoster{0, 0, 2048, 1152};
    const auto renderer = test::makeRenderer();
    const auto scene = test::sampleScene(test::SampleKind::Both);
    ASSERT_TRUE(scene.ok()) << scene.status();
    const auto info = renderer->openScene(*scene);
    ASSERT_TRUE(info.ok()) << info.status();
    std::mt19937 random(kSeed);
    ChannelTask task = wholeView();
    task.viewWidth = kPoster.width;
    task.viewHeight = kPoster.height;
    const auto drawn = [&](const FrameData& frame, const PixelViewport& part, Image& into) {
        task.pixelViewport = part;
        const auto result = renderer->render(frame, task);
        ASSERT_TRUE(result.ok()) << result.status();
        fabric::paste(result->image, into);
    };
    for (const double fovYDegrees : {1.0, 45.0, 170.0}) {
        FrameData frame = randomFrame(random, info->bounds);
        frame.camera.fovYDegrees = fovYDegrees;
        if (fovYDegrees > 90)  // from among what is drawn
            frame.camera.eye += 0.9 * (frame.camera.target - frame.camera.eye);
        Image whole = fabric::makeImage(kPoster, scene->background, true);
        Image poster = whole;
        drawn(frame, kPoster, whole);
        for (int y = 0; y < kPoster.height; y += 512)
            for (int x = 0; x < kPoster.width; x += 512)
                drawn(frame, intersection({x, y, 512, 512}, kPoster), poster);
        std::size_t covered = 0, different = 0;
        for (std::size_t i = 0; i < whole.depth.size(); ++i) {
            covered += whole.depth[i] > 0 ? 1 : 0;
            different +=
                whole.depth[i] != poster.depth[i] || whole.colour[i] != poster.colour[i] ? 1 : 0;
        }
        EXPECT_EQ(different, 0U) << fovYDegrees;
        EXPECT_GT(covered, whole.depth.size() / 20) << fovYDegrees;
    }
}

/// Expected is the same renderer's, and another's, picture.
TEST(HardCase28, PicturesAreTheSameForAnyNumberOfLoaderThreadsAndAgain) {
    const auto scene = test::sampleScene(test::SampleKind::Both);
    ASSERT_TRUE(scene.ok()) << scene.status();
    std::vector<Image> first;
    for (const int threads : {1, 8}) {
        RendererOptions options;
        options.loaderThreads = threads;
        auto renderer = Renderer::create(options);
        ASSERT_TRUE(renderer.ok()) << renderer.status();
        const auto info = (*renderer)->openScene(*scene);
        ASSERT_TRUE(info.ok()) << info.status();
        std::mt19937 random(kSeed);
        for (std::size_t i = 0; i < 4; ++i) {
            const FrameData frame = randomFrame(random, info->bounds);
            for (int again = 0; again < 2; ++again) {
                const auto result = (*renderer)->render(frame, wholeView());
                ASSERT_TRUE(result.ok()) << result.status();
                if (first.size() == i)
                    first.push_back(result->image);
                EXPECT_TRUE(result->image == first[i]) << threads << " threads, picture " << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DecompositionTest,
                         testing::Values(test::SampleKind::Mesh, test::SampleKind::Terrain,
                                         test::SampleKind::Both),
                         [](const auto& suite) { return test::name(suite.param); });

}  // namespace
}  // namespace eyrie
