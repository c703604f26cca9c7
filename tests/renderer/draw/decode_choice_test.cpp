// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/decode_choice.h"

#include <random>

#include <gtest/gtest.h>

#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/renderer.h"
#include "tests/renderer/sample_scene.h"

namespace eyrie {
namespace {

using draw::DecodeChoice;
using draw::TileDecoder;

class DecodeChoiceTest : public testing::Test {
protected:
    void SetUp() override {
        gl::setOnGlError(gl::OnGlError::Abort);
        const auto scene = test::sampleScene(test::SampleKind::Terrain);
        ASSERT_TRUE(scene.ok()) << scene.status();
        scene_ = *scene;
    }

    std::shared_ptr<const terrain::EytFile> file() {
        return terrain::EytFile::open(scene_.objects[0].path).value();
    }

    /// Pictures from afar to near, each complete, with depth.
    std::vector<fabric::Image> pictures(TileDecoding decoding) {
        RendererOptions options;
        options.decoding = decoding;
        const auto renderer = Renderer::create(options).value();
        const fabric::Box bounds = renderer->openScene(scene_).value().bounds;
        std::vector<fabric::Image> images;
        for (const double distance : {1.5, 0.3, 0.1}) {
            fabric::FrameData frame;
            frame.camera.target = bounds.centre();
            frame.camera.eye = bounds.centre() + bounds.size() * distance;
            fabric::ChannelTask task;
            task.viewWidth = 320;
            task.viewHeight = 180;
            task.pixelViewport = {0, 0, 320, 180};
            task.wantsDepth = true;
            const auto result = renderer->render(frame, task);
            EXPECT_TRUE(result.ok()) << result.status();
            EXPECT_GT(result->statistics.triangles, 1000U);
            tilesDecodedOnGpu_ += result->statistics.tilesDecodedOnGpu;
            images.push_back(result->image);
        }
        return images;
    }

    /// Of random cameras close above the ground, whose pictures' edges cut tiles, and of random
    /// parts of their views; with depth.
    std::vector<fabric::Image> picturesFromAmongTheTiles(TileDecoding decoding) {
        RendererOptions options;
        options.decoding = decoding;
        const auto renderer = Renderer::create(options).value();
        const fabric::Box bounds = renderer->openScene(scene_).value().bounds;
        std::mt19937 random(85);
        const auto unit = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
        const auto inside = [&](double up) {
            return bounds.min + bounds.size() * fabric::Vec3(unit(), unit(), up);
        };
        std::vector<fabric::Image> images;
        for (int k = 0; k < 60; ++k) {
            fabric::FrameData frame;
            frame.camera.eye = inside(1.02 + unit());
            frame.camera.target = inside(0.5);
            frame.camera.fovYDegrees = 10 + 70 * unit();
            frame.tauPixels = 0.5 + 2 * unit();
            fabric::ChannelTask task;
            task.viewWidth = 320;
            task.viewHeight = 180;
            const auto x = static_cast<std::int32_t>(160 * unit());
            const auto y = static_cast<std::int32_t>(90 * unit());
            const fabric::PixelViewport part{x, y, 1 + x, 1 + y};
            task.pixelViewport = k % 2 == 0 ? fabric::PixelViewport{0, 0, 320, 180} : part;
            task.wantsDepth = true;
            const auto result = renderer->render(frame, task);
            EXPECT_TRUE(result.ok()) << result.status();
            tilesDecodedOnGpu_ += result->statistics.tilesDecodedOnGpu;
            images.push_back(result->image);
        }
        return images;
    }

    fabric::Scene scene_;
    std::uint64_t tilesDecodedOnGpu_ = 0;  ///< in all pictures
};

TEST_F(DecodeChoiceTest, DrawsTheSamePicturesAndCountsTheGpusTiles) {
    const auto cpu = pictures(TileDecoding::Cpu);
    EXPECT_EQ(tilesDecodedOnGpu_, 0U);
    EXPECT_EQ(cpu, pictures(TileDecoding::Gpu));
    EXPECT_GT(tilesDecodedOnGpu_, 10U);
}

/// Tiles that the GPU made are drawn whole; those of the CPU without what is beside the picture.
TEST_F(DecodeChoiceTest, LeavesOutOnlyWhatIsBesideThePicture) {
    const auto cpu = picturesFromAmongTheTiles(TileDecoding::Cpu);
    const auto whole = picturesFromAmongTheTiles(TileDecoding::Gpu);
    ASSERT_EQ(cpu.size(), whole.size());
    for (std::size_t k = 0; k < cpu.size(); ++k) EXPECT_EQ(cpu[k], whole[k]) << "picture " << k;
    EXPECT_GT(tilesDecodedOnGpu_, 10U);
}

TEST_F(DecodeChoiceTest, TakesWhatIsAskedFor) {
    const auto context = gl::EglContext::create(-1).value();
    EXPECT_EQ(DecodeChoice(TileDecoding::Cpu).decoderFor(*file()).value(), nullptr);
    DecodeChoice gpu(TileDecoding::Gpu);
    TileDecoder* decoder = gpu.decoderFor(*file()).value();
    EXPECT_NE(decoder, nullptr);
    EXPECT_EQ(gpu.decoderFor(*file()).value(), decoder);
}

TEST_F(DecodeChoiceTest, KeepsWhatWasMeasured) {
    const auto context = gl::EglContext::create(-1).value();
    DecodeChoice choice(TileDecoding::Auto);
    TileDecoder* const first = choice.decoderFor(*file()).value();
    for (int k = 0; k < 3; ++k) EXPECT_EQ(choice.decoderFor(*file()).value(), first);
}

TEST_F(DecodeChoiceTest, CountsWhatBothWaysDecodeAlike) {
    const auto context = gl::EglContext::create(-1).value();
    auto decoder = TileDecoder::create().value();
    const auto open = file();
    const auto bytes = open->readPageBytes(0).value();
    const auto cpu = draw::measureDecode(bytes, nullptr).value();
    const auto gpu = draw::measureDecode(bytes, &decoder).value();
    EXPECT_EQ(cpu.triangles, gpu.triangles);
    EXPECT_EQ(cpu.tiles, 16U);
    EXPECT_EQ(gpu.tiles, 16U);
    EXPECT_LT(gpu.bytesSent, cpu.bytesSent);
    EXPECT_FALSE(draw::measureDecode(std::vector<std::uint32_t>(3), nullptr).ok());
}

}  // namespace
}  // namespace eyrie
