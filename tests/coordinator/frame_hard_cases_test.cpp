// SPDX-License-Identifier: Apache-2.0
#include <future>
#include <random>
#include <thread>

#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

/// Depths of LayeredScene tie all over. No part is taken for lost and drawn by another.
class HardCase13 : public FramePipelineTest {
protected:
    /// Draws a frame, the parts of which come in the order of `renderers`.
    absl::StatusOr<RenderedFrame> framePartByPart(
        const std::vector<std::shared_ptr<FakeRenderer>>& renderers) {
        int begun = 0;
        for (const auto& renderer : renderers) {
            renderer->hang(true);
            begun += renderer->begun;
        }
        auto frame =
            std::async(std::launch::async, [this] { return pipeline_.renderFrame(request()); });
        EXPECT_TRUE(eventually([&] {
            int now = 0;
            for (const auto& renderer : renderers) now += renderer->begun;
            return now == begun + static_cast<int>(renderers.size());
        }));
        for (const auto& renderer : renderers) {
            const int drawn = renderer->drawn;
            renderer->hang(false);
            EXPECT_TRUE(eventually([&] { return renderer->drawn == drawn + 1; }));
        }
        return frame.get();
    }
};

INSTANTIATE_TEST_SUITE_P(Of, HardCase13, testing::Values("DB static"),
                         [](const auto&) { return "Db"; });

TEST_P(HardCase13, PicturesAreTheSameInWhateverOrderTiedPartsArrive) {
    std::mt19937 random(13);
    std::vector<std::shared_ptr<FakeRenderer>> renderers;
    for (const std::size_t count : {2U, 3U, 5U, 8U}) {
        const auto added = openWith(static_cast<int>(count - renderers.size()));
        renderers.insert(renderers.end(), added.begin(), added.end());
        for (int i = 0; i < 25; ++i) {
            std::ranges::shuffle(renderers, random);
            const auto frame = framePartByPart(renderers);
            ASSERT_TRUE(frame.ok()) << frame.status();
            ASSERT_TRUE(frame->image == layers_->whole(kWidth, kHeight)) << count << ", " << i;
        }
    }
}

/// The picture expected is the one that LayeredScene draws by its definition, whole. No part is
/// taken for late, so each renderer draws its own.
class HardCase27 : public FramePipelineTest {};

INSTANTIATE_TEST_SUITE_P(Of, HardCase27, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(HardCase27, AllInOnePixelIsTheSinglePictureOverEightRenderers) {
    layers_ = std::make_shared<LayeredScene>(27, 1, 1);
    openWith(8);
    expectWholePicture();
}

TEST_P(HardCase27, PartsWithNothingInThemAreBackground) {
    layers_ = std::make_shared<LayeredScene>(27, 41, 23, 1);
    openWith(8);
    expectWholePicture();
}

TEST_P(HardCase27, ARendererTenTimesSlowerGetsATenthAndPicturesStayWhole) {
    const auto renderers = openWith(3);
    renderers[1]->millisecondsAFrame = 10'000;
    for (int i = 0; i < 20; ++i) expectWholePicture();
    // Equal times are shares of 10 : 1 : 10. A column of pixels of 41 is the finest cut in 2D.
    EXPECT_NEAR(renderers[0]->share, 10.0 / 21, 0.04);
    EXPECT_NEAR(renderers[1]->share, 1.0 / 21, 0.03);
    EXPECT_NEAR(renderers[2]->share, 10.0 / 21, 0.04);
}

TEST_P(HardCase27, AfterOneIsKilledMidFrameTheNextFramesAreRightAndTiesAreWonAsBefore) {
    const auto renderers = openWith(3);
    renderers[0]->hang(true);
    const int begun = renderers[0]->begun;
    std::jthread killer([&] {
        EXPECT_TRUE(eventually([&] { return renderers[0]->begun > begun; }));
        registry_.markDead(ids_[0], "killed", Registry::Clock::now());
    });
    for (int i = 0; i < 5; ++i) expectWholePicture();
    EXPECT_FALSE(isAlive(0));
    killer.join();
    openWith(1);
    for (int i = 0; i < 5; ++i) expectWholePicture();
}

}  // namespace
}  // namespace eyrie::coordinator
