// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/clock_map.h"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::observe {
namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;
using Time = std::chrono::steady_clock::time_point;

/// Another process's clock, ahead by `ahead` at the start and fast by `rate`.
struct OtherClock {
    std::int64_t ahead = 0;
    double rate = 0;

    nanoseconds at(std::int64_t here) const {
        return nanoseconds(here + ahead + std::llround(rate * static_cast<double>(here)));
    }
};

/// A call that begins at `begin` and takes so long on its way, there, and on its way back.
Exchange call(const OtherClock& clock, std::int64_t begin, std::int64_t out, std::int64_t there,
              std::int64_t back) {
    return {Time(nanoseconds(begin)), clock.at(begin + out), clock.at(begin + out + there),
            Time(nanoseconds(begin + out + there + back))};
}

RC_GTEST_PROP(ClockMap, IsNeverFartherOffThanItSays, ()) {
    const OtherClock clock{*rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000'000),
                           static_cast<double>(*rc::gen::inRange(-100, 101)) * 1e-6};
    ClockMap map;
    std::int64_t now = *rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000);
    for (int i = 0; i < 20; ++i) {
        const auto delay = [] { return *rc::gen::inRange<std::int64_t>(0, 30'000'000); };
        const Exchange exchange = call(clock, now, delay(), delay(), delay());
        const auto offset = map.note(exchange);
        RC_ASSERT(offset.has_value());
        now = nanoseconds(exchange.came.time_since_epoch()).count();
        const std::int64_t truth = now - clock.at(now).count();
        // What the rates alone move during a call is below a microsecond here, and is kDrift's.
        RC_ASSERT(std::abs(offset->offset.count() - truth) <= offset->bound.count() + 20'000);
        // No end of what was done there is outside of the call.
        RC_ASSERT(offset->here(exchange.received) >= exchange.sent);
        RC_ASSERT(offset->here(exchange.answered) <= exchange.came);
        now += *rc::gen::inRange<std::int64_t>(0, 1'000'000'000);
    }
}

TEST(ClockMap, LearnsFromTheFastestCallInEachDirection) {
    const OtherClock clock{5'000'000'000};
    ClockMap map;
    EXPECT_EQ(map.note(call(clock, 0, 10'000'000, 0, 10'000'000))->bound, microseconds(10'000));
    // Fast on its way there, and then on its way back: both ends of the interval are near.
    ASSERT_TRUE(map.note(call(clock, 30'000'000, 1'000, 0, 10'000'000)).has_value());
    const auto offset = map.note(call(clock, 50'000'000, 10'000'000, 0, 1'000));
    EXPECT_LT(offset->bound, microseconds(10));
    EXPECT_NEAR(static_cast<double>(offset->offset.count()), -5e9, 1e4);
}

TEST(ClockMap, BeginsAnewWhereTheClockHasJumped) {
    ClockMap map;
    ASSERT_TRUE(map.note(call({0}, 0, 1'000, 0, 1'000)).has_value());
    const auto offset = map.note(call({1'000'000'000}, 1'000'000, 1'000, 0, 1'000));
    ASSERT_TRUE(offset.has_value());
    EXPECT_NEAR(static_cast<double>(offset->offset.count()), -1e9, 2e3);
}

TEST(ClockMap, TakesNothingThatNoClocksCanHaveSeen) {
    const Exchange longerThere{Time(nanoseconds(100)), nanoseconds(0), nanoseconds(500),
                               Time(nanoseconds(200))};
    const Exchange backwards{Time(nanoseconds(100)), nanoseconds(50), nanoseconds(40),
                             Time(nanoseconds(200))};
    const Exchange absurd{Time(nanoseconds(100)), nanoseconds::max() - nanoseconds(1),
                          nanoseconds::max(), Time(nanoseconds(200))};
    const Exchange negative{Time(nanoseconds(100)), nanoseconds::min(), nanoseconds(0),
                            Time(nanoseconds(200))};
    ClockMap map;
    for (const Exchange& exchange : {longerThere, backwards, absurd, negative})
        EXPECT_FALSE(map.note(exchange).has_value());
}

}  // namespace
}  // namespace eyrie::observe
