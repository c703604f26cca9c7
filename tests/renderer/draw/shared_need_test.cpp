// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/shared_need.h"

#include <gtest/gtest.h>

namespace eyrie::draw {
namespace {

using Items = std::vector<NeededItem>;

const Items kFirst{{1, 100}, {2, 20}};
const Items kSecond{{2, 20}, {3, 400}};

TEST(SharedNeed, CountsOnceWhatSeveralViewsNeed) {
    const std::vector<ViewNeed> needs{{{}, kFirst}, {{}, kSecond}};
    EXPECT_EQ(separateBytes(needs), 540U);
    EXPECT_EQ(sharedBytes(needs), 520U);
}

TEST(SharedNeed, OfOneViewIsItsShare) {
    const std::vector<ViewNeed> needs{{{0.25, 0.75}, kFirst}};
    EXPECT_EQ(separateBytes(needs), 60U);
    EXPECT_EQ(sharedBytes(needs), 60U);
}

/// Two eyes of a channel draw the same share, two channels of an eye do not.
TEST(SharedNeed, IsOfAsMuchAsTheRangesCoverTogether) {
    EXPECT_EQ(sharedBytes(std::vector<ViewNeed>{{{0, 0.5}, kFirst}, {{0, 0.5}, kFirst}}), 60U);
    EXPECT_EQ(sharedBytes(std::vector<ViewNeed>{{{0.5, 1}, kFirst}, {{0, 0.5}, kFirst}}), 120U);
    EXPECT_EQ(sharedBytes(std::vector<ViewNeed>{{{0, 0.5}, kFirst}, {{0.25, 0.75}, kFirst}}), 90U);
    EXPECT_EQ(sharedBytes(std::vector<ViewNeed>{{{0, 0.5}, kFirst}, {{}, kSecond}}), 50U + 420U);
}

}  // namespace
}  // namespace eyrie::draw
