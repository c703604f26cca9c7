// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/payoff.h"

#include <gtest/gtest.h>

namespace eyrie::occlusion {
namespace {

constexpr int kFrames = 640;

/// How many of so many frames look, where `hidden` of 100,000 triangles are.
int looks(Payoff& payoff, std::uint64_t hidden, double milliseconds = 1) {
    int count = 0;
    for (int i = 0; i < kFrames; ++i)
        if (payoff.isDue()) {
            ++count;
            const std::uint64_t leftOut = payoff.pays() ? hidden : 0;
            payoff.add({milliseconds, 30 * (1 - static_cast<double>(leftOut) / 100'000),
                        100'000 - leftOut, hidden});
        }
    return count;
}

TEST(Payoff, LooksNowAndThenWhereNothingIsHidden) {
    Payoff payoff;
    EXPECT_EQ(looks(payoff, 0), kFrames / Payoff::kPause);
    EXPECT_FALSE(payoff.pays());
}

TEST(Payoff, LooksAlwaysWhereMuchIsHidden) {
    Payoff payoff;
    EXPECT_EQ(looks(payoff, 50'000), kFrames);
    EXPECT_TRUE(payoff.pays());
}

TEST(Payoff, StopsSoonAfterTheViewOpensAndStartsWhenItCloses) {
    Payoff payoff;
    looks(payoff, 50'000);
    EXPECT_LT(looks(payoff, 0), kFrames / Payoff::kPause + 25);
    EXPECT_GE(looks(payoff, 50'000), kFrames - Payoff::kPause);
}

TEST(Payoff, SurvivesOneSlowFrame) {
    Payoff payoff;
    looks(payoff, 50'000);
    payoff.add({20, 15, 50'000, 50'000});
    EXPECT_TRUE(payoff.pays());
}

TEST(Payoff, WeighsWhatIsSavedAgainstWhatLookingTakes) {
    // 2,000 triangles of 0.3 microseconds, of which half counts: 0.3 ms.
    Payoff cheap;
    EXPECT_EQ(looks(cheap, 2'000, 0.2), kFrames);
    Payoff dear;
    EXPECT_EQ(looks(dear, 2'000, 0.4), kFrames / Payoff::kPause);
}

TEST(Payoff, OfAnEmptyPictureIsNone) {
    Payoff payoff;
    payoff.add({0.5, 0.1, 0, 0});
    EXPECT_FALSE(payoff.pays());
}

}  // namespace
}  // namespace eyrie::occlusion
