// SPDX-License-Identifier: Apache-2.0
// What a look changes in a picture, and what it leaves alone.
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "fabric/frustum.h"
#include "fabric/look.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"
#include "tests/support/renderer.h"

namespace eyrie {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;

class TerrainLookTest : public testing::Test {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        ASSERT_NO_FATAL_FAILURE(open(fabric::Mat4(1.0)));
    }

    void open(const fabric::Mat4& worldFromTerrain, const fabric::Vec3& light = {0.4, 0.5, -0.8}) {
        auto scene = test::sampleScene(test::SampleKind::Terrain);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene->objects.front().worldFromObject = worldFromTerrain;
        scene->lights = {{.direction = light}};
        auto info = renderer_->openScene(*scene);
        ASSERT_TRUE(info.ok()) << info.status();
        info_ = *info;
        background_ = scene->background;
    }

    /// From the south-west; `distance` in diagonals of the scene.
    fabric::Camera camera(double distance, double azimuth = 0.8) const {
        fabric::Camera camera;
        camera.target = info_.bounds.centre();
        camera.eye = camera.target + glm::length(info_.bounds.size()) * distance *
                                         fabric::Vec3(std::cos(azimuth), std::sin(azimuth), 0.8);
        return camera;
    }

    fabric::ChannelResult draw(const fabric::Look& look, const fabric::Camera& from,
                               fabric::Shading shading = fabric::Shading::Smooth,
                               double tauPixels = 1) {
        const fabric::FrameData frame{1, from, tauPixels, shading, look};
        fabric::ChannelTask task;
        task.frameDataVersion = 1;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.wantsDepth = true;
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        if (!result.ok())
            return {};
        fabric::ChannelResult whole{fabric::makeImage(task.pixelViewport, background_, true),
                                    result->statistics};
        fabric::paste(result->image, whole.image);
        return whole;
    }

    std::unique_ptr<Renderer> renderer_;
    fabric::SceneInfo info_;
    fabric::Rgba background_;
};

int worstDifference(const fabric::Image& a, const fabric::Image& b) {
    int worst = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i)
        worst = std::max({worst, std::abs(a.colour[i].r - b.colour[i].r),
                          std::abs(a.colour[i].g - b.colour[i].g),
                          std::abs(a.colour[i].b - b.colour[i].b)});
    return worst;
}

std::size_t differing(const fabric::Image& a, const fabric::Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) count += a.colour[i] == b.colour[i] ? 0 : 1;
    return count;
}

std::size_t covered(const fabric::Image& image) {
    return static_cast<std::size_t>(
        std::count_if(image.depth.begin(), image.depth.end(), [](float d) { return d > 0; }));
}

TEST_F(TerrainLookTest, TheBuiltInTintsAsPrimitivesShowTheSamePicture) {
    const fabric::ChannelResult builtIn = draw({}, camera(0.5));
    const fabric::ChannelResult edited =
        draw({.transfer = fabric::hypsometricTints()}, camera(0.5));
    EXPECT_EQ(builtIn.image.depth, edited.image.depth);
    EXPECT_LE(worstDifference(builtIn.image, edited.image), 2);
    EXPECT_GT(covered(builtIn.image), kWidth * kHeight / 10U);
}

TEST_F(TerrainLookTest, HeightsInMetresAndInSharesOfTheReliefShowTheSame) {
    fabric::TransferFunction relative = fabric::hypsometricTints();
    relative.primitives[2].opacity = 0.3;
    fabric::TransferFunction metres = relative;
    metres.unit = fabric::HeightUnit::Metres;
    for (fabric::TransferPrimitive& primitive : metres.primitives) {
        primitive.centre = info_.bounds.min.z + primitive.centre * info_.bounds.size().z;
        primitive.width *= info_.bounds.size().z;
    }
    EXPECT_LE(worstDifference(draw({.transfer = relative}, camera(0.5)).image,
                              draw({.transfer = metres}, camera(0.5)).image),
              1);
}

TEST_F(TerrainLookTest, OnlyColoursChangeWithColouring) {
    const fabric::ChannelResult plain = draw({}, camera(0.5));
    for (const fabric::Look& look :
         {fabric::Look{.transfer = fabric::TransferFunction{}},
          fabric::Look{.contours = fabric::ContourLines{25, 1}}, fabric::Look{.saturation = 0},
          fabric::Look{.levelTint = true}}) {
        const fabric::ChannelResult other = draw(look, camera(0.5));
        EXPECT_EQ(other.image.depth, plain.image.depth);
        EXPECT_EQ(other.statistics.triangles, plain.statistics.triangles);
        EXPECT_EQ(other.statistics.tauAchievedPixels, plain.statistics.tauAchievedPixels);
        EXPECT_GT(differing(other.image, plain.image), 1000U);
    }
}

double meanDifference(const fabric::Image& a, const fabric::Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i)
        sum += std::abs(a.colour[i].r - b.colour[i].r) + std::abs(a.colour[i].g - b.colour[i].g) +
               std::abs(a.colour[i].b - b.colour[i].b);
    return sum / 3.0 / static_cast<double>(covered(b));
}

/// All of the relief is less than a pixel high.
TEST_F(TerrainLookTest, HillsThatAreNothingButAColourAreSeen) {
    const fabric::Look flat{.exaggeration = 1e-4};
    const fabric::ChannelResult drawn = draw(flat, camera(0.8));
    const fabric::ChannelResult finest =
        draw(flat, camera(0.8), fabric::Shading::Smooth, fabric::kMinTauPixels);
    EXPECT_GT(finest.statistics.triangles, 4 * drawn.statistics.triangles);
    EXPECT_LT(meanDifference(drawn.image, finest.image), 2);
}

TEST_F(TerrainLookTest, WithoutSaturationAllIsGrey) {
    const fabric::Image image = draw({.saturation = 0}, camera(0.3)).image;
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        if (image.depth[i] > 0) {
            ASSERT_EQ(image.colour[i].r, image.colour[i].g);
            ASSERT_EQ(image.colour[i].g, image.colour[i].b);
        }
}

TEST_F(TerrainLookTest, BoundsAreLinesOverThePictureAndCountAsNothing) {
    const fabric::ChannelResult plain = draw({}, camera(0.5));
    std::size_t last = 0;
    for (const fabric::Look& look :
         {fabric::Look{.pageBounds = true}, fabric::Look{.tileBounds = true},
          fabric::Look{.tileBounds = true, .pageBounds = true}}) {
        const fabric::ChannelResult lined = draw(look, camera(0.5));
        const std::size_t lines = differing(lined.image, plain.image);
        EXPECT_GT(lines, last) << "tiles are smaller than pages";
        EXPECT_LT(lines, kWidth * kHeight / 4U);
        EXPECT_EQ(lined.statistics.nodes, plain.statistics.nodes);
        EXPECT_EQ(lined.statistics.triangles, plain.statistics.triangles);
        last = lines;
    }
}

TEST_F(TerrainLookTest, AFrozenCutKeepsItsTrianglesAndPromisesNothing) {
    const fabric::Camera frozen = camera(0.4);
    const fabric::ChannelResult there = draw({}, frozen);
    // From further back all that the frozen camera saw is in view.
    const fabric::Camera back{.eye = frozen.eye + (frozen.eye - frozen.target) * 3.0,
                              .target = frozen.target};
    for (const fabric::Camera& from : {frozen, back}) {
        const fabric::ChannelResult held = draw({.cutCamera = frozen}, from);
        EXPECT_EQ(held.statistics.triangles, there.statistics.triangles);
        EXPECT_EQ(held.statistics.nodes, there.statistics.nodes);
        EXPECT_EQ(held.statistics.tauAchievedPixels, std::numeric_limits<double>::infinity());
        EXPECT_TRUE(held.statistics.complete);
    }
    EXPECT_EQ(differing(draw({.cutCamera = frozen}, frozen).image, there.image), 0U);
    EXPECT_LT(draw({}, back).statistics.triangles, there.statistics.triangles);
}

TEST_F(TerrainLookTest, WhatIsDrawnFlatHasTheDepthOfAPlane) {
    const fabric::Camera from = camera(0.2);
    const fabric::Image image = draw({.exaggeration = 0}, from).image;
    const fabric::Mat3 worldFromView = glm::transpose(fabric::viewFromWorldRotation(from));
    const fabric::Frustum frustum =
        fabric::symmetricFrustum(from.fovYDegrees, static_cast<double>(kWidth) / kHeight);
    std::size_t seen = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float depth = image.depth[static_cast<std::size_t>(y * kWidth + x)];
            if (depth == 0)
                continue;
            ++seen;
            const fabric::Vec3 ray(glm::mix(frustum.left, frustum.right, (x + 0.5) / kWidth),
                                   glm::mix(frustum.bottom, frustum.top, (y + 0.5) / kHeight), -1);
            const double expected = -from.eye.z / (worldFromView * ray).z;
            const double found = fabric::viewDepthMetres(depth, fabric::kNearMetres);
            ASSERT_NEAR(found / expected, 1, 1e-4) << x << "," << y;
        }
    EXPECT_GT(seen, kWidth * kHeight / 10U);
}

/// Mean of what is covered.
double brightness(const fabric::Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        sum += image.depth[i] > 0 ? image.colour[i].g : 0;
    return sum / static_cast<double>(std::max<std::size_t>(covered(image), 1));
}

TEST_F(TerrainLookTest, UpsideDownIsLitFromAboveAsWell) {
    const fabric::Image upright = draw({}, camera(0.5)).image;
    fabric::Camera from = camera(0.5);
    from.eye.z -= 2 * info_.bounds.centre().z;
    from.target.z = -from.target.z;
    const fabric::Image inverted = draw({.exaggeration = -1}, from).image;
    EXPECT_GT(covered(inverted), kWidth * kHeight / 10U);
    EXPECT_NEAR(brightness(inverted) / brightness(upright), 1, 0.2);
}

/// However it is said: by the look, by the scene, or in part by either.
TEST_F(TerrainLookTest, TheSameSurfaceIsLitTheSame) {
    const auto scaled = [](double x, double y, double z) {
        return fabric::Mat4(glm::scale(fabric::Mat4(1.0), fabric::Vec3(x, y, z)));
    };
    struct Case {
        const char* name;
        fabric::Mat4 plain, other;
        double plainExaggeration, otherExaggeration;
    };
    for (const Case& c :
         {Case{"upside down by the scene", scaled(1, 1, 1), scaled(1, 1, -1), -1, 1},
          Case{"upside down twice", scaled(1, 1, 1), scaled(1, 1, -2), 2, -1},
          Case{"turned over", scaled(1, -1, 1), scaled(1, -1, -1), 1, -1},
          Case{"through a point", scaled(-1, -1, 1), scaled(-1, -1, -1), -1, 1}}) {
        ASSERT_NO_FATAL_FAILURE(open(c.plain));
        fabric::Camera from = camera(0.5);
        if (c.plainExaggeration < 0) {
            from.eye.z -= 2 * info_.bounds.centre().z;
            from.target.z = -from.target.z;
        }
        const fabric::Image plain = draw({.exaggeration = c.plainExaggeration}, from).image;
        ASSERT_NO_FATAL_FAILURE(open(c.other));
        const fabric::Image other = draw({.exaggeration = c.otherExaggeration}, from).image;
        EXPECT_GT(covered(plain), kWidth * kHeight / 10U) << c.name;
        EXPECT_EQ(differing(plain, other), 0U) << c.name;
    }
}

/// A scene and its mirror image below height 0, light, eye and all, are equally bright: of one the
/// upper side is seen, of the other the lower.
TEST_F(TerrainLookTest, TheSideThatIsSeenIsLit) {
    const auto scaled = [](double x, double y, double z) {
        return fabric::Mat4(glm::scale(fabric::Mat4(1.0), fabric::Vec3(x, y, z)));
    };
    const auto mirrored = [](fabric::Vec3 place) {
        place.z = -place.z;
        return place;
    };
    const fabric::Vec3 down(0.4, 0.5, -0.8);
    for (const fabric::Mat4& ground : {scaled(1, 1, 1), scaled(1, -1, -1), scaled(-1, 1, 1)})
        for (const fabric::Shading shading : {fabric::Shading::Smooth, fabric::Shading::Flat})
            for (const bool fromBelow : {false, true}) {
                const fabric::Vec3 light = fromBelow ? mirrored(down) : down;
                ASSERT_NO_FATAL_FAILURE(open(ground, light));
                fabric::Camera from = camera(0.5);
                if (fromBelow)
                    from.eye.z = 2 * from.target.z - from.eye.z;
                const double seen = brightness(draw({}, from, shading).image);
                ASSERT_NO_FATAL_FAILURE(open(scaled(1, 1, -1) * ground, mirrored(light)));
                from.eye = mirrored(from.eye);
                from.target = mirrored(from.target);
                const double reflected = brightness(draw({}, from, shading).image);
                EXPECT_NEAR(reflected / seen, 1, 0.01) << fromBelow;
                EXPECT_GT(seen, 80) << fromBelow << ": more than ambient light";
            }
}

/// What is drawn as lines has no sides.
TEST_F(TerrainLookTest, LinesAreLitFromAboveFromWhereverTheyAreSeen) {
    fabric::Camera from = camera(0.5);
    const double above = brightness(draw({}, from, fabric::Shading::Wireframe).image);
    from.eye.z = 2 * from.target.z - from.eye.z;
    EXPECT_NEAR(brightness(draw({}, from, fabric::Shading::Wireframe).image) / above, 1, 0.1);
}

TEST_F(TerrainLookTest, ALookOutOfItsRangesIsRefused) {
    fabric::FrameData frame{1, camera(0.5), 1, fabric::Shading::Smooth, {.saturation = 3}};
    fabric::ChannelTask task;
    task.viewWidth = task.viewHeight = 16;
    task.pixelViewport = {0, 0, 16, 16};
    EXPECT_EQ(renderer_->render(frame, task).status(),
              absl::InvalidArgumentError("look.saturation is 3; it must be from 0 to 2"));
}

TEST_F(TerrainLookTest, TheGroundReportedIsNowhereBelowWhatIsDrawn) {
    ASSERT_NE(info_.ground, nullptr);
    ASSERT_EQ(info_.ground->size(), 1U);
    const fabric::GroundGrid& grid = info_.ground->front();
    EXPECT_EQ(grid.columns, 32) << "the finest tiles have 32 cells a side";
    fabric::Camera down;
    down.target = info_.bounds.centre();
    down.eye = down.target + fabric::Vec3(1, 0, 2.5 * info_.bounds.size().x);
    down.up = {0, 1, 0};
    const fabric::Image image = draw({}, down).image;
    const fabric::Mat3 worldFromView = glm::transpose(fabric::viewFromWorldRotation(down));
    const fabric::Frustum frustum =
        fabric::symmetricFrustum(down.fovYDegrees, static_cast<double>(kWidth) / kHeight);
    const fabric::Mat4 gridFromWorld = glm::inverse(grid.worldFromGrid);
    double tightest = std::numeric_limits<double>::infinity();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float depth = image.depth[static_cast<std::size_t>(y * kWidth + x)];
            if (depth == 0)
                continue;
            const fabric::Vec3 ray(glm::mix(frustum.left, frustum.right, (x + 0.5) / kWidth),
                                   glm::mix(frustum.bottom, frustum.top, (y + 0.5) / kHeight), -1);
            const fabric::Vec3 hit =
                down.eye +
                worldFromView * ray * fabric::viewDepthMetres(depth, fabric::kNearMetres);
            const fabric::Vec3 place(gridFromWorld * fabric::Vec4(hit, 1));
            const double room = fabric::ceilingAt(grid, place.x, place.y) - place.z;
            tightest = std::min(tightest, room);
            // What a pixel of error may be, from here.
            ASSERT_GT(room, -0.02 * info_.bounds.size().z) << x << "," << y;
        }
    EXPECT_LT(tightest, 0.05 * info_.bounds.size().z) << "some cell's highest post is seen";
}

}  // namespace
}  // namespace eyrie
