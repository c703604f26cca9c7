// SPDX-License-Identifier: Apache-2.0
// Viewers of one session, each with a screen of its own, that show their pictures together.
#include "coordinator/stream/swap_barrier.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/session.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using coordinator::FrameRequest;
using coordinator::Shown;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

const Joining kLead{"wall", Role::Lead};
const Joining kWatch{"wall", Role::Watch};

/// A canvas of two screens behind one barrier, and one by itself.
coordinator::Status wallStatus() {
    coordinator::Status status = coordinator::readyStatus();
    status.canvases = {{.name = "wall",
                        .segments = {"left", "right", "side"},
                        .layouts = {"1"},
                        .layout = "1",
                        .barriers = {"", {"b", "b", ""}}}};
    return status;
}

v1::ViewerRequest screenMessage(const std::string& segment) {
    v1::ViewerRequest request;
    request.mutable_screen()->mutable_shown()->set_segment(segment);
    return request;
}

v1::ViewerRequest viewOf(std::uint64_t sequence, const std::string& segment) {
    v1::ViewerRequest request = viewMessage(sequence, static_cast<double>(sequence));
    request.mutable_view()->mutable_shown()->set_segment(segment);
    return request;
}

v1::ViewerRequest readyMessage(std::uint64_t swap) {
    v1::ViewerRequest request;
    request.mutable_ready()->set_swap(swap);
    return request;
}

/// The next word within `patience`; frames before it are an error.
std::optional<std::uint64_t> nextWord(Browser& browser,
                                      milliseconds patience = milliseconds(10'000)) {
    for (;;) {
        const std::optional<v1::ViewerResponse> response = browser.next(patience);
        if (!response)
            return std::nullopt;
        EXPECT_FALSE(response->has_frame()) << "a picture before the word for the one before";
        if (response->has_swap())
            return response->swap().swap();
    }
}

/// The next picture that waits for a word.
std::optional<v1::Frame> nextSwap(Browser& browser) {
    for (;;) {
        std::optional<v1::Frame> frame = browser.nextFrame();
        if (!frame || frame->swap() != 0)
            return frame;
        browser.acknowledge(frame->frame_number());
    }
}

class SwapBarrier : public testing::Test {
protected:
    explicit SwapBarrier(milliseconds patience = std::chrono::hours(1)) {
        frames_.setStatus(wallStatus());
        SessionOptions options = moving(2);
        options.swapPatience = patience;
        sessions_ = std::make_unique<Sessions>(frames_, options);
        left_ = std::make_unique<Browser>(*sessions_, kLead);
        right_ = std::make_unique<Browser>(*sessions_, kWatch);
    }

    /// Both have their screens and know that they are behind the barrier together.
    void hang() {
        left_->send(screenMessage("left"));
        right_->send(screenMessage("right"));
        left_->send(viewOf(1, "left"));
        for (Browser* one : {left_.get(), right_.get()})
            ASSERT_TRUE(one->stateWhere([](const v1::SessionState& state) {
                return state.place().barrier() == "b" && state.place().together() == 2;
            }));
    }

    /// Shows what there is until both have a picture of the same swap.
    std::uint64_t swapTogether() {
        auto first = nextSwap(*left_);
        auto second = nextSwap(*right_);
        EXPECT_TRUE(first && second);
        if (!first || !second)
            return 0;
        EXPECT_EQ(first->swap(), second->swap());
        left_->send(readyMessage(first->swap()));
        right_->send(readyMessage(first->swap()));
        EXPECT_EQ(nextWord(*left_), first->swap());
        EXPECT_EQ(nextWord(*right_), first->swap());
        left_->acknowledge(first->frame_number());
        right_->acknowledge(second->frame_number());
        return first->swap();
    }

    FakeFrameSource frames_;
    std::unique_ptr<Sessions> sessions_;
    std::unique_ptr<Browser> left_;
    std::unique_ptr<Browser> right_;
};

class SwapBarrierOfShortPatience : public SwapBarrier {
protected:
    SwapBarrierOfShortPatience() : SwapBarrier(milliseconds(50)) {}
};

TEST_F(SwapBarrier, GivesEachItsOwnScreenOfOneFrame) {
    hang();
    left_->send(viewOf(2, "left"));
    const auto first = nextSwap(*left_);
    const auto second = nextSwap(*right_);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->swap(), second->swap());
    EXPECT_NE(first->jpeg(), second->jpeg());
    const FrameRequest last = frames_.requests().back();
    EXPECT_THAT(last.shown, ElementsAre(Shown{.segment = "left"}, Shown{.segment = "right"}));
}

TEST_F(SwapBarrier, SaysNobodyToShowAPictureBeforeAllHaveIt) {
    hang();
    left_->send(viewOf(2, "left"));
    const auto first = nextSwap(*left_);
    const auto second = nextSwap(*right_);
    ASSERT_TRUE(first && second);
    left_->send(readyMessage(first->swap()));
    // Newer views are drawn meanwhile, and nobody is given them.
    left_->send(viewOf(3, "left"));
    EXPECT_EQ(nextWord(*left_, milliseconds(50)), std::nullopt);
    right_->send(readyMessage(second->swap()));
    EXPECT_EQ(nextWord(*left_), first->swap());
    EXPECT_EQ(nextWord(*right_), first->swap());
    left_->acknowledge(first->frame_number());
    right_->acknowledge(second->frame_number());
    EXPECT_GT(swapTogether(), first->swap());
}

TEST_F(SwapBarrier, GoesOnFromSwapToSwap) {
    hang();
    std::uint64_t last = 0;
    for (std::uint64_t i = 2; i < 12; ++i) {
        left_->send(viewOf(i, "left"));
        const std::uint64_t swap = swapTogether();
        ASSERT_GT(swap, last);
        last = swap;
    }
}

TEST_F(SwapBarrier, IsNotHeldUpByOneThatLeaves) {
    hang();
    left_->send(viewOf(2, "left"));
    const auto first = nextSwap(*left_);
    ASSERT_TRUE(first && nextSwap(*right_));
    left_->send(readyMessage(first->swap()));
    right_.reset();
    EXPECT_EQ(nextWord(*left_), first->swap());
    left_->acknowledge(first->frame_number());
    left_->send(viewOf(3, "left"));
    const auto alone = left_->nextFrame();
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->swap(), 0U) << "one alone waits for nobody";
}

TEST_F(SwapBarrier, TakesOneInThatComesInBetween) {
    hang();
    left_->send(viewOf(2, "left"));
    swapTogether();
    Browser third(*sessions_, kWatch);
    third.send(screenMessage("right"));
    const auto its = nextSwap(third);
    ASSERT_TRUE(its);
    EXPECT_EQ(nextWord(third, milliseconds(20)), std::nullopt) << "it has not said that it is ready";
    third.send(readyMessage(its->swap()));
    EXPECT_EQ(nextWord(third), its->swap());
}

TEST_F(SwapBarrier, ConcernsNobodyWhoseScreenIsNotBehindIt) {
    hang();
    Browser side(*sessions_, kWatch);
    side.send(screenMessage("side"));
    left_->send(viewOf(2, "left"));
    const auto first = nextSwap(*left_);
    ASSERT_TRUE(first && nextSwap(*right_));
    const auto free = side.nextFrame();
    ASSERT_TRUE(free);
    EXPECT_EQ(free->swap(), 0U);
    EXPECT_THAT(frames_.requests().back().shown, testing::Contains(Shown{.segment = "side"}));
}

TEST_F(SwapBarrier, IsNoneWhereTheConfigurationHasNone) {
    coordinator::Status status = wallStatus();
    status.canvases[0].barriers = {"", {"", "", ""}};
    frames_.setStatus(status);
    left_->send(screenMessage("left"));
    right_->send(screenMessage("right"));
    left_->send(viewOf(1, "left"));
    for (Browser* one : {left_.get(), right_.get()}) {
        const auto frame = one->nextFrame();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->swap(), 0U);
    }
}

TEST_F(SwapBarrierOfShortPatience, GoesOnWithoutOneThatStallsAndSaysSo) {
    hang();
    left_->send(viewOf(2, "left"));
    const auto first = nextSwap(*left_);
    ASSERT_TRUE(first);
    left_->send(readyMessage(first->swap()));
    // The other never says that it is ready.
    EXPECT_EQ(nextWord(*left_), first->swap());
    left_->acknowledge(first->frame_number());
    EXPECT_TRUE(left_->stateWhere(
        [](const v1::SessionState& state) { return state.place().behind() == 1; }));
    for (std::uint64_t i = 3; i < 8; ++i) {
        left_->send(viewOf(i, "left"));
        const auto next = nextSwap(*left_);
        ASSERT_TRUE(next);
        left_->send(readyMessage(next->swap()));
        ASSERT_EQ(nextWord(*left_), next->swap());
        left_->acknowledge(next->frame_number());
    }
}

TEST_F(SwapBarrier, TellsWhoAsksForAScreenThatIsNotThereAndDisturbsNobody) {
    frames_.setSeen([](const FrameRequest& request) -> absl::StatusOr<fabric::SeenAreas> {
        if (request.shown.front().segment == "nowhere")
            return absl::NotFoundError("no segment is called \"nowhere\"; there are \"left\"");
        return fabric::SeenAreas();
    });
    left_->send(screenMessage("left"));
    right_->send(screenMessage("nowhere"));
    left_->send(viewOf(1, "left"));
    const auto told = right_->stateWhere(
        [](const v1::SessionState& state) { return !state.problem().empty(); });
    ASSERT_TRUE(told);
    EXPECT_THAT(told->problem(), HasSubstr("no segment is called \"nowhere\"; there are"));
    ASSERT_TRUE(left_->nextFrame());
    for (const FrameRequest& request : frames_.requests())
        for (const Shown& shown : request.shown) EXPECT_NE(shown.segment, "nowhere");
}

TEST(SwapBarrierOf, FindsScreensByNameAndPosition) {
    const auto canvases = wallStatus().canvases;
    EXPECT_EQ(swapBarrierOf(canvases, {.segment = "left"}), "b");
    EXPECT_EQ(swapBarrierOf(canvases, {.canvas = "wall", .segment = "1"}), "b");
    EXPECT_EQ(swapBarrierOf(canvases, {.canvas = "0", .segment = "side"}), "");
    EXPECT_EQ(swapBarrierOf(canvases, {}), "");
    EXPECT_EQ(swapBarrierOf(canvases, {.segment = "nowhere"}), "");
    EXPECT_EQ(swapBarrierOf(canvases, {.canvas = "nowhere"}), "");
    EXPECT_EQ(swapBarrierOf({}, {.segment = "left"}), "");
}

}  // namespace
}  // namespace eyrie::stream
