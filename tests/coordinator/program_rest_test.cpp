// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/program_rest.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ProgramRest, DoublesWithEachFailureInARowToAMinute) {
    ProgramRest rest;
    ProgramRest::Clock::time_point now{seconds(1000)};
    EXPECT_TRUE(rest.isOver(now));
    for (const int length : {2, 4, 8, 16, 32, 60, 60}) {
        rest.failed(now);
        EXPECT_FALSE(rest.isOver(now + seconds(length) - milliseconds(1))) << length;
        now += seconds(length);
        EXPECT_TRUE(rest.isOver(now)) << length;
    }
    rest.succeeded();
    rest.failed(now);
    EXPECT_TRUE(rest.isOver(now + ProgramRest::kFirst));
}

TEST(ProgramRest, FramesThatFailTogetherAreOneFailure) {
    ProgramRest rest;
    const ProgramRest::Clock::time_point now{seconds(1000)};
    rest.failed(now);
    rest.failed(now + milliseconds(1));
    EXPECT_TRUE(rest.isOver(now + ProgramRest::kFirst));
}

}  // namespace
}  // namespace eyrie::coordinator
