// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/patience.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;

const PatienceOptions kOptions{milliseconds(10'000), milliseconds(500), 3};

TEST(Patience, IsLongWhileNothingIsKnown) {
    Patience patience(kOptions);
    EXPECT_EQ(patience.limit(), milliseconds(10'000));
    patience.record(milliseconds(1));
    patience.forget();
    EXPECT_EQ(patience.limit(), milliseconds(10'000));
}

TEST(Patience, IsThreeTimesTheRecentMedian) {
    Patience patience(kOptions);
    for (const int taken : {400, 9000, 300, 350, 20}) patience.record(milliseconds(taken));
    EXPECT_EQ(patience.limit(), milliseconds(3 * 350));
}

TEST(Patience, HasALeastLimit) {
    Patience patience(kOptions);
    patience.record(milliseconds(5));
    EXPECT_EQ(patience.limit(), milliseconds(500));
}

TEST(Patience, FollowsARendererThatHasBecomeSlower) {
    Patience patience(kOptions);
    for (int i = 0; i < 100; ++i) patience.record(milliseconds(200));
    for (int i = 0; i < 8; ++i) patience.record(milliseconds(1000));
    EXPECT_EQ(patience.limit(), milliseconds(3000));
}

}  // namespace
}  // namespace eyrie::coordinator
