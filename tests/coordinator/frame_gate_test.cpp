// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_gate.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/service/eventually.h"

namespace eyrie::coordinator {
namespace {

class FrameGateTest : public testing::Test {
protected:
    /// Begins a frame on a thread of its own, and tells when it has begun and when it has ended.
    class Frame {
    public:
        explicit Frame(FrameGate& gate)
            : thread_([this, &gate] {
                  FrameGate::Pass pass(gate);
                  hasBegun = true;
                  pass.letNext();
                  while (!isOver && !endsInOrder) std::this_thread::yield();
                  if (!endsInOrder)
                      return;
                  pass.awaitEarlier();
                  isFirst = true;
              }) {}
        ~Frame() { isOver = true; }

        std::atomic<bool> hasBegun{false};
        std::atomic<bool> endsInOrder{false};
        std::atomic<bool> isFirst{false};

    private:
        std::atomic<bool> isOver{false};
        std::jthread thread_;
    };

    static bool begins(const Frame& frame) {
        return eventually([&] { return frame.hasBegun.load(); });
    }
    /// Long enough that one that may begin, or end, would have.
    static void waitAWhile() { std::this_thread::sleep_for(std::chrono::milliseconds(30)); }

    std::atomic<bool> isWorthwhile_{false};
    FrameGate gate_{[this] { return isWorthwhile_.load(); }};
};

TEST_F(FrameGateTest, NoneBeginsBeforeTheIntervalSinceTheLastIsOver) {
    using Clock = FrameGate::Clock;
    std::atomic<Clock::time_point> now{Clock::time_point(std::chrono::hours(1))};
    FrameGate gate([] { return true; }, [&] { return now.load(); });
    gate.setLimit(3);
    gate.setInterval(std::chrono::hours(2));
    const Frame first(gate);
    ASSERT_TRUE(begins(first));
    const Frame second(gate);
    now = Clock::time_point(std::chrono::hours(3)) - std::chrono::nanoseconds(1);
    gate.look();
    waitAWhile();
    EXPECT_FALSE(second.hasBegun);
    now = Clock::time_point(std::chrono::hours(3));
    gate.look();
    EXPECT_TRUE(begins(second));
    const Frame third(gate);
    waitAWhile();
    EXPECT_FALSE(third.hasBegun) << "it is the second that it comes after";
    gate.setInterval({});
    EXPECT_TRUE(begins(third));
}

TEST_F(FrameGateTest, OneThatIsNotWantedAnyMoreDoesNotWaitForTheInterval) {
    gate_.setInterval(std::chrono::hours(1));
    { const FrameGate::Pass first(gate_); }
    std::stop_source stop;
    std::jthread stopper([&] {
        waitAWhile();
        stop.request_stop();
    });
    EXPECT_FALSE(FrameGate::Pass(gate_, stop.get_token()).hasTurn());
}

TEST_F(FrameGateTest, OneBeginsAtOnceWhateverTheOthersWouldFind) {
    const Frame frame(gate_);
    EXPECT_TRUE(begins(frame));
}

TEST_F(FrameGateTest, AnotherBeginsWhenItHasBecomeWorthwhile) {
    gate_.setLimit(2);
    Frame first(gate_);
    ASSERT_TRUE(begins(first));
    Frame second(gate_);
    waitAWhile();
    EXPECT_FALSE(second.hasBegun);
    isWorthwhile_ = true;
    gate_.look();
    EXPECT_TRUE(begins(second));
}

TEST_F(FrameGateTest, NoMoreThanTheLimitAreUnderWay) {
    isWorthwhile_ = true;
    gate_.setLimit(2);
    auto first = std::make_unique<Frame>(gate_);
    ASSERT_TRUE(begins(*first));
    Frame second(gate_);
    ASSERT_TRUE(begins(second));
    Frame third(gate_);
    waitAWhile();
    EXPECT_FALSE(third.hasBegun);
    first.reset();
    EXPECT_TRUE(begins(third));
}

TEST_F(FrameGateTest, NoneBeginsBeforeTheLastHasItsRenderers) {
    isWorthwhile_ = true;
    gate_.setLimit(2);
    FrameGate::Pass first(gate_);
    Frame second(gate_);
    waitAWhile();
    EXPECT_FALSE(second.hasBegun);
    first.letNext();
    EXPECT_TRUE(begins(second));
    first.awaitEarlier();
}

TEST_F(FrameGateTest, AHigherLimitLetsThoseInThatWait) {
    isWorthwhile_ = true;
    Frame first(gate_);
    ASSERT_TRUE(begins(first));
    Frame second(gate_);
    waitAWhile();
    EXPECT_FALSE(second.hasBegun);
    gate_.setLimit(2);
    EXPECT_TRUE(begins(second));
}

TEST_F(FrameGateTest, FramesEndInTheOrderInWhichTheyBegan) {
    isWorthwhile_ = true;
    gate_.setLimit(2);
    Frame first(gate_);
    ASSERT_TRUE(begins(first));
    Frame second(gate_);
    ASSERT_TRUE(begins(second));
    second.endsInOrder = true;
    waitAWhile();
    EXPECT_FALSE(second.isFirst);
    first.endsInOrder = true;
    EXPECT_TRUE(eventually([&] { return second.isFirst.load(); }));
}

TEST_F(FrameGateTest, FramesBeginInTheOrderInWhichTheyWereAskedFor) {
    std::mutex mutex;
    std::vector<int> begun;
    auto first = std::make_unique<Frame>(gate_);
    ASSERT_TRUE(begins(*first));
    std::vector<std::jthread> others;
    std::atomic<int> asked{0};
    for (int i = 0; i < 5; ++i) {
        others.emplace_back([&, i] {
            ++asked;
            const FrameGate::Pass pass(gate_);
            const std::lock_guard lock(mutex);
            begun.push_back(i);
        });
        ASSERT_TRUE(eventually([&] { return asked == i + 1; }));
        waitAWhile();  // it is in line by then
    }
    first.reset();
    others.clear();
    EXPECT_EQ(begun, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST_F(FrameGateTest, ThoseBehindOneThatIsGivenUpMoveUp) {
    auto first = std::make_unique<Frame>(gate_);
    ASSERT_TRUE(begins(*first));
    std::stop_source stop;
    std::atomic<int> without{0};
    std::vector<std::jthread> givenUp;
    for (int i = 0; i < 3; ++i)
        givenUp.emplace_back([&] {
            const FrameGate::Pass pass(gate_, stop.get_token());
            without += pass.hasTurn() ? 0 : 1;
        });
    waitAWhile();  // they have tickets, before the next one's
    Frame last(gate_);
    waitAWhile();
    stop.request_stop();
    givenUp.clear();
    EXPECT_EQ(without, 3);
    EXPECT_FALSE(last.hasBegun) << "the first is still under way";
    first.reset();
    EXPECT_TRUE(begins(last));
}

}  // namespace
}  // namespace eyrie::coordinator
