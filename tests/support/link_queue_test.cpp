// SPDX-License-Identifier: Apache-2.0
#include "tests/support/link_queue.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using Clock = LinkQueue::Clock;
using Line = LinkQueue::Line;

constexpr std::size_t kPacketBytes = 1500;
constexpr Clock::time_point kStart{};

LinkQueue::Packet packet(int number = 0) {
    LinkQueue::Packet bytes(kPacketBytes, '\0');
    bytes[0] = static_cast<char>(number);
    return bytes;
}

/// When each packet arrives, asked every `interval` until nothing more is under way.
std::vector<Clock::duration> arrivals(LinkQueue& queue, const Line& line, Clock::duration interval,
                                      Clock::time_point now = kStart) {
    std::vector<Clock::duration> times;
    for (; queue.next(); now += interval)
        while (queue.take(line, now)) times.push_back(now - kStart);
    return times;
}

TEST(LinkQueue, WithoutARateDelaysPacketsOnly) {
    LinkQueue queue;
    const Line line{0, milliseconds(25)};
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(queue.put(packet(), line, kStart));
    EXPECT_FALSE(queue.take(line, kStart + milliseconds(25) - microseconds(1)));
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(queue.take(line, kStart + milliseconds(25))) << i;
    EXPECT_FALSE(queue.next());
}

TEST(LinkQueue, SendsOnePacketAfterTheOther) {
    LinkQueue queue;
    const Line line{12e6, milliseconds(25)};  // a millisecond each
    for (int i = 0; i < 3; ++i) queue.put(packet(), line, kStart);
    EXPECT_EQ(arrivals(queue, line, microseconds(500)),
              (std::vector<Clock::duration>{milliseconds(26), milliseconds(27), milliseconds(28)}));
}

TEST(LinkQueue, IsNoSlowerWhenAskedSeldom) {
    LinkQueue queue;
    const Line line{12e6, milliseconds(0)};
    for (int i = 0; i < 100; ++i) queue.put(packet(), line, kStart);
    int count = 0;
    while (queue.take(line, kStart + milliseconds(100))) ++count;
    EXPECT_EQ(count, 100);
}

TEST(LinkQueue, AnIdleLineSavesNoTimeUp) {
    LinkQueue queue;
    const Line line{12e6, milliseconds(0)};
    const Clock::time_point later = kStart + milliseconds(500);
    queue.put(packet(), line, later);
    queue.put(packet(), line, later);
    EXPECT_EQ(arrivals(queue, line, milliseconds(1), later),
              (std::vector<Clock::duration>{milliseconds(501), milliseconds(502)}));
}

TEST(LinkQueue, LosesWhatItHasNoRoomFor) {
    LinkQueue queue;
    const Line line{12e6, milliseconds(0)};
    int taken = 0;
    for (int i = 0; i < 1000; ++i) taken += queue.put(packet(), line, kStart) ? 1 : 0;
    // One is on the line.
    EXPECT_EQ(static_cast<std::size_t>(taken), 1 + LinkQueue::kQueueBytes / kPacketBytes);
    EXPECT_FALSE(queue.put(packet(), line, kStart + microseconds(999)));
    EXPECT_TRUE(queue.put(packet(), line, kStart + microseconds(1000)));
}

TEST(LinkQueue, ANewRateIsForWhatStillWaits) {
    LinkQueue queue;
    const Line fast{12e6, milliseconds(0)};
    const Line slow{1.2e6, milliseconds(0)};
    for (int i = 0; i < 4; ++i) queue.put(packet(), fast, kStart);
    EXPECT_TRUE(queue.take(fast, kStart + milliseconds(1)));  // the second has begun
    EXPECT_EQ(arrivals(queue, slow, milliseconds(1), kStart + milliseconds(1)),
              (std::vector<Clock::duration>{milliseconds(2), milliseconds(12), milliseconds(22)}));
}

RC_GTEST_PROP(LinkQueue, KeepsOrderAndIsNeverFasterThanItsLine, ()) {
    LinkQueue queue;
    const Line line{*rc::gen::inRange(1, 100) * 1e6, milliseconds(*rc::gen::inRange(0, 50))};
    Clock::time_point now = kStart;
    std::vector<int> put;
    std::vector<int> taken;
    std::vector<Clock::time_point> times;
    const auto takeAll = [&] {
        while (const auto next = queue.take(line, now)) {
            taken.push_back(static_cast<unsigned char>(next->front()));
            times.push_back(now);
        }
    };
    const int count = *rc::gen::inRange(1, 250);
    for (int i = 0; i < count; ++i) {
        now += microseconds(*rc::gen::inRange(0, 2000));
        takeAll();
        if (queue.put(packet(i), line, now))
            put.push_back(i);
    }
    while (const auto next = queue.next()) {
        now = std::max(now, *next);
        takeAll();
    }
    RC_ASSERT(taken == put);
    // Times are whole nanoseconds.
    const double seconds = std::chrono::duration<double>(times.back() - kStart).count();
    const auto packets = static_cast<double>(taken.size());
    RC_ASSERT(8.0 * kPacketBytes * packets <= line.bitsPerSecond * (seconds + 1e-9 * packets));
}

}  // namespace
}  // namespace eyrie::test
