// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/load_balance.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::coordinator {
namespace {

/// Milliseconds that channels take where the work left of position x is `work(x)`.
std::vector<double> timesOf(const std::vector<double>& cuts,
                            const std::function<double(double)>& work) {
    std::vector<double> times;
    double before = 0;
    for (const double cut : cuts) {
        times.push_back(work(cut) - work(before));
        before = cut;
    }
    times.push_back(work(1) - work(before));
    return times;
}

TEST(LoadBalance, StartsWithEqualParts) {
    LoadBalance balance;
    EXPECT_TRUE(balance.cuts(1).empty());
    EXPECT_EQ(balance.cuts(4), (std::vector<double>{0.25, 0.5, 0.75}));
}

TEST(LoadBalance, FindsTheCutsThatMakeChannelsTakeEquallyLong) {
    // Nearly all of the work lies in the rightmost tenth.
    const auto work = [](double x) { return 4 * x + 400 * std::max(0.0, x - 0.9); };
    for (const int channels : {2, 3, 5}) {
        LoadBalance balance;
        for (int frame = 0; frame < 40; ++frame)
            balance.record(timesOf(balance.cuts(channels), work));
        for (const double time : timesOf(balance.cuts(channels), work))
            EXPECT_LT(time * channels, 44 * 1.06) << channels;
    }
}

TEST(LoadBalance, LeavesChannelsAloneThatTakeAboutEquallyLong) {
    LoadBalance balance;
    const std::vector<double> before = balance.cuts(2);
    balance.record(std::vector<double>{10.0, 10.5});
    EXPECT_EQ(balance.cuts(2), before);
}

TEST(LoadBalance, BeginsAnewWithAnotherNumberOfChannels) {
    LoadBalance balance;
    balance.cuts(2);
    balance.record(std::vector<double>{10.0, 30.0});
    EXPECT_GT(balance.cuts(2)[0], 0.5);
    EXPECT_EQ(balance.cuts(3), (std::vector<double>{1.0 / 3, 2.0 / 3}));
    EXPECT_EQ(balance.cuts(2), std::vector<double>{0.5});
}

RC_GTEST_PROP(LoadBalance, KeepsTheCutsAscendingWhateverTheTimes, ()) {
    LoadBalance balance;
    const int channels = *rc::gen::inRange(2, 9);
    for (int frame = 0; frame < 20; ++frame) {
        balance.cuts(channels);
        std::vector<double> times;
        for (int i = 0; i < channels; ++i) times.push_back(*rc::gen::inRange(0, 1000) / 10.0);
        balance.record(times);
        std::vector<double> edges = balance.cuts(channels);
        edges.insert(edges.begin(), 0.0);
        edges.push_back(1.0);
        for (std::size_t i = 1; i < edges.size(); ++i)
            RC_ASSERT(edges[i] - edges[i - 1] > 0.04 / channels);
    }
}

}  // namespace
}  // namespace eyrie::coordinator
