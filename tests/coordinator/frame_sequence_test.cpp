// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_sequence.h"

#include <thread>

#include <gmock/gmock.h>

#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

/// Views are told apart by their width.
FrameSequence ofFrames(std::size_t count) {
    FrameSequence sequence;
    sequence.view = [count](std::size_t index) -> std::optional<FrameRequest> {
        if (index == count)
            return std::nullopt;
        FrameRequest request;
        request.width = 10 + static_cast<int>(index);
        return request;
    };
    return sequence;
}

absl::StatusOr<RenderedFrame> drawPlain(const FrameSource::ChooseFrame& choose) {
    const auto request = choose();
    if (!request)
        return absl::CancelledError();
    RenderedFrame frame;
    frame.image = fabric::makeImage({0, 0, request->width, 1}, {}, false);
    return frame;
}

TEST(FrameSequence, HandsOverEveryFrameInOrderHoweverManyAreAskedForAtOnce) {
    for (const int atOnce : {1, 2, 8}) {
        FrameSequence sequence = ofFrames(50);
        sequence.atOnce = atOnce;
        // Some let others pass.
        sequence.draw = [&](const FrameSource::ChooseFrame& choose) {
            auto frame = drawPlain(choose);
            if (frame.ok() && frame->image.area.width % 3 == 0)
                std::this_thread::yield();
            return frame;
        };
        std::vector<int> widths;
        FrameSequence::Clock::time_point last{};
        sequence.take = [&](const FrameSequence::Frame& frame) {
            EXPECT_EQ(frame.index, widths.size());
            EXPECT_LE(frame.begun, frame.arrived);
            EXPECT_LE(last, frame.arrived);
            last = frame.arrived;
            widths.push_back(frame.drawn->image.area.width);
            return absl::OkStatus();
        };
        EXPECT_TRUE(drawSequence(sequence).ok());
        ASSERT_EQ(widths.size(), 50U) << atOnce;
        for (std::size_t i = 0; i < widths.size(); ++i)
            EXPECT_EQ(widths[i], 10 + static_cast<int>(i));
    }
}

TEST(FrameSequence, OfOneAtATimeStaysOnTheCallersThread) {
    FrameSequence sequence = ofFrames(3);
    const auto caller = std::this_thread::get_id();
    sequence.draw = [&](const FrameSource::ChooseFrame& choose) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        return drawPlain(choose);
    };
    int taken = 0;
    sequence.take = [&](const FrameSequence::Frame&) {
        ++taken;
        return absl::OkStatus();
    };
    EXPECT_TRUE(drawSequence(sequence).ok());
    EXPECT_EQ(taken, 3);
}

/// Whoever takes the fifth has enough; those that are under way are left.
TEST(FrameSequence, EndsWithTheErrorOfWhoTakesTheFrames) {
    for (const int atOnce : {1, 3}) {
        FrameSequence sequence = ofFrames(1000);
        sequence.atOnce = atOnce;
        sequence.draw = drawPlain;
        std::size_t taken = 0;
        sequence.take = [&](const FrameSequence::Frame& frame) {
            ++taken;
            return frame.index == 4 ? absl::DataLossError("enough") : absl::OkStatus();
        };
        EXPECT_EQ(drawSequence(sequence), absl::DataLossError("enough"));
        EXPECT_EQ(taken, 5U);
    }
}

TEST(FrameSequence, AFrameThatCannotBeHadIsHandedOverToo) {
    FrameSequence sequence = ofFrames(6);
    sequence.atOnce = 2;
    sequence.draw = [](const FrameSource::ChooseFrame& choose) {
        auto frame = drawPlain(choose);
        if (frame.ok() && frame->image.area.width == 13)
            frame = absl::UnavailableError("no renderer");
        return frame;
    };
    std::vector<bool> drawn;
    sequence.take = [&](const FrameSequence::Frame& frame) {
        drawn.push_back(frame.drawn.ok());
        return absl::OkStatus();
    };
    EXPECT_TRUE(drawSequence(sequence).ok());
    EXPECT_THAT(drawn, testing::ElementsAre(true, true, true, false, true, true));
}

TEST(FrameSequence, WhoIsNotEvenAskedForAViewSaysWhy) {
    FrameSequence sequence = ofFrames(6);
    sequence.atOnce = 2;
    sequence.draw = [](const FrameSource::ChooseFrame&) -> absl::StatusOr<RenderedFrame> {
        return absl::UnavailableError("gone");
    };
    sequence.take = [&](const FrameSequence::Frame&) { return absl::OkStatus(); };
    EXPECT_EQ(drawSequence(sequence), absl::UnavailableError("gone"));
}

/// Through a pipeline of two renderers: pictures to the bit, and two under way at once.
class SequenceOfAPipeline : public FramePipelineTest {};
INSTANTIATE_TEST_SUITE_P(By, SequenceOfAPipeline, testing::Values("2D", "DB static"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(SequenceOfAPipeline, HasThePicturesOfFramesOneByOne) {
    EXPECT_EQ(pipeline_.framesAtOnce(), 2) << "before it knows a renderer, too";
    openWith(2);
    FrameSequence sequence;
    sequence.atOnce = pipeline_.framesAtOnce();
    EXPECT_EQ(sequence.atOnce, 2);
    sequence.draw = [&](const auto& choose) { return pipeline_.renderLatest(choose); };
    sequence.view = [](std::size_t index) {
        return index < 30 ? std::optional(request()) : std::nullopt;
    };
    std::size_t taken = 0;
    sequence.take = [&](const FrameSequence::Frame& frame) {
        EXPECT_TRUE(frame.drawn.ok()) << frame.drawn.status();
        EXPECT_TRUE(frame.drawn->image == layers_->whole(kWidth, kHeight));
        EXPECT_EQ(frame.index, taken++);
        return absl::OkStatus();
    };
    EXPECT_TRUE(drawSequence(sequence).ok());
    EXPECT_EQ(taken, 30U);
}

}  // namespace
}  // namespace eyrie::coordinator
