// SPDX-License-Identifier: Apache-2.0
// Looks of meshes: boxes, and colours that tell what the engine did.
#include <array>
#include <cmath>
#include <random>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "fabric/depth_merge.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/renderer.h"
#include "tests/support/renderer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// A ball, plain or with a colour of its own at each vertex.
class MeshLook : public testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        renderer_ = test::makeRenderer();
        import::TriangleMesh ball = import::synthesizeMesh(20000, 5);
        if (GetParam())
            for (std::size_t i = 0; i < ball.positions.size(); ++i)
                ball.colours.push_back({static_cast<std::uint8_t>(i % 256), 90, 30, 255});
        const auto report =
            import::importMesh(std::move(ball), folder_.path("ball.eym"), {.leafTriangles = 2048});
        ASSERT_TRUE(report.ok()) << report.status();
        fabric::Scene scene;
        scene.ambient = 1;
        scene.objects.push_back({.name = "ball", .path = folder_.path("ball.eym")});
        ASSERT_TRUE(renderer_->openScene(scene).ok());
    }

    fabric::ChannelResult draw(const fabric::Look& look, const fabric::Range& range = {},
                               fabric::Shading shading = fabric::Shading::Smooth,
                               double tauPixels = 0.5) {
        fabric::FrameData frame;
        frame.camera = {.eye = {1.9, 1.2, 0.8}, .target = {0, 0.2, 0}};
        frame.tauPixels = tauPixels;
        frame.look = look;
        frame.shading = shading;
        fabric::ChannelTask task;
        task.viewWidth = kWidth;
        task.viewHeight = kHeight;
        task.pixelViewport = {0, 0, kWidth, kHeight};
        task.range = range;
        task.wantsDepth = true;
        auto result = renderer_->render(frame, task);
        EXPECT_TRUE(result.ok()) << result.status();
        fabric::Image whole = fabric::makeImage(task.pixelViewport, {255, 255, 255, 255}, true);
        fabric::paste(result->image, whole);
        result->image = std::move(whole);
        return *std::move(result);
    }

    /// Which of red, green and blue lead, by how many pixels.
    static std::array<int, 3> leads(const fabric::Image& image) {
        std::array<int, 3> counts{};
        for (std::size_t i = 0; i < image.colour.size(); ++i) {
            const fabric::Rgba& c = image.colour[i];
            if (image.depth[i] > 0)
                ++counts[c.r > c.g && c.r > c.b ? 0 : c.g > c.b ? 1 : 2];
        }
        return counts;
    }

    static int covered(const fabric::Image& image) {
        const auto [r, g, b] = leads(image);
        return r + g + b;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Renderer> renderer_;
};

INSTANTIATE_TEST_SUITE_P(Balls, MeshLook, testing::Bool(), [](const auto& coloured) {
    return coloured.param ? "WithColours" : "Plain";
});

TEST_P(MeshLook, BoundsAreLinesOverThePictureAndCountAsNothing) {
    const fabric::ChannelResult plain = draw({});
    const fabric::ChannelResult lined = draw({.tileBounds = true});
    ASSERT_GT(plain.statistics.nodes, 3U);
    int lines = 0;
    for (std::size_t i = 0; i < plain.image.colour.size(); ++i)
        lines += lined.image.colour[i] != plain.image.colour[i] ? 1 : 0;
    EXPECT_GT(lines, 500);
    EXPECT_LT(lines, kWidth * kHeight / 4);
    EXPECT_GT(covered(lined.image), covered(plain.image)) << "boxes reach beyond the surface";
    EXPECT_EQ(lined.statistics.nodes, plain.statistics.nodes);
    EXPECT_EQ(lined.statistics.triangles, plain.statistics.triangles);
    EXPECT_TRUE(draw({}).image == plain.image) << "nothing of a look stays behind";
}

/// As the file has it: of the nodes that are drawn, which are coarser where more error is allowed.
TEST_P(MeshLook, SaysHowFarNormalsMayBeOff) {
    const auto file = mesh::EymFile::open(folder_.path("ball.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    const fabric::FrameStatistics finest = draw({}, {}, fabric::Shading::Smooth, 0.01).statistics;
    EXPECT_EQ(finest.normalErrorDegrees, 0);
    EXPECT_EQ(finest.normalErrorMeanDegrees, 0);
    const fabric::FrameStatistics coarsest = draw({}, {}, fabric::Shading::Smooth, 1000).statistics;
    ASSERT_EQ(coarsest.nodes, 1U);
    EXPECT_GT(coarsest.normalErrorMeanDegrees, 0);
    EXPECT_EQ(coarsest.normalErrorDegrees, double{file->nodes()[0].normalErrorDegrees});
    EXPECT_EQ(coarsest.normalErrorMeanDegrees, double{file->nodes()[0].normalErrorMeanDegrees});
}

/// Normals of what is drawn flattened are turned farther apart than those of the file.
TEST_P(MeshLook, SaysHowFarNormalsMayBeOffWhereAMapIsUneven) {
    const auto file = mesh::EymFile::open(folder_.path("ball.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    fabric::Scene scene;
    const fabric::Mat4 map = glm::rotate(fabric::Mat4(1), 0.7, fabric::Vec3(1, 2, 3)) *
                             glm::scale(fabric::Mat4(1), fabric::Vec3(1, 0.8, 0.25)) *
                             glm::rotate(fabric::Mat4(1), -0.3, fabric::Vec3(2, 1, 0));
    scene.objects.push_back(
        {.name = "flat", .path = folder_.path("ball.eym"), .worldFromObject = map});
    ASSERT_TRUE(renderer_->openScene(scene).ok());
    const double inFile = file->nodes()[0].normalErrorMeanDegrees;
    const double said =
        draw({}, {}, fabric::Shading::Smooth, 1000).statistics.normalErrorMeanDegrees;
    const fabric::Mat3 ofNormals = glm::transpose(glm::inverse(fabric::Mat3(map)));
    std::mt19937 random(5);
    std::normal_distribution<double> share;
    const auto direction = [&] {
        return glm::normalize(fabric::Vec3(share(random), share(random), share(random)));
    };
    double most = 0;
    for (int i = 0; i < 100000; ++i) {
        const fabric::Vec3 a = direction();
        const fabric::Vec3 across = glm::normalize(glm::cross(a, direction()));
        const fabric::Vec3 b = fabric::Vec3(
            glm::rotate(fabric::Mat4(1), glm::radians(inFile), across) * fabric::Vec4(a, 0));
        most = std::max(
            most, glm::degrees(std::acos(std::clamp(
                      glm::dot(glm::normalize(ofNormals * a), glm::normalize(ofNormals * b)), -1.0,
                      1.0))));
    }
    EXPECT_LE(most, said);
    EXPECT_GT(most, 0.95 * said);
}

TEST_P(MeshLook, TintsChangeColoursAlone) {
    const fabric::ChannelResult plain = draw({});
    for (const fabric::Look& look :
         {fabric::Look{.levelTint = true}, fabric::Look{.rangeTint = true}}) {
        const fabric::ChannelResult tinted = draw(look);
        EXPECT_TRUE(tinted.image.depth == plain.image.depth);
        EXPECT_FALSE(tinted.image.colour == plain.image.colour);
    }
    EXPECT_TRUE(draw({}).image == plain.image) << "nothing of a look stays behind";
}

TEST_P(MeshLook, EachRangeHasAColourOfItsOwn) {
    fabric::Image composed = fabric::makeImage({0, 0, kWidth, kHeight}, {255, 255, 255, 255}, true);
    for (const fabric::Range& range : fabric::split(fabric::Range{}, fabric::equalCuts(3))) {
        const fabric::Image part = draw({.rangeTint = true}, range).image;
        const auto counts = leads(part);
        EXPECT_GT(covered(part), 0);
        EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), covered(part))
            << "one colour leads all over a range";
        fabric::mergeDepth(part, composed);
    }
    EXPECT_TRUE(composed.depth == draw({}).image.depth);
    int colours = 0;
    for (const int count : leads(composed)) colours += count > 500 ? 1 : 0;
    EXPECT_GE(colours, 2);
}

TEST_P(MeshLook, AWireframeIsTheEdgesOfTheSameTriangles) {
    const fabric::ChannelResult filled = draw({});
    const fabric::ChannelResult wire = draw({}, {}, fabric::Shading::Wireframe);
    EXPECT_EQ(wire.statistics.triangles, filled.statistics.triangles);
    EXPECT_GT(covered(wire.image), covered(filled.image) / 4);
}

}  // namespace
}  // namespace eyrie
