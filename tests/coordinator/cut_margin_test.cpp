// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/cut_margin.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

TEST(CutMargin, HoldsItsShareOfNewViews) {
    std::mt19937 random(7);
    std::normal_distribution<double> doublings(0, 0.5);
    CutMargin margin;
    EXPECT_EQ(margin.factor(), 1);
    int longer = 0;
    constexpr int kViews = 2000;
    for (int i = 0; i < kViews; ++i) {
        const double taken = 100 * std::exp2(doublings(random));
        longer += taken > 100 * margin.factor() ? 1 : 0;
        margin.record(100, taken, 1);
    }
    EXPECT_NEAR(longer, (1 - CutMargin::kQuantile) * kViews, 0.05 * kViews);
    for (int i = 0; i < 100; ++i) margin.record(100, 1e6, 1);
    EXPECT_DOUBLE_EQ(margin.factor(), 2);
    for (int i = 0; i < 100; ++i) margin.record(1e6, 100, 1);
    EXPECT_EQ(margin.factor(), 1);
}

}  // namespace
}  // namespace eyrie::coordinator
