// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/memory_shares.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::draw {
namespace {

using testing::ElementsAre;
using Bytes = std::vector<std::uint64_t>;

TEST(MemoryShares, WhatAllCanUseTheyHaveWhereThereIsEnough) {
    EXPECT_THAT(memoryShares(100, Bytes{10, 60, 30}), ElementsAre(10, 60, 30));
    EXPECT_THAT(memoryShares(1000, Bytes{10, 60, 30}), ElementsAre(10, 60, 30));
    EXPECT_THAT(memoryShares(1000, Bytes{}), ElementsAre());
}

TEST(MemoryShares, LargeObjectsShareWhatSmallOnesLeaveEvenly) {
    EXPECT_THAT(memoryShares(100, Bytes{5, 1000, 5, 90}), ElementsAre(5, 45, 5, 45));
    EXPECT_THAT(memoryShares(100, Bytes{40, 1000, 20, 0}), ElementsAre(40, 40, 20, 0));
    EXPECT_THAT(memoryShares(99, Bytes{1000, 1000, 1000}), ElementsAre(33, 33, 33));
    EXPECT_THAT(memoryShares(0, Bytes{3, 0}), ElementsAre(0, 0));
}

RC_GTEST_PROP(MemoryShares, KeepTheLimitAndLeaveNothingThatAnObjectCouldUse, ()) {
    const auto most = *rc::gen::container<Bytes>(rc::gen::inRange<std::uint64_t>(0, 1000));
    const auto limit = *rc::gen::inRange<std::uint64_t>(0, 20000);
    const Bytes shares = memoryShares(limit, most);
    RC_ASSERT(shares.size() == most.size());
    const std::uint64_t sum = std::accumulate(shares.begin(), shares.end(), std::uint64_t{0});
    const std::uint64_t all = std::accumulate(most.begin(), most.end(), std::uint64_t{0});
    RC_ASSERT(sum <= limit);
    RC_ASSERT(sum + most.size() > std::min(limit, all) || most.empty());
    for (std::size_t i = 0; i < most.size(); ++i) {
        RC_ASSERT(shares[i] <= most[i]);
        if (shares[i] < most[i])
            RC_ASSERT(shares[i] == std::ranges::max(shares));
    }
}

}  // namespace
}  // namespace eyrie::draw
