// SPDX-License-Identifier: Apache-2.0
// Pictures through walls and of rasters, against each other. What they show is held against their
// sources in integration/sight_truth_test.cpp.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/renderer.h"
#include "tests/renderer/lod/wall.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

using fabric::ChannelTask;
using fabric::FrameData;
using fabric::Image;
using fabric::PixelViewport;
using fabric::Raster;
using fabric::Vec3;

constexpr int kWidth = 640;
constexpr int kHeight = 361;  // no multiple of anything
constexpr PixelViewport kView{0, 0, kWidth, kHeight};

class SightDraw : public testing::TestWithParam<test::SampleKind> {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        auto scene = test::sampleScene(GetParam());
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
        const auto info = renderer_->openScene(scene_);
        ASSERT_TRUE(info.ok()) << info.status();
        bounds_ = info->bounds;
    }

    /// In a room before the scene.
    FrameData anyFrame() {
        FrameData frame;
        frame.version = 1;
        frame.camera.target = bounds_.centre();
        Vec3 side = dice_.direction();
        side.z = std::abs(side.z) + 0.2;
        frame.camera.eye = frame.camera.target + glm::length(bounds_.size()) * 0.7 * side;
        return frame;
    }

    ChannelTask straightAhead() const {
        ChannelTask task;
        task.frameDataVersion = 1;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = kView;
        task.wantsDepth = true;
        return task;
    }

    ChannelTask throughAWall() {
        ChannelTask task = straightAhead();
        task.sight = test::sightThrough(test::randomWall(dice_), test::randomEye(dice_));
        return task;
    }

    Image draw(const FrameData& frame, const ChannelTask& task) {
        const auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        Image whole = fabric::makeImage(fabric::pictureOf(task), scene_.background, true);
        if (result.ok())
            fabric::paste(result->image, whole);
        return whole;
    }

    /// Put together of `columns` x `rows` pictures, each of every so manieth column and row.
    Image interleaved(const FrameData& frame, ChannelTask task, int columns, int rows) {
        Image whole = fabric::makeImage(kView, scene_.background, true);
        for (int cy = 0; cy < rows; ++cy)
            for (int cx = 0; cx < columns; ++cx) {
                const Raster raster{(kWidth - cx + columns - 1) / columns,
                                    (kHeight - cy + rows - 1) / rows,
                                    {cx + 0.5 - columns / 2.0, cy + 0.5 - rows / 2.0},
                                    {columns, rows}};
                task.raster = raster;
                task.pixelViewport = fabric::pictureOf(task);
                const Image part = draw(frame, task);
                for (int y = 0; y < raster.height; ++y)
                    for (int x = 0; x < raster.width; ++x) {
                        const auto from = static_cast<std::size_t>(y * raster.width + x);
                        const auto to =
                            static_cast<std::size_t>((y * rows + cy) * kWidth + x * columns + cx);
                        whole.colour[to] = part.colour[from];
                        whole.depth[to] = part.depth[from];
                    }
            }
        return whole;
    }

    static void expectEqual(const Image& expected, const Image& actual, const std::string& what) {
        EXPECT_TRUE(expected == actual) << what;
    }

    test::Dice dice_{20261122};
    std::unique_ptr<Renderer> renderer_;
    fabric::Scene scene_;
    fabric::Box bounds_;
};

TEST_P(SightDraw, PartsOfAViewThroughAWallAreTheWholeToTheBit) {
    std::size_t covered = 0;
    for (int i = 0; i < 5; ++i) {
        const FrameData frame = anyFrame();
        ChannelTask task = throughAWall();
        const Image whole = draw(frame, task);
        for (const float depth : whole.depth) covered += depth > 0 ? 1 : 0;
        Image sortFirst = fabric::makeImage(kView, scene_.background, true);
        Image sortLast = sortFirst;
        for (const PixelViewport& part : fabric::split(kView, fabric::equalCuts(3))) {
            task.pixelViewport = part;
            fabric::paste(renderer_->render(frame, task)->image, sortFirst);
        }
        task.pixelViewport = kView;
        for (const fabric::Range& range : fabric::split(fabric::Range{}, fabric::equalCuts(3))) {
            task.range = range;
            fabric::mergeDepth(renderer_->render(frame, task)->image, sortLast);
        }
        expectEqual(whole, sortFirst, fmt::format("2D over 3, {}", i));
        expectEqual(whole, sortLast, fmt::format("DB over 3, {}", i));
    }
    EXPECT_GT(covered, 5U * kWidth * kHeight / 10) << "the walls should show something";
}

TEST_P(SightDraw, TheRasterOfTheViewsOwnPixelsChangesNothing) {
    for (int i = 0; i < 4; ++i) {
        const FrameData frame = anyFrame();
        ChannelTask task = i % 2 == 0 ? straightAhead() : throughAWall();
        const auto without = renderer_->render(frame, task);
        task.raster = Raster{kWidth, kHeight, {0, 0}, {1, 1}};
        const auto with = renderer_->render(frame, task);
        ASSERT_TRUE(without.ok() && with.ok());
        expectEqual(without->image, with->image, fmt::format("{}", i));
        EXPECT_EQ(without->statistics.tauAchievedPixels, with->statistics.tauAchievedPixels);
        EXPECT_EQ(without->statistics.triangles, with->statistics.triangles);
    }
}

/// Edges fall differently where corners are rounded to a part of another pixel, and a surface's
/// depth and colour are other roundings: those of up to one in 20,000 pixels were
/// seen to show.
TEST_P(SightDraw, InterleavedRastersAreTheOnePictureButForEdges) {
    for (const auto& [columns, rows] : {std::pair(2, 1), std::pair(3, 2)}) {
        const FrameData frame = anyFrame();
        const ChannelTask task = columns == 2 ? straightAhead() : throughAWall();
        const Image whole = draw(frame, task);
        const Image parts = interleaved(frame, task, columns, rows);
        std::size_t covered = 0, other = 0, anyDifference = 0;
        for (std::size_t i = 0; i < whole.colour.size(); ++i) {
            const auto apart = [](std::uint8_t a, std::uint8_t b) { return std::abs(a - b); };
            const fabric::Rgba &a = whole.colour[i], &b = parts.colour[i];
            const int difference = std::max({apart(a.r, b.r), apart(a.g, b.g), apart(a.b, b.b)});
            const double depth = std::max(whole.depth[i], parts.depth[i]);
            covered += whole.depth[i] > 0 ? 1 : 0;
            anyDifference += difference > 0 ? 1 : 0;
            other +=
                difference > 4 || std::abs(whole.depth[i] - parts.depth[i]) > 0.01 * depth ? 1 : 0;
        }
        fmt::print("{} x {}: {} of {} covered pixels show something else, {} another colour\n",
                   columns, rows, other, covered, anyDifference);
        EXPECT_GT(covered, whole.colour.size() / 10);
        EXPECT_LE(other, covered / 5000) << columns << " x " << rows;
    }
}

TEST_P(SightDraw, WhatIsLeftOutBecauseItIsHiddenChangesNothing) {
    ChannelTask task = throughAWall();
    task.raster = Raster{kWidth / 2, kHeight / 2, {0.3, -0.4}, {2, 2}};
    task.pixelViewport = fabric::pictureOf(task);
    FrameData frame = anyFrame();
    for (int i = 0; i < 6; ++i) {
        frame.camera.eye += (frame.camera.target - frame.camera.eye) * 0.1;
        frame.occlusion = fabric::Occlusion::Off;
        const Image all = draw(frame, task);
        frame.occlusion = fabric::Occlusion::On;
        expectEqual(all, draw(frame, task), fmt::format("{}", i));
    }
}

/// A light that the camera carries shines alike on what two walls show.
TEST_P(SightDraw, WallsOfOneRoomAreLitAlike) {
    const FrameData frame = anyFrame();
    const fabric::Frustum frustum{-0.8, 0.8, -0.45, 0.45};
    const fabric::Mat3 turn(glm::rotate(fabric::Mat4(1.0), 0.5, Vec3(0.1, 0.9, 0.2)));
    ChannelTask task = straightAhead();
    task.sight = fabric::Sight{{}, fabric::Mat3(1.0), frustum};
    const Image ahead = draw(frame, task);
    task.sight->viewFromCamera = turn;
    const Image aside = draw(frame, task);
    std::vector<int> differences;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Vec3 way = glm::transpose(turn) * Vec3(1.6 * (x + 0.5) / kWidth - 0.8,
                                                         0.9 * (y + 0.5) / kHeight - 0.45, -1);
            const int u = static_cast<int>((way.x / -way.z + 0.8) / 1.6 * kWidth);
            const int v = static_cast<int>((way.y / -way.z + 0.45) / 0.9 * kHeight);
            if (way.z >= 0 || u < 0 || v < 0 || u >= kWidth || v >= kHeight)
                continue;
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            const auto k = static_cast<std::size_t>(v * kWidth + u);
            if (aside.depth[i] > 0 && ahead.depth[k] > 0)
                differences.push_back(std::abs(aside.colour[i].g - ahead.colour[k].g));
        }
    ASSERT_GT(differences.size(), 2000U);
    std::nth_element(differences.begin(),
                     differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2),
                     differences.end());
    EXPECT_LE(differences[differences.size() / 2], 4);
}

/// In pixels of the view.
TEST_P(SightDraw, ContourLinesAreAsWideInARasterAsInItsView) {
    const FrameData plain = anyFrame();
    FrameData contoured = plain;
    contoured.look.contours = fabric::ContourLines{bounds_.size().z / 6, 4};
    ChannelTask task = straightAhead();
    const auto meanDarkening = [&] {
        const Image lines = draw(contoured, task);
        const Image none = draw(plain, task);
        double darker = 0;
        for (std::size_t i = 0; i < lines.colour.size(); ++i)
            darker += none.colour[i].g - lines.colour[i].g;
        return darker / static_cast<double>(lines.colour.size());
    };
    const double inView = meanDarkening();
    task.raster = Raster{kWidth / 3, kHeight / 3, {0, 0}, {3, 3}};
    task.pixelViewport = fabric::pictureOf(task);
    const double inRaster = meanDarkening();
    EXPECT_GT(inView, 0.5);
    EXPECT_NEAR(inRaster / inView, 1, 0.1);
}

TEST_P(SightDraw, RefusesWhatCannotBeDrawn) {
    const FrameData frame = anyFrame();
    ChannelTask task = straightAhead();
    task.raster = Raster{kWidth / 2, kHeight, {0, 0}, {2, 1}};
    EXPECT_EQ(renderer_->render(frame, task).status().code(), absl::StatusCode::kInvalidArgument)
        << "the pixel viewport is the view's";
    task.pixelViewport = fabric::pictureOf(task);
    EXPECT_TRUE(renderer_->render(frame, task).ok());
    task.raster->step.x = 3;
    EXPECT_EQ(renderer_->render(frame, task).status().code(), absl::StatusCode::kInvalidArgument);
    task.raster.reset();
    task.pixelViewport = kView;
    task.sight = fabric::Sight{{}, fabric::Mat3(2.0), {}};
    EXPECT_EQ(renderer_->render(frame, task).status().code(), absl::StatusCode::kInvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SightDraw,
                         testing::Values(test::SampleKind::Terrain, test::SampleKind::Both),
                         [](const auto& suite) { return test::name(suite.param); });

}  // namespace
}  // namespace eyrie
