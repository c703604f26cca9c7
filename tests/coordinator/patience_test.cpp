// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/patience.h"

#include <gtest/gtest.h>

#include "coordinator/frame/frame_kinds.h"

namespace eyrie::coordinator {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kKind = 7;
constexpr milliseconds kLong{60'000};

TEST(Patience, KnowsNothingOfAKindWithoutFrames) {
    Patience patience({});
    EXPECT_FALSE(patience.limit(kKind).has_value());
    patience.record(kKind, kLong, milliseconds(1));
    EXPECT_FALSE(patience.limit(kKind + 1).has_value());
}

TEST(Patience, IsThreeTimesTheRecentMedian) {
    Patience patience({});
    for (const int taken : {400, 900, 300, 350, 20})
        patience.record(kKind, kLong, milliseconds(taken));
    EXPECT_EQ(patience.limit(kKind), milliseconds(3 * 350));
}

TEST(Patience, IsAHundredMillisecondsAtLeast) {
    Patience patience({});
    patience.record(kKind, kLong, milliseconds(33));
    EXPECT_EQ(patience.limit(kKind), milliseconds(100));
    for (int i = 0; i < 15; ++i) patience.record(kKind, kLong, milliseconds(34));
    EXPECT_EQ(patience.limit(kKind), milliseconds(102));
}

TEST(Patience, FollowsARendererThatHasBecomeSlower) {
    Patience patience({});
    for (int i = 0; i < 15; ++i) patience.record(kKind, kLong, milliseconds(200));
    for (int i = 0; i < 16; ++i) patience.record(kKind, *patience.limit(kKind), milliseconds(1000));
    EXPECT_EQ(patience.limit(kKind), milliseconds(3000));
}

TEST(Patience, IsNotWornOutByOneThatStoodStill) {
    Patience patience({});
    patience.record(kKind, milliseconds(150), kLong);
    EXPECT_EQ(patience.limit(kKind), milliseconds(450));
    for (int i = 0; i < 2; ++i) patience.record(kKind, milliseconds(450), milliseconds(50));
    EXPECT_EQ(patience.limit(kKind), milliseconds(150));
}

TEST(Patience, KeepsTheLatestEightKindsApart) {
    Patience patience({});
    for (std::uint64_t kind = 1; kind <= 9; ++kind)
        for (int i = 0; i < 5; ++i)
            patience.record(kind, kLong, milliseconds(100 * static_cast<int>(kind)));
    EXPECT_FALSE(patience.limit(1).has_value());
    for (std::uint64_t kind = 2; kind <= 9; ++kind)
        EXPECT_EQ(patience.limit(kind), milliseconds(300 * static_cast<int>(kind)));
}

TEST(FrameKinds, DifferInAnythingButTheCamera) {
    FrameKinds kinds;
    FrameRequest request;
    const std::uint64_t first = kinds.of(request, 1);
    request.camera.eye.x += 1;
    EXPECT_EQ(kinds.of(request, 1), first);
    EXPECT_NE(kinds.of(request, 2), first);
    FrameRequest wide = request;
    wide.width += 1;
    EXPECT_NE(kinds.of(wide, 1), first);
    FrameRequest timed = request;
    timed.budgetMilliseconds = 20;
    EXPECT_NE(kinds.of(timed, 1), first);
    EXPECT_NE(kinds.of(timed, 1), kinds.of(wide, 1));
    EXPECT_EQ(kinds.of(request, 1), first);
}

TEST(FrameKinds, AreRememberedWhileEightOthersHaveNotCome) {
    FrameKinds kinds;
    FrameRequest request;
    const std::uint64_t first = kinds.of(request, 1);
    for (std::uint64_t revision = 2; revision <= 8; ++revision) kinds.of(request, revision);
    EXPECT_EQ(kinds.of(request, 1), first);
    for (std::uint64_t revision = 11; revision <= 18; ++revision) kinds.of(request, revision);
    EXPECT_NE(kinds.of(request, 1), first);
}

}  // namespace
}  // namespace eyrie::coordinator
