// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/resident_set.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::page {
namespace {

using Set = ResidentSet<int, int>;

bool add(Set& set, int key, std::uint64_t bytes, Set::Rank rank) {
    if (!set.makeRoom(bytes, rank))
        return false;
    set.insert(key, key, bytes, rank);
    return true;
}

TEST(ResidentSet, DropsWhatWasNotWantedLongestFirst) {
    Set set(30);
    for (int key : {1, 2, 3}) ASSERT_TRUE(add(set, key, 10, 0));
    set.beginFrame();
    set.rank(1, 0);
    set.beginFrame();
    set.rank(3, 0);
    ASSERT_TRUE(add(set, 4, 10, 1));
    EXPECT_FALSE(set.contains(2)) << "neither 1 nor 3 was forgotten for so long";
    set.beginFrame();
    set.rank(3, 0);
    set.rank(4, 1);
    ASSERT_TRUE(add(set, 5, 10, 2));
    EXPECT_FALSE(set.contains(1));
}

TEST(ResidentSet, GivesUpALowerRankForAHigherOneOnly) {
    Set set(20);
    add(set, 1, 10, 5);
    add(set, 2, 10, 3);
    set.beginFrame();
    set.rank(1, 5);
    set.rank(2, 3);
    EXPECT_FALSE(add(set, 3, 10, 5));
    EXPECT_EQ(set.size(), 2U);
    EXPECT_TRUE(add(set, 4, 10, 4));
    EXPECT_FALSE(set.contains(1));
    EXPECT_TRUE(set.contains(2));
}

TEST(ResidentSet, DropsNothingForWhatCannotFit) {
    Set set(20);
    add(set, 1, 10, 0);
    set.beginFrame();
    EXPECT_FALSE(set.makeRoom(21, 0));
    EXPECT_TRUE(set.contains(1));
}

RC_GTEST_PROP(ResidentSet, NeverExceedsItsLimitAndRestsWhenTheRanksStayTheSame, ()) {
    const auto limit = *rc::gen::inRange<std::uint64_t>(0, 100);
    const auto sizes = *rc::gen::container<std::vector<int>>(12, rc::gen::inRange(1, 40));
    Set set(limit);
    const auto frame = [&](const std::vector<int>& order) {
        set.beginFrame();
        for (std::size_t i = 0; i < order.size(); ++i)
            set.rank(order[i], static_cast<Set::Rank>(i));
        int loads = 0;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const int key = order[i];
            if (!set.contains(key) &&
                add(set, key, static_cast<std::uint64_t>(sizes[static_cast<std::size_t>(key)]),
                    static_cast<Set::Rank>(i)))
                ++loads;
            RC_ASSERT(set.bytes() <= limit);
        }
        return loads;
    };
    std::vector<int> order(12);
    for (int i = 0; i < 12; ++i) order[static_cast<std::size_t>(i)] = i;
    for (int view = 0; view < 3; ++view) {
        const auto seed = *rc::gen::inRange(0, 12);
        std::rotate(order.begin(), order.begin() + seed, order.end());
        int frames = 0;
        while (frame(order) > 0) RC_ASSERT(++frames <= 12);
    }
}

}  // namespace
}  // namespace eyrie::page
