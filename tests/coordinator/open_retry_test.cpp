// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/open_retry.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(OpenRetry, PausesDoubleFromOneSecondToThirty) {
    OpenRetry retry;
    OpenRetry::Clock::time_point now{seconds(1000)};
    for (const int pause : {1, 2, 4, 8, 16, 30, 30}) {
        retry.noteFailure(now);
        EXPECT_FALSE(retry.takeTurn(now + seconds(pause) - milliseconds(1))) << pause;
        now += seconds(pause);
        EXPECT_TRUE(retry.takeTurn(now)) << pause;
    }
}

TEST(OpenRetry, ThereIsOneTurnAFailure) {
    OpenRetry retry;
    const OpenRetry::Clock::time_point end{seconds(1000)};
    EXPECT_FALSE(retry.takeTurn(end));
    retry.noteFailure({});
    EXPECT_TRUE(retry.takeTurn(end));
    EXPECT_FALSE(retry.takeTurn(end));
}

}  // namespace
}  // namespace eyrie::coordinator
