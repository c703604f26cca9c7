// SPDX-License-Identifier: Apache-2.0
// Renderers that fail, hang, die, lag or leave cost a frame some time and no pixel.
#include <atomic>
#include <thread>

#include <gmock/gmock.h>

#include "frame_pipeline_fixture.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;

class FrameFaults : public FramePipelineTest {
protected:
    FrameFaults() : FramePipelineTest(milliseconds(100)) {}
};

INSTANTIATE_TEST_SUITE_P(Of, FrameFaults, testing::Values("2D", "DB dynamic"),
                         [](const auto& of) { return test::identifier(of.param); });

TEST_P(FrameFaults, AFailedPartIsDrawnByAnother) {
    const auto renderers = openWith(3);
    renderers[1]->failToRender(absl::UnavailableError("connection reset"));
    expectWholePicture();
    EXPECT_FALSE(isAlive(1));
    EXPECT_TRUE(isAlive(0));
    expectWholePicture();
}

TEST_P(FrameFaults, APartThatHangsIsDrawnByAnother) {
    const auto renderers = openWith(3);
    renderers[0]->hang(true);
    expectWholePicture();
    EXPECT_TRUE(isAlive(0));
    const int begun = renderers[0]->begun;
    expectWholePicture();
    EXPECT_EQ(renderers[0]->begun, begun);  // it sits out while it is busy
    renderers[0]->hang(false);
    EXPECT_TRUE(eventually([&] {
        expectWholePicture();
        return renderers[0]->begun > begun;
    }));
}

TEST_P(FrameFaults, ARendererThatDiesMidFrameIsReplaced) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    const int begun = renderers[1]->begun;
    std::jthread killer([&] {
        EXPECT_TRUE(eventually([&] { return renderers[1]->begun > begun; }));
        registry_.markDead(ids_[1], "no heartbeat", Registry::Clock::now());
    });
    expectWholePicture();
    EXPECT_FALSE(isAlive(1));
}

TEST_P(FrameFaults, ADeadOnesSuccessorTakesPart) {
    openWith(2);
    registry_.markDead(ids_[0], "test", Registry::Clock::now());
    expectWholePicture();
    const auto successor = addRenderer();
    EXPECT_TRUE(eventually([&] {
        expectWholePicture();
        return successor->drawn > 0;
    }));
}

TEST_P(FrameFaults, WithoutAnyRendererLeftItIsUnavailableAndSaysWhatToDo) {
    const auto renderers = openWith(2);
    for (const auto& renderer : renderers)
        renderer->failToRender(absl::UnavailableError("connection reset"));
    EXPECT_EQ(pipeline_.renderFrame(request()).status().code(), absl::StatusCode::kUnavailable);
    const absl::Status next = pipeline_.renderFrame(request()).status();
    EXPECT_EQ(next.code(), absl::StatusCode::kUnavailable);
    EXPECT_THAT(std::string(next.message()), testing::HasSubstr("eyrie renderer --coordinator"));
    EXPECT_EQ(pipeline_.status().problem, std::string(next.message()));
}

TEST_P(FrameFaults, ATaskThatEveryRendererRefusesIsAnErrorAndNobodysDeath) {
    const auto renderers = openWith(2);
    for (const auto& renderer : renderers)
        renderer->failToRender(absl::ResourceExhaustedError("no memory for the picture"));
    const absl::Status status = pipeline_.renderFrame(request()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_TRUE(isAlive(0) && isAlive(1));
}

TEST_P(FrameFaults, LatenessIsShownUntilItEnds) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    expectWholePicture();
    EXPECT_EQ(statusOf(1).condition, RendererCondition::Late);
    EXPECT_EQ(statusOf(0).condition, RendererCondition::Ready);
    std::atomic<bool> isOver{false};
    const int handle = pipeline_.subscribe(
        [&] { isOver = isOver || statusOf(1).condition == RendererCondition::Ready; });
    renderers[1]->hang(false);
    EXPECT_TRUE(eventually([&] { return isOver.load(); }));
    pipeline_.unsubscribe(handle);
}

TEST_P(FrameFaults, OneThatDrainsFinishesWhatItHasAndGetsNothingNew) {
    const auto renderers = openWith(2);
    renderers[1]->hang(true);
    const int begun = renderers[1]->begun;
    std::jthread frame([&] { expectWholePicture(); });
    ASSERT_TRUE(eventually([&] { return renderers[1]->begun > begun; }));
    ASSERT_TRUE(registry_.drain(ids_[1], Registry::Clock::now()).ok());
    EXPECT_EQ(statusOf(1).condition, RendererCondition::Draining);
    frame.join();  // its part was late, and drawn by the other
    expectWholePicture();
    EXPECT_EQ(renderers[1]->begun, begun + 1);
    EXPECT_TRUE(registry_.drain(ids_[1], Registry::Clock::now()).ok());
    const int drawn = renderers[1]->drawn;
    renderers[1]->hang(false);
    EXPECT_TRUE(eventually([&] { return pipeline_.status().renderers.size() == 1; }));
    EXPECT_EQ(renderers[1]->drawn, drawn + 1);
    EXPECT_TRUE(absl::IsNotFound(registry_.drain(ids_[1], Registry::Clock::now())));
    expectWholePicture();
}

TEST_P(FrameFaults, OneThatDrainsWithNothingToDoIsGoneAtOnce) {
    openWith(2);
    ASSERT_TRUE(registry_.drain(ids_[0], Registry::Clock::now()).ok());
    EXPECT_TRUE(eventually([&] { return pipeline_.status().renderers.size() == 1; }));
    expectWholePicture();
}

/// Without an equalizer, which would give it less and less to do.
TEST_P(FrameFaults, ASlowRendererIsGivenThreeTimesWhatItTakes) {
    const auto renderers = openWith(2);
    expectWholePicture();
    ASSERT_TRUE(pipeline_.configure({"0", "DB static"}).ok());
    renderers[1]->takes = milliseconds(40);
    for (int i = 0; i < 15; ++i) expectWholePicture();
    const int begun = renderers[0]->begun;
    renderers[1]->hang(true);
    const auto start = std::chrono::steady_clock::now();
    expectWholePicture();
    EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(120));
    EXPECT_EQ(renderers[0]->begun, begun + 2);
    renderers[1]->hang(false);
}

TEST_P(FrameFaults, AFrameThatNobodyWantsEndsAndCostsTheNextNothing) {
    const auto renderers = openWith(2);
    const int begun = renderers[0]->begun;
    for (const auto& renderer : renderers) renderer->hang(true);
    std::stop_source stop;
    FrameRequest unwanted = request();
    unwanted.stop = stop.get_token();
    std::vector<std::jthread> asking;  // one is drawn, the others wait for their turns
    std::atomic<int> cancelled{0};
    for (int i = 0; i < 4; ++i)
        asking.emplace_back([&] {
            cancelled += absl::IsCancelled(pipeline_.renderFrame(unwanted).status()) ? 1 : 0;
        });
    EXPECT_TRUE(eventually([&] { return renderers[0]->begun > begun; }));
    stop.request_stop();
    asking.clear();
    EXPECT_EQ(cancelled, 4);
    for (const auto& renderer : renderers) renderer->hang(false);
    expectWholePicture();
    EXPECT_TRUE(isAlive(0) && isAlive(1));
    EXPECT_EQ(statusOf(0).condition, RendererCondition::Ready);
}

/// An interactive channel that takes 200 ms is given up.
class SlowChannels : public FramePipelineTest {
protected:
    SlowChannels() : FramePipelineTest(quickToGiveUp()) {}

    static FramePipelineOptions quickToGiveUp() {
        FramePipelineOptions options = FramePipelineTest::options("2D", std::chrono::seconds(20));
        options.callTimeouts.interactive = milliseconds(200);
        return options;
    }
    absl::Status drawnIn(milliseconds time, fabric::Completeness completeness) {
        const auto renderers = openWith(2);
        for (const auto& renderer : renderers) renderer->hang(true);
        const std::jthread later([&] {
            std::this_thread::sleep_for(time);
            for (const auto& renderer : renderers) renderer->hang(false);
        });
        FrameRequest asked = request();
        asked.completeness = completeness;
        return pipeline_.renderFrame(asked).status();
    }
};

TEST_F(SlowChannels, OfACompletePictureAreWaitedFor) {
    const absl::Status status = drawnIn(milliseconds(500), fabric::Completeness::Complete);
    EXPECT_TRUE(status.ok()) << status;
    EXPECT_TRUE(isAlive(0) && isAlive(1));
}

TEST_F(SlowChannels, OfAnInteractiveOneAreGivenUp) {
    const absl::Status status = drawnIn(milliseconds(500), fabric::Completeness::Interactive);
    EXPECT_TRUE(absl::IsDeadlineExceeded(status) || absl::IsUnavailable(status)) << status;
    EXPECT_FALSE(isAlive(0) || isAlive(1));
}

}  // namespace
}  // namespace eyrie::coordinator
