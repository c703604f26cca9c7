// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_pipeline.h"

#include <atomic>
#include <set>
#include <thread>

#include <gmock/gmock.h>

#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

INSTANTIATE_TEST_SUITE_P(Of, FramePipelineTest, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(FramePipelineTest, AnyNumberOfRenderersMakesTheSinglePicture) {
    for (int count = 1; count <= 4; ++count) {
        openWith(1);  // one more
        expectWholePicture();
    }
}

TEST_P(FramePipelineTest, AllReadyRenderersTakePart) {
    const auto renderers = openWith(3);
    expectWholePicture();
    for (const auto& renderer : renderers) EXPECT_EQ(renderer->drawn, 2);
}

TEST_P(FramePipelineTest, SharesFollowWhatDrawingTakesAndNoWaitingForData) {
    const auto renderers = openWith(2);
    FakeRenderer& slow = *renderers[0];
    EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    const double before = slow.share;
    slow.millisecondsAFrame = 10'000;
    slow.pagesLoaded = 3;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_EQ(slow.share, before) << "it read its data";
    slow.pagesLoaded = 0;
    FrameRequest part = request();
    part.part = {0, 0, kWidth, kHeight / 2};
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pipeline_.renderFrame(part).ok());
    EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_EQ(slow.share, before) << "they were parts";
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_LT(slow.share, .8 * before);
}

/// The layout that cuts pictures.
class PictureCuts : public FramePipelineTest {};

INSTANTIATE_TEST_SUITE_P(TwoD, PictureCuts, testing::Values("2D"));

/// As Equalizer names it: by its stripes.
TEST_P(PictureCuts, OfHORIZONTALAreStripesOneAboveAnother) {
    openWith(3);
    equalizer::Tuning tuning;
    tuning.mode = config::SplitMode::Horizontal;
    ASSERT_TRUE(pipeline_
                    .withConfiguration(
                        [&](ActiveConfiguration& active) { return active.tune("load.2D", tuning); })
                    .ok());
    const auto frame = pipeline_.renderFrame(request());
    ASSERT_TRUE(frame.ok()) << frame.status();
    ASSERT_EQ(frame->parts.size(), 3U);
    std::set<double> bottoms;
    for (const DrawnPart& part : frame->parts) {
        EXPECT_EQ(part.left, 0);
        EXPECT_EQ(part.width, 1);
        bottoms.insert(part.bottom);
    }
    EXPECT_EQ(bottoms.size(), 3U);
}

/// That of the renderers there are by then, and what was set is not lost with the first frame.
TEST_P(FramePipelineTest, ThereIsAConfigurationBeforeTheFirstFrame) {
    std::size_t nodes = 0;
    const auto look = [&](ActiveConfiguration& active) {
        nodes = active.written().nodes.size();
        return absl::OkStatus();
    };
    EXPECT_TRUE(absl::IsFailedPrecondition(pipeline_.withConfiguration(look)));
    pipeline_.setScene(sceneNamed("first"));
    for (std::size_t i = 1; i <= 2; ++i) {
        addRenderer();
        EXPECT_TRUE(eventually([&] {
            return pipeline_.withConfiguration(look).ok() && nodes == i;
        })) << nodes
            << " nodes of " << i << " renderers";
    }
    ASSERT_TRUE(pipeline_.configure({"0", "Simple"}).ok());
    EXPECT_EQ(pipeline_.status().canvases.front().layout, "Simple");
    ASSERT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_EQ(pipeline_.status().canvases.front().layout, "Simple");
}

TEST_P(FramePipelineTest, PicturesGetSmallerWhereNoErrorKeepsTheirTime) {
    openWith(2);
    FrameRequest timed = request();
    timed.budgetMilliseconds = 1;
    const auto first = pipeline_.renderFrame(timed);
    ASSERT_TRUE(first.ok()) << first.status();
    ASSERT_TRUE(first->statistics.budget.has_value());
    EXPECT_EQ(first->statistics.budget->milliseconds, 1);
    EXPECT_EQ(first->statistics.budget->tauPixels, fabric::kBudgetTauPixels);
    for (int i = 0; i < 3; ++i) (void)pipeline_.renderFrame(timed);
    const auto later = pipeline_.renderFrame(timed);
    ASSERT_TRUE(later.ok()) << later.status();
    EXPECT_FALSE(later->statistics.budget->isMet());
    const fabric::PixelViewport area = later->image.area;
    EXPECT_LT(area.width, kWidth);
    EXPECT_TRUE(later->image == layers_->whole(area.width, area.height));
    expectWholePicture();  // without a time to keep
}

/// A part of `picture`, as a renderer encodes what it has drawn of it.
std::vector<std::byte> jpegOf(const fabric::Image& picture, const fabric::PixelViewport& part) {
    fabric::Image cut = fabric::makeImage(part, {}, false);
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            cut.colour[static_cast<std::size_t>(y * part.width + x)] =
                picture.colour[static_cast<std::size_t>((part.y + y) * picture.area.width + part.x +
                                                        x)];
    return wire::encodeJpeg(cut, 95, wire::ChromaSubsampling::Half).value();
}

FrameRequest encoded(FrameRequest request) {
    request.wantsDepth = false;
    request.jpegQuality = 95;
    return request;
}

TEST_P(FramePipelineTest, PicturesLaidOutOfTilesComeAsRenderersEncodeThem) {
    const auto renderers = openWith(3);
    const auto frame = pipeline_.renderFrame(encoded(request()));
    ASSERT_TRUE(frame.ok()) << frame.status();
    const fabric::Image expected = layers_->whole(kWidth, kHeight);
    if (GetParam() != "2D") {
        EXPECT_TRUE(frame->tiles.empty());
        EXPECT_TRUE(frame->image.colour == expected.colour);
        return;
    }
    ASSERT_EQ(frame->tiles.size(), 3U);
    EXPECT_TRUE(frame->image.colour.empty());
    std::int64_t covered = 0;
    for (const CodedTile& tile : frame->tiles) {
        EXPECT_EQ(tile.jpeg, jpegOf(expected, tile.area));
        covered += tile.area.area();
    }
    EXPECT_EQ(frame->image.area, expected.area);
    EXPECT_EQ(covered, expected.area.area());
    expectWholePicture();  // where its pixels are wanted
}

TEST_P(FramePipelineTest, ATimeThatIsNoneIsRefused) {
    openWith(1);
    FrameRequest timed = request();
    timed.budgetMilliseconds = 0;
    EXPECT_TRUE(absl::IsInvalidArgument(pipeline_.renderFrame(timed).status()));
}

TEST_P(FramePipelineTest, FrameDataIsSentOnceAVersion) {
    const auto renderers = openWith(2);
    ASSERT_TRUE(pipeline_.renderFrame(request()).ok());
    const std::size_t sent = renderers[0]->versions.size();
    ASSERT_TRUE(pipeline_.renderFrame(request()).ok());
    EXPECT_EQ(renderers[0]->versions.size(), sent);
    FrameRequest moved = request();
    moved.camera.eye.x += 1;
    ASSERT_TRUE(pipeline_.renderFrame(moved).ok());
    ASSERT_EQ(renderers[0]->versions.size(), sent + 1);
    EXPECT_GT(renderers[0]->versions[sent], renderers[0]->versions[sent - 1]);
}

TEST_P(FramePipelineTest, StatisticsAreTheWholeFrames) {
    openWith(1);
    const auto frame = pipeline_.renderFrame(request());
    ASSERT_TRUE(frame.ok());
    EXPECT_EQ(frame->statistics.nodes, 30U);
    EXPECT_EQ(frame->statistics.tauAskedPixels, 1);
    EXPECT_GT(frame->statistics.milliseconds.total, 0);
    EXPECT_EQ(frame->device.renderer, "fake:1");
}

TEST_P(FramePipelineTest, ARequestOutOfRangeIsRefused) {
    openWith(1);
    FrameRequest wide = request();
    wide.width = fabric::kMaxViewPixels + 1;
    FrameRequest fine = request();
    fine.tauPixels = 0;
    FrameRequest blind = request();
    blind.camera.target = blind.camera.eye;
    for (const FrameRequest& bad : {wide, fine, blind})
        EXPECT_EQ(pipeline_.renderFrame(bad).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(FramePipelineTest, APartOfThePictureIsTheWholePicturesPart) {
    openWith(3);
    FrameRequest part = request();
    part.part = {7, 3, 20, 11};
    const auto frame = pipeline_.renderFrame(part);
    ASSERT_TRUE(frame.ok()) << frame.status();
    EXPECT_EQ(frame->image.area, part.part);
    fabric::Image whole = layers_->whole(kWidth, kHeight);
    fabric::paste(frame->image, whole);
    EXPECT_TRUE(whole == layers_->whole(kWidth, kHeight));
    part.part = {30, 3, 20, 11};
    EXPECT_EQ(pipeline_.renderFrame(part).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_P(FramePipelineTest, FramesFromSeveralThreadsAreAllWhole) {
    const auto renderers = openWith(3);
    std::atomic<int> whole{0};
    {
        std::vector<std::jthread> viewers;
        for (int viewer = 0; viewer < 4; ++viewer)
            viewers.emplace_back([&, viewer] {
                for (int i = 0; i < 25; ++i) {
                    FrameRequest mine = request();
                    mine.camera.eye.x = viewer + i * 0.1;
                    const auto frame = pipeline_.renderFrame(mine);
                    whole += frame.ok() && frame->image == layers_->whole(kWidth, kHeight) ? 1 : 0;
                }
            });
    }
    EXPECT_EQ(whole, 100);
}

TEST_P(FramePipelineTest, PicksAreAskedOfTheNextRendererWhereOneFails) {
    const auto renderers = openWith(3);
    const fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {20, 30}, 1};
    renderers[0]->failToPick(absl::DeadlineExceededError("its server stalls"));
    renderers[1]->pickedObject = 7;  // the scene has one
    const auto picked = pipeline_.pick(request);
    ASSERT_TRUE(picked.ok() && picked->has_value()) << picked.status();
    EXPECT_EQ((*picked)->worldMetres, fabric::Vec3(20, 30, 0));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(renderers[static_cast<std::size_t>(i)]->picks, 1);
        EXPECT_TRUE(isAlive(i));
    }
    for (const auto& renderer : renderers)
        renderer->failToPick(absl::DataLossError("renderer at fake:3: page 7 is damaged"));
    EXPECT_EQ(pipeline_.pick(request).status(),
              absl::DataLossError(ids_.back() + ": page 7 is damaged"));
    expectWholePicture();
}

TEST_P(FramePipelineTest, PicksOutsideThePictureOrWithoutASceneAreRefused) {
    fabric::PickRequest request{{{1, 2, 3}, {4, 5, 6}}, 640, 480, {20, 30}, 1};
    EXPECT_TRUE(absl::IsUnavailable(pipeline_.pick(request).status()));
    request.place.x = 641;
    EXPECT_TRUE(absl::IsInvalidArgument(pipeline_.pick(request).status()));
}

}  // namespace
}  // namespace eyrie::coordinator
