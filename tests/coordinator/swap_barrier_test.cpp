// SPDX-License-Identifier: Apache-2.0
// Viewers of one session, each with a screen of its own, that show their pictures together.
#include "coordinator/stream/swap_barrier.h"

#include <atomic>
#include <chrono>
#include <future>
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

Shown screen(const std::string& segment, const std::string& canvas = {}) {
    return {canvas, segment, {}, {}};
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

/// A page with a screen: shows at once what does not wait, and the rest at the word.
class Page {
public:
    Page(Sessions& sessions, const Joining& joining) : browser_(sessions, joining) {}

    void send(const v1::ViewerRequest& request) { browser_.send(request); }

    /// Takes what comes within a moment, if anything does.
    void pump() {
        const std::optional<v1::ViewerResponse> response = browser_.next(milliseconds(2));
        if (!response)
            return;
        if (response->has_state())
            state_ = response->state();
        else if (response->has_frame())
            arrived(response->frame());
        else if (response->has_swap())
            told(response->swap().swap());
    }

    /// Says that what it keeps is decoded.
    void sayReady() {
        ASSERT_TRUE(kept_.has_value());
        send(readyMessage(kept_->swap()));
    }

    /// From now on it does so by itself, or not any more.
    void setPrompt(bool isPrompt) {
        isPrompt_ = isPrompt;
        if (isPrompt && kept_)
            sayReady();
    }

    /// Others may go on without it.
    void setMayBeBehind() { mayBeBehind_ = true; }

    const v1::SessionState& state() const { return state_; }
    const std::optional<v1::Frame>& kept() const { return kept_; }
    const std::optional<v1::Frame>& shown() const { return shown_; }
    std::uint64_t shownSwap() const { return shown_ ? shown_->swap() : 0; }

private:
    void arrived(const v1::Frame& frame) {
        EXPECT_FALSE(kept_ && frame.swap() != 0 && !mayBeBehind_)
            << "a picture before the word for the one before";
        if (frame.swap() == 0)
            return show(frame);
        kept_ = frame;
        if (isPrompt_)
            sayReady();
    }

    void told(std::uint64_t swap) {
        if (!kept_ || kept_->swap() != swap)
            return;
        show(*kept_);
        kept_.reset();
    }

    void show(const v1::Frame& frame) {
        shown_ = frame;
        browser_.acknowledge(frame.frame_number());
    }

    Browser browser_;
    bool isPrompt_ = true;
    bool mayBeBehind_ = false;
    v1::SessionState state_;
    std::optional<v1::Frame> kept_;
    std::optional<v1::Frame> shown_;
};

class SwapBarrier : public testing::Test {
protected:
    explicit SwapBarrier(milliseconds patience = std::chrono::hours(1)) {
        frames_.setStatus(wallStatus());
        SessionOptions options = moving(2);
        options.swapPatience = patience;
        sessions_ = std::make_unique<Sessions>(frames_, options);
        left_ = std::make_unique<Page>(*sessions_, kLead);
        right_ = std::make_unique<Page>(*sessions_, kWatch);
        left_->send(screenMessage("left"));
        right_->send(screenMessage("right"));
    }

    /// Whether that comes to be, while all take what comes; of those there are.
    template <typename Predicate>
    bool comes(Predicate isSo, std::vector<Page*> others = {}) {
        const auto deadline = Clock::now() + std::chrono::seconds(20);
        while (!isSo()) {
            if (Clock::now() > deadline)
                return false;
            for (Page* one : {left_.get(), right_.get()})
                if (one != nullptr)
                    one->pump();
            for (Page* one : others) one->pump();
        }
        return true;
    }

    /// Both know that they are behind the barrier together, and show a picture; nothing is under
    /// way. From now on they are ready when they are told to be.
    void hang() {
        left_->send(viewOf(1, "left"));
        const auto isTogether = [](const Page& page) {
            return page.state().place().barrier() == "b" && page.state().place().together() == 2;
        };
        ASSERT_TRUE(comes([&] { return isTogether(*left_) && isTogether(*right_); }));
        look(2);
        ASSERT_TRUE(comes([&] { return showBoth(2); }));
        left_->setPrompt(false);
        right_->setPrompt(false);
    }

    void look(std::uint64_t sequence) { left_->send(viewOf(sequence, "left")); }

    /// That view of the leader's, each by its own screen.
    bool showBoth(std::uint64_t sequence) const {
        return left_->shown() && right_->shown() && left_->shown()->view_sequence() == sequence &&
               right_->shown()->led_view().sequence() == sequence;
    }

    bool keepBoth() const { return left_->kept() && right_->kept(); }

    FakeFrameSource frames_;
    std::unique_ptr<Sessions> sessions_;
    std::unique_ptr<Page> left_;
    std::unique_ptr<Page> right_;
};

class SwapBarrierOfShortPatience : public SwapBarrier {
protected:
    SwapBarrierOfShortPatience() : SwapBarrier(milliseconds(100)) {}
};

TEST_F(SwapBarrier, GivesEachItsOwnScreenOfOneFrame) {
    hang();
    look(3);
    ASSERT_TRUE(comes([&] { return keepBoth(); }));
    EXPECT_EQ(left_->kept()->swap(), right_->kept()->swap());
    EXPECT_NE(left_->kept()->jpeg(), right_->kept()->jpeg());
    EXPECT_THAT(frames_.requests().back().shown, ElementsAre(screen("left"), screen("right")));
}

TEST_F(SwapBarrier, SaysNobodyToShowAPictureBeforeAllHaveIt) {
    hang();
    look(3);
    ASSERT_TRUE(comes([&] { return keepBoth(); }));
    left_->sayReady();
    // A newer view is drawn meanwhile, and nobody is given it.
    const std::size_t drawn = frames_.requests().size();
    look(4);
    ASSERT_TRUE(comes([&] { return frames_.requests().size() > drawn; }));
    for (int i = 0; i < 20; ++i) {
        left_->pump();
        right_->pump();
    }
    EXPECT_TRUE(keepBoth()) << "one showed it before the other had it";
    EXPECT_EQ(left_->shown()->view_sequence(), 2U);
    right_->sayReady();
    ASSERT_TRUE(comes([&] { return showBoth(3); }));
    left_->setPrompt(true);
    right_->setPrompt(true);
    EXPECT_TRUE(comes([&] { return showBoth(4); }));
}

TEST_F(SwapBarrier, GoesOnFromSwapToSwap) {
    hang();
    left_->setPrompt(true);
    right_->setPrompt(true);
    for (std::uint64_t i = 3; i < 13; ++i) {
        look(i);
        ASSERT_TRUE(comes([&] { return showBoth(i); })) << i;
        EXPECT_EQ(left_->shownSwap(), right_->shownSwap());
        EXPECT_NE(left_->shownSwap(), 0U);
    }
}

TEST_F(SwapBarrier, IsNotHeldUpByOneThatLeaves) {
    hang();
    look(3);
    ASSERT_TRUE(comes([&] { return keepBoth(); }));
    left_->sayReady();
    right_.reset();
    ASSERT_TRUE(comes([&] { return left_->shown()->view_sequence() == 3; }));
    look(4);
    ASSERT_TRUE(comes([&] { return left_->shown()->view_sequence() == 4; }));
    EXPECT_EQ(left_->shownSwap(), 0U) << "one alone waits for nobody";
}

TEST_F(SwapBarrier, TakesOneInThatComesInBetween) {
    hang();
    Page third(*sessions_, kWatch);
    third.setPrompt(false);
    third.send(screenMessage("right"));
    ASSERT_TRUE(comes([&] { return third.kept().has_value(); }, {&third}));
    EXPECT_FALSE(left_->kept()) << "the others show that already";
    // What came before it said which its screen is, is the leader's.
    third.setPrompt(true);
    EXPECT_TRUE(
        comes([&] { return third.shown() && third.shown()->jpeg() == right_->shown()->jpeg(); },
              {&third}));
}

TEST_F(SwapBarrier, ConcernsNobodyWhoseScreenIsNotBehindIt) {
    hang();
    Page side(*sessions_, kWatch);
    side.send(screenMessage("side"));
    look(3);
    ASSERT_TRUE(comes([&] { return keepBoth(); }, {&side}));
    ASSERT_TRUE(
        comes([&] { return side.shown() && side.shown()->led_view().sequence() == 3; }, {&side}));
    EXPECT_EQ(side.shownSwap(), 0U);
    EXPECT_TRUE(keepBoth());
    EXPECT_THAT(frames_.requests().back().shown, testing::Contains(screen("side")));
}

TEST_F(SwapBarrier, IsNoneWhereTheConfigurationHasNone) {
    coordinator::Status status = wallStatus();
    status.canvases[0].barriers = {"", {"", "", ""}};
    frames_.setStatus(status);
    left_->setPrompt(false);
    right_->setPrompt(false);
    look(1);
    ASSERT_TRUE(comes([&] { return showBoth(1); }));
    EXPECT_EQ(left_->shownSwap() + right_->shownSwap(), 0U);
    EXPECT_EQ(left_->state().place().barrier(), "");
}

TEST_F(SwapBarrierOfShortPatience, GoesOnWithoutOneThatStallsAndSaysSo) {
    right_->setMayBeBehind();
    right_->setPrompt(false);
    for (std::uint64_t i = 1; i < 6; ++i) {
        look(i);
        ASSERT_TRUE(comes([&] { return left_->shown() && left_->shown()->view_sequence() == i; }))
            << "held up at " << i;
    }
    ASSERT_TRUE(comes([&] { return left_->state().place().behind() >= 1; }));
    EXPECT_EQ(left_->state().place().together(), 2);
}

TEST_F(SwapBarrier, TellsWhoAsksForAScreenThatIsNotThereAndDisturbsNobody) {
    frames_.setSeen([](const FrameRequest& request) -> absl::StatusOr<fabric::SeenAreas> {
        if (request.shown.front().segment == "nowhere")
            return absl::NotFoundError("no segment is called \"nowhere\"; there are \"left\"");
        return fabric::SeenAreas();
    });
    right_->send(screenMessage("nowhere"));
    look(1);
    ASSERT_TRUE(comes([&] { return !right_->state().problem().empty(); }));
    EXPECT_THAT(right_->state().problem(),
                HasSubstr("no segment is called \"nowhere\"; there are"));
    ASSERT_TRUE(comes([&] { return left_->shown().has_value(); }));
    EXPECT_EQ(left_->state().problem(), "");
    for (const FrameRequest& request : frames_.requests())
        for (const Shown& shown : request.shown) EXPECT_NE(shown.segment, "nowhere");
}

/// What is found last is what is told, however long it took to find what was so before.
TEST_F(SwapBarrier, LooksForAScreenAgainWhereTheSourceHasChangedMeanwhile) {
    std::promise<void> mayAnswer;
    std::atomic<int> asked = 0;
    frames_.setSeen([&, answer = mayAnswer.get_future().share()](
                        const FrameRequest& request) -> absl::StatusOr<fabric::SeenAreas> {
        if (request.shown.front().segment != "later")
            return fabric::SeenAreas();
        if (++asked > 1)
            return fabric::SeenAreas();
        answer.wait();
        return absl::NotFoundError("no segment is called \"later\"");
    });
    right_->send(screenMessage("later"));
    ASSERT_TRUE(comes([&] { return asked == 1; }));
    coordinator::Status status = wallStatus();
    status.canvases.front().segments.emplace_back("later");
    frames_.setStatus(status);
    const auto pumpFor = [&](milliseconds time) {
        for (const auto end = Clock::now() + time; Clock::now() < end;) right_->pump();
    };
    pumpFor(milliseconds(50));
    mayAnswer.set_value();
    ASSERT_TRUE(comes([&] { return asked == 2; }));
    pumpFor(milliseconds(50));
    EXPECT_EQ(right_->state().problem(), "");
}

TEST(SwapBarrierOf, FindsScreensByNameAndPosition) {
    const auto canvases = wallStatus().canvases;
    EXPECT_EQ(swapBarrierOf(canvases, screen("left")), "b");
    EXPECT_EQ(swapBarrierOf(canvases, screen("1", "wall")), "b");
    EXPECT_EQ(swapBarrierOf(canvases, screen("side", "0")), "");
    EXPECT_EQ(swapBarrierOf(canvases, {}), "");
    EXPECT_EQ(swapBarrierOf(canvases, screen("nowhere")), "");
    EXPECT_EQ(swapBarrierOf(canvases, screen("", "nowhere")), "");
    EXPECT_EQ(swapBarrierOf({}, screen("left")), "");
}

}  // namespace
}  // namespace eyrie::stream
