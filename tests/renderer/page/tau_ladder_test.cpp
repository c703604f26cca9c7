// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/tau_ladder.h"

#include <gtest/gtest.h>

namespace eyrie::page {
namespace {

/// Bytes that fall by a tenth with each step.
auto needing(double bytes) {
    return [=](int step) { return static_cast<std::uint64_t>(bytes * std::pow(0.9, step)); };
}

TEST(TauLadder, StaysDownWhileAllFits) {
    TauLadder ladder;
    const auto choice = ladder.follow(needing(1000), 1000);
    EXPECT_EQ(choice.step, 0);
    EXPECT_TRUE(choice.isLowest);
}

TEST(TauLadder, RisesAtOnceToTheLowestStepThatFits) {
    for (const double need : {1001.0, 2000.0, 50'000.0}) {
        TauLadder ladder;
        const auto choice = ladder.follow(needing(need), 1000);
        EXPECT_LE(needing(need)(choice.step), 1000U);
        EXPECT_GT(needing(need)(choice.step - 1), 1000U);
        EXPECT_TRUE(choice.isLowest);
        TauLadder other;
        EXPECT_EQ(other.settle(needing(need), 1000).step, choice.step);
    }
}

TEST(TauLadder, StaysOnItsLastStepWhenNothingFits) {
    TauLadder ladder;
    EXPECT_EQ(ladder.follow(needing(1e15), 1).step, TauLadder::kSteps);
}

TEST(TauLadder, FallsAStepAFrameAndOnlyWellBelowTheLimit) {
    TauLadder ladder;
    const int high = ladder.follow(needing(4000), 1000).step;
    ASSERT_GT(high, 3);
    EXPECT_EQ(ladder.follow(needing(1500), 1000).step, high - 1);
    EXPECT_EQ(ladder.follow(needing(1500), 1000).step, high - 2);
    int last = high - 2;
    for (int i = 0; i < 20; ++i) last = ladder.follow(needing(1500), 1000).step;
    EXPECT_GT(needing(1500)(last - 1), 900U) << "the next step would be too near the limit";
    EXPECT_EQ(ladder.settle(needing(1500), 1000).step, 4);
}

TEST(TauLadder, DoesNotSwingWhenTheNeedDoes) {
    TauLadder ladder;
    ladder.follow(needing(2000), 1000);
    const int step = ladder.follow(needing(2040), 1000).step;
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(ladder.follow(needing(i % 2 == 0 ? 1960 : 2040), 1000).step, step);
}

}  // namespace
}  // namespace eyrie::page
