// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/seen_triangles.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderer/draw/ball_of_blocks.h"

namespace eyrie::draw {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;

/// A ball of one node, looked at from somewhere.
class SeenTrianglesTest : public testing::Test {
protected:
    double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
    lod::View randomView() {
        fabric::Camera camera;
        camera.eye = fabric::Vec3(unit(), unit(), unit()) * 3.0;
        camera.target = fabric::Vec3(unit(), unit(), unit());
        camera.fovYDegrees = 60 + 55 * unit();
        return {camera, kWidth, kHeight};
    }
    fabric::PixelViewport randomPart() {
        const auto below = [this](int limit) {
            return std::uniform_int_distribution<int>(0, limit - 1)(random_);
        };
        fabric::PixelViewport part{below(kWidth), below(kHeight), 0, 0};
        part.width = 1 + below(kWidth - part.x);
        part.height = 1 + below(kHeight - part.y);
        return part;
    }

    std::vector<SeenRun> runs(const lod::View& view, const fabric::PixelViewport& channel,
                              fabric::Shading shading = fabric::Shading::Smooth) const {
        const fabric::Lights lights;
        const fabric::Look look;
        const fabric::Range range;
        const lod::ObjectView objectView(view, fabric::Mat4(1));
        const FrameState frame{view, lights, shading, look, range, channel, channel};
        return seenRuns(ball_.blocks(), ball_.lattice(), SeenBoxes(objectView, frame));
    }

    fabric::Vec3 corner(std::size_t index) const { return ball_.corner(index); }
    std::size_t indices() const { return ball_.indices(); }

    std::mt19937 random_{3};

private:
    BallOfBlocks ball_;
};

std::size_t countOf(const std::vector<SeenRun>& runs) {
    std::size_t count = 0;
    for (const SeenRun& run : runs) count += static_cast<std::size_t>(run.end - run.first);
    return count;
}

/// Projected on its own.
bool isOn(const fabric::PixelViewport& channel, const lod::ObjectView& view,
          const fabric::Vec3& point) {
    const fabric::Vec3 p(view.viewFromObject() * fabric::Vec4(point, 1));
    if (-p.z < fabric::kNearMetres)
        return false;
    const lod::View& v = view.view();
    const double x = (p.x / -p.z - v.frustum.left) * v.focalPixels.x;
    const double y = (p.y / -p.z - v.frustum.bottom) * v.focalPixels.y;
    return x >= channel.x && x <= channel.x + channel.width && y >= channel.y &&
           y <= channel.y + channel.height;
}

TEST_F(SeenTrianglesTest, WhatIsLeftOutIsNotOnTheChannel) {
    std::size_t left = 0;
    for (int i = 0; i < 200; ++i) {
        const lod::View view = randomView();
        const fabric::PixelViewport channel = randomPart();
        const lod::ObjectView objectView(view, fabric::Mat4(1));
        std::vector<bool> isSeen(indices(), false);
        for (const SeenRun& run : runs(view, channel))
            std::fill(isSeen.begin() + run.first, isSeen.begin() + run.end, true);
        for (std::size_t t = 0; t < indices(); t += 3) {
            if (isSeen[t])
                continue;
            ++left;
            for (const auto& [a, b] : {std::pair(0.0, 0.0), {1, 0}, {0, 1}, {0.3, 0.3}, {0.5, 0}})
                ASSERT_FALSE(isOn(
                    channel, objectView,
                    corner(t) + a * (corner(t + 1) - corner(t)) + b * (corner(t + 2) - corner(t))))
                    << "view " << i << ", triangle " << t / 3;
        }
    }
    EXPECT_GT(left, 100000U);
}

TEST_F(SeenTrianglesTest, HalvesOfAPictureShareOnlyBlocksAtTheirBorder) {
    fabric::Camera camera;
    camera.eye = {0, -4, 0};
    camera.target = {0, 0, 0};
    const lod::View view(camera, kWidth, kHeight);
    const auto seenOf = [&](const fabric::PixelViewport& channel) {
        return countOf(runs(view, channel));
    };
    EXPECT_EQ(seenOf({0, 0, kWidth, kHeight}), indices());
    const std::size_t sides =
        seenOf({0, 0, kWidth / 2, kHeight}) + seenOf({kWidth / 2, 0, kWidth / 2, kHeight});
    const std::size_t ends =
        seenOf({0, 0, kWidth, kHeight / 2}) + seenOf({0, kHeight / 2, kWidth, kHeight / 2});
    for (const std::size_t both : {sides, ends}) {
        EXPECT_GT(both, indices());
        EXPECT_LT(both, indices() * 4 / 3);
    }
}

TEST_F(SeenTrianglesTest, OfWireframesAllAre) {
    EXPECT_EQ(countOf(runs(randomView(), {0, 0, 1, 1}, fabric::Shading::Wireframe)), indices());
}

}  // namespace
}  // namespace eyrie::draw
