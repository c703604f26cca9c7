// SPDX-License-Identifier: Apache-2.0
#include "fabric/frame_budget.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

constexpr double kBudget = 33;

TEST(TauForBudget, IsTheSmallestOfTheLadderThatFits) {
    const CutTriangles triangles = [](double tau) { return static_cast<std::uint64_t>(1e6 / tau); };
    for (const double last : {0.0, 1.0, 3.0, 16.0, 1000.0}) {
        const BudgetUse use = tauForBudget(0.5, {kBudget, 3, 1e-4, last}, 1, triangles);
        EXPECT_LE(use.predictedMilliseconds, kBudget) << last;
        EXPECT_EQ(use.triangles, triangles(use.tauPixels));
        // From a tau where more than was aimed at is foreseen, less than all, it does not move.
        const double finer = 3 + 1e-4 * 1e6 / (use.tauPixels * std::exp2(-0.25));
        EXPECT_GT(finer, kBudgetAim * kBudget) << last;
    }
}

TEST(TauForBudget, NeverGoesBelowWhatIsAskedForNorAboveTheCoarsest) {
    const CutTriangles none = [](double) { return std::uint64_t{0}; };
    const CutTriangles many = [](double) { return std::uint64_t{1} << 60; };
    EXPECT_EQ(tauForBudget(0.7, {kBudget, 3, 1e-4, 4}, 1, none).tauPixels, 0.7);
    EXPECT_EQ(tauForBudget(0.7, {kBudget, 3, 1e-4, 4}, 1, many).tauPixels, 16);
    EXPECT_EQ(tauForBudget(100, {kBudget, 3, 1e-4, 4}, 1, many).tauPixels, 100);
    EXPECT_FALSE(tauForBudget(0.7, {kBudget, 3, 1e-4, 4}, 1, many).isMet());
    EXPECT_FALSE(tauForBudget(0.7, {kBudget, 100, 0, 4}, 1, none).isMet());
}

/// A cut takes time to be made: once where the last tau serves.
TEST(TauForBudget, MakesFewCuts) {
    int cuts = 0;
    const CutTriangles triangles = [&cuts](double tau) {
        ++cuts;
        return static_cast<std::uint64_t>(1e6 / std::pow(tau, 1.5));
    };
    FrameBudget budget{kBudget, 3, 1e-4, 0};
    budget.lastTauPixels = tauForBudget(0.5, budget, 1, triangles).tauPixels;
    EXPECT_LE(cuts, 6);
    cuts = 0;
    tauForBudget(0.5, budget, 1, triangles);
    EXPECT_LE(cuts, 2);
    budget.lastTauPixels *= 4;
    cuts = 0;
    tauForBudget(0.5, budget, 1, triangles);
    EXPECT_LE(cuts, 4);
}

TEST(FrameBudget, ATimeThatIsNoneIsRefused) {
    for (const double wrong : {0.0, -5.0, 0.5, 20'000.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()})
        EXPECT_TRUE(absl::IsInvalidArgument(validateBudgetMilliseconds(wrong))) << wrong;
    EXPECT_TRUE(validateBudgetMilliseconds(33).ok());
}

}  // namespace
}  // namespace eyrie::fabric
