// SPDX-License-Identifier: Apache-2.0
// Posters as `eyrie render` draws them: by bands, with a renderer of its own.
#include <algorithm>
#include <memory>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>

#include "cli/picture_bands.h"
#include "cli/picture_source.h"
#include "renderer/gl/debug_output.h"
#include "renderer/import/mesh_import.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/terrain_import.h"
#include "renderer/import/terrain_synth.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 181;

/// A synthetic mesh that stands on a synthetic terrain.
class PosterBands : public testing::Test {
protected:
    void SetUp() override {
        gl::setOnGlError(gl::OnGlError::Abort);
        ASSERT_TRUE(import::importTerrain(import::synthesizeTerrain(513, 3), {"terrain", "", 3},
                                          folder_.path("terrain.eyt"), {})
                        .ok());
        ASSERT_TRUE(
            import::importMesh(import::synthesizeMesh(30000, 3), folder_.path("mesh.eym")).ok());
        const std::string scene = folder_.write("scene.json", R"({"objects":[
            {"terrain":"terrain.eyt"},
            {"mesh":"mesh.eym","transform":{"scale":2000,"translation":[507000,5207000,3000]}}]})");
        PictureSourceOptions options;
        options.drawing.cache.folder = folder_.path("cache");
        options.quiet = true;
        auto pictures = PictureSource::open(scene, options, {});
        ASSERT_TRUE(pictures.ok()) << pictures.status();
        pictures_ = *std::move(pictures);
    }

    static coordinator::FrameRequest request() {
        coordinator::FrameRequest request;
        request.camera = {
            .eye = {503000, 5202000, 4500}, .target = {508000, 5208000, 2500}, .fovYDegrees = 50};
        request.width = kWidth;
        request.height = kHeight;
        request.wantsDepth = true;
        return request;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<PictureSource> pictures_;
};

/// Of one row, of rows that leave fewer for the last band, and of one that ends within a row.
TEST_F(PosterBands, OfAnyHeightAreThePictureDrawnAtOnceToTheBit) {
    const auto whole = pictures_->draw(request());
    ASSERT_TRUE(whole.ok()) << whole.status();
    const fabric::Image& expected = whole->image;
    ASSERT_EQ(expected.depth.size(), std::size_t{kWidth} * kHeight);
    const auto covered =
        std::ranges::count_if(expected.depth, [](float depth) { return depth > 0; });
    EXPECT_GT(covered, kWidth * kHeight / 3);
    EXPECT_LT(covered, kWidth * kHeight) << "sky";
    for (const int pixels : {1, 7 * kWidth, 64 * kWidth - 1}) {
        SCOPED_TRACE(pixels);
        fabric::Image poster = fabric::makeImage({0, 0, kWidth, kHeight}, {}, true);
        int bands = 0;
        const auto drawn =
            drawInBands(*pictures_, request(), pixels, [&](const fabric::Image& rows) {
                ++bands;
                fabric::paste(rows, poster);
                return absl::OkStatus();
            });
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        const int rows = std::max(pixels / kWidth, 1);
        EXPECT_EQ(bands, (kHeight + rows - 1) / rows);
        EXPECT_TRUE(poster == expected);
        EXPECT_EQ(drawn->statistics.tauAchievedPixels, whole->statistics.tauAchievedPixels);
    }
}

}  // namespace
}  // namespace eyrie::cli
