// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/view_turns.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace eyrie::draw {
namespace {

using fabric::Completeness;
using fabric::Vec3;
using Names = std::vector<std::uint32_t>;

constexpr int kWidth = 160;
constexpr int kHeight = 120;

lod::Channel channel(const Vec3& eye, double azimuth = 0) {
    fabric::Camera camera;
    camera.eye = eye;
    camera.target = eye + Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    return {lod::View(camera, kWidth, kHeight), {}, {0, 0, kWidth, kHeight}};
}

/// What was drawn: its name and the others'.
struct Drawn {
    std::uint32_t view;
    Names others;
};

Drawn draw(ViewTurns& turns, const lod::Channel& channel,
           Completeness completeness = Completeness::Interactive) {
    const ViewTurn turn = turns.next(channel, completeness);
    return {turn.view, {turn.others.begin(), turn.others.end()}};
}

TEST(ViewTurns, ASingleViewIsAloneHoweverItMovesAndWhereverItJumps) {
    ViewTurns turns;
    const std::uint32_t first = draw(turns, channel(Vec3(0))).view;
    for (int i = 1; i < 40; ++i) {
        const Drawn drawn = draw(turns, channel(Vec3(i * i, 0, 0), 0.3 * std::sin(0.1 * i)));
        EXPECT_EQ(drawn.view, first) << "faster and faster";
        EXPECT_EQ(drawn.others, Names{});
    }
    for (int jump = 0; jump < 9; ++jump)
        for (int i = 0; i < 40; ++i)
            EXPECT_EQ(draw(turns, channel(Vec3(0, 7919.0 * (jump % 4), i), 2.0 * jump)).others,
                      Names{});
}

TEST(ViewTurns, AViewThatTurnsBackIsAlone) {
    ViewTurns turns;
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(draw(turns, channel(Vec3(0), 0.5 * std::sin(0.17 * i))).others, Names{}) << i;
}

TEST(ViewTurns, ViewsKnowEachOtherFromTheirSecondTurnOn) {
    ViewTurns turns;
    std::vector<std::uint32_t> names;
    for (int round = 0; round < 4; ++round)
        for (std::uint32_t i = 0; i < 3; ++i) {
            const Drawn drawn = draw(turns, channel(Vec3(0, round, 0), 2.0 * i));
            if (round == 0)
                names.push_back(drawn.view);
            EXPECT_EQ(drawn.view, names[i]) << "it moves on";
            EXPECT_EQ(drawn.others.size(), round == 0 ? 0 : round == 1 ? i : 2U);
        }
}

TEST(ViewTurns, AViewThatIsGoneIsForgottenAfterTwoRounds) {
    ViewTurns turns;
    for (int round = 0; round < 3; ++round)
        for (const double azimuth : {0.0, 2.0, 4.0}) draw(turns, channel(Vec3(0), azimuth));
    std::vector<std::size_t> others;
    for (int round = 0; round < 4; ++round)
        for (const double azimuth : {0.0, 2.0})
            others.push_back(draw(turns, channel(Vec3(0), azimuth)).others.size());
    EXPECT_EQ(others, (std::vector<std::size_t>{2, 2, 2, 2, 1, 1, 1, 1}));
}

/// Sessions begin with the same camera.
TEST(ViewTurns, ViewersWhoLookTheSameWayFromElsewhereAreApart) {
    for (const double metresAFrame : {0.0, 0.5}) {
        ViewTurns turns;
        std::vector<Names> names(3);
        for (int round = 0; round < 10; ++round)
            for (int viewer = 0; viewer < 3; ++viewer)
                names[static_cast<std::size_t>(viewer)].push_back(
                    draw(turns, channel(Vec3(metresAFrame * round, 100.0 * viewer, 0))).view);
        for (std::size_t round = 5; round < 10; ++round)
            for (std::size_t viewer = 0; viewer < 3; ++viewer) {
                EXPECT_EQ(names[viewer][round], names[viewer][4]);
                EXPECT_NE(names[viewer][round], names[(viewer + 1) % 3][round]);
            }
        EXPECT_EQ(draw(turns, channel(Vec3(metresAFrame * 10, 0, 0))).others.size(), 2U);
    }
}

/// Of one camera, with the same frustum, and turned so little that a viewer might have turned.
TEST(ViewTurns, WallsOfARoomThatMovesAreApart) {
    ViewTurns turns;
    std::vector<Names> names(2);
    for (int frame = 0; frame < 6; ++frame)
        for (int wall = 0; wall < 2; ++wall) {
            lod::Channel drawn = channel(Vec3(3.0 * frame, 0, 0));
            drawn.view.viewFromWorldRotation =
                channel(Vec3(0), 0.4 * wall).view.viewFromWorldRotation;
            names[static_cast<std::size_t>(wall)].push_back(draw(turns, drawn).view);
        }
    EXPECT_EQ(names[0], Names(6, names[0][0]));
    EXPECT_EQ(names[1], Names(6, names[1][0]));
    EXPECT_NE(names[0][0], names[1][0]);
}

TEST(ViewTurns, NobodyExpectsACompleteFrameAgain) {
    ViewTurns turns;
    std::vector<std::size_t> ofInteractive;
    std::vector<std::size_t> ofComplete;
    for (int round = 0; round < 4; ++round) {
        ofInteractive.push_back(draw(turns, channel(Vec3(0))).others.size());
        ofComplete.push_back(
            draw(turns, channel(Vec3(0), 2), Completeness::Complete).others.size());
    }
    EXPECT_EQ(ofInteractive, (std::vector<std::size_t>{0, 0, 0, 0}));
    EXPECT_EQ(ofComplete, (std::vector<std::size_t>{0, 1, 1, 1})) << "it spares the others";
}

TEST(ViewTurns, NoMoreThanSixteenAreRemembered) {
    const auto othersOf = [](int views) {
        ViewTurns turns;
        std::size_t others = 0;
        for (int round = 0; round < 4; ++round)
            for (int i = 0; i < views; ++i) {
                lod::Channel part = channel(Vec3(0));
                part.part = {8 * i, 0, 8, kHeight};
                others = draw(turns, part).others.size();
            }
        return others;
    };
    EXPECT_EQ(othersOf(16), 15U);
    EXPECT_EQ(othersOf(17), 0U) << "each is forgotten before it comes again";
}

TEST(PerView, KeepsWhatTheTurnConcerns) {
    PerView<int> numbers;
    const Names others{1, 3};
    for (const std::uint32_t view : {1U, 2U, 3U}) {
        const Names all{1, 2, 3};
        numbers.of({view, all}) = static_cast<int>(10 * view);
    }
    EXPECT_EQ(numbers.of({4, others}), 0);
    EXPECT_EQ(numbers.all(), (std::map<std::uint32_t, int>{{1, 10}, {3, 30}, {4, 0}}));
}

}  // namespace
}  // namespace eyrie::draw
