// SPDX-License-Identifier: Apache-2.0
#include "service/rejoin_pause.h"

#include <gtest/gtest.h>

namespace eyrie::service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(RejoinPause, DoublesFromHalfASecondToThirtyWhileRegistrationsDoNotHold) {
    RejoinPause pause;
    for (const int expected : {0, 500, 1000, 2000, 4000, 8000, 16'000, 30'000, 30'000})
        EXPECT_EQ(pause.after(seconds(1)), milliseconds(expected));
}

TEST(RejoinPause, IsNoneAfterARegistrationThatHeld) {
    RejoinPause pause;
    for (int i = 0; i < 5; ++i) pause.after(seconds(1));
    EXPECT_EQ(pause.after(seconds(10)), milliseconds(0));
    EXPECT_EQ(pause.after(seconds(1)), milliseconds(500));
}

}  // namespace
}  // namespace eyrie::service
