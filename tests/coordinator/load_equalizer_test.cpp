// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/coordinator/balanced_scene.h"
#include "tests/coordinator/hot_tenths.h"

namespace eyrie::equalizer {
namespace {

/// Positions of the children of the one compound.
std::vector<std::size_t> children(const Balanced& balanced) {
    std::vector<std::size_t> positions;
    for (std::size_t i = 1; i < balanced.resolved.compounds.size(); ++i) positions.push_back(i);
    return positions;
}

/// What the slowest child takes, for each of what all take on average.
double imbalance(const Balanced& balanced, const Spot& spot) {
    double longest = 0;
    for (const std::size_t child : children(balanced))
        if (balanced.at(child).tasks.draw)
            longest = std::max(longest, spot(balanced.at(child)));
    return longest * static_cast<double>(children(balanced).size()) / spot.total();
}

/// Equal shares are the best that any split can do: the sum over their number.
void expectWithin15Percent(double noise) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> off(1 - noise, 1 + noise);
    for (const auto& [mode, hot] : kHotTenths)
        for (int count = 2; count <= 8; ++count) {
            Balanced balanced = loadBalanced(count, std::string("mode ") + mode);
            const Spot spot{hot};
            for (int frame = 0; frame < 40; ++frame) {
                balanced.draw([&](const auto& part) { return spot(part) * off(random); });
                if (frame < 10)
                    continue;
                ASSERT_LE(imbalance(balanced, spot), 1.15)
                    << mode << " in " << count << ", frame " << frame;
            }
        }
}

TEST(LoadEqualizer, IsWithin15PercentOfTheBestSplitInTenFramesAndStaysThere) {
    expectWithin15Percent(0);
}

TEST(LoadEqualizer, IsNotThrownOffByTimesThatAreATenthOff) { expectWithin15Percent(.1); }

TEST(LoadEqualizer, ComesToRestWhereLoadRests) {
    for (const auto& [mode, hot] : kHotTenths) {
        Balanced balanced = loadBalanced(7, std::string("mode ") + mode);
        for (int frame = 0; frame < 30; ++frame) balanced.draw(Spot{hot});
        const config::Configuration before = balanced.live;
        for (int frame = 0; frame < 10; ++frame) balanced.draw(Spot{hot});
        EXPECT_TRUE(balanced.live == before) << mode;
    }
}

/// The first frame's times are of loading, and tell nothing. The last mode has 41 columns and as
/// few frames in which a cut still moves, which are the ones that tell the explanations apart.
TEST(LoadEqualizer, KnowsARendererThatIsTenTimesSlowerWithin20FramesHoweverTheyBegin) {
    std::mt19937 random(7);
    std::exponential_distribution<double> loading(.2);
    struct Mode {
        const char* settings;
        double slow;  ///< how far off the slow one's time may be: a column of 31 pixels takes 24 ms
    };
    for (const auto& [mode, slow] :
         {Mode{"mode DB", 20}, {"mode 2D", 20}, {"mode 2D boundary [ 31 31 ]", 26}})
        for (int run = 0; run < 200; ++run) {
            Balanced balanced = loadBalanced(3, mode);
            balanced.draw([&](const auto&) { return loading(random); });
            std::vector<double> milliseconds;
            for (int frame = 0; frame < 30; ++frame) {
                milliseconds = balanced.draw([&](const config::ResolvedCompound& part) {
                    const double slowness = &part == &balanced.at(2) ? 10 : 1;
                    return slowness * Spot{{0, 0, 1, 1}}(part);
                });
                if (frame < 20)
                    continue;
                // Equal times are 100 / (1 + 1/10 + 1).
                ASSERT_NEAR(milliseconds[1], 100 / 2.1, 4) << mode << ", " << run << ", " << frame;
                ASSERT_NEAR(milliseconds[2], 100 / 2.1, slow)
                    << mode << ", " << run << ", " << frame;
            }
        }
}

TEST(LoadEqualizer, DividesDataWhateverItsBoundary) {
    for (const double boundary : {1e-310, 1e-9, 1.0}) {
        Balanced balanced = loadBalanced(2, "mode DB");
        config::EqualizerTuning tuning;
        tuning.boundaryRange = boundary;
        ASSERT_TRUE(balanced.equalizers.tune(0, tuning).ok());
        for (int frame = 0; frame < 10; ++frame) balanced.draw(Spot{{0, 0, 1, 1}});
        double end = 0;
        for (const config::Compound& child : balanced.live.compounds[0].children) {
            EXPECT_EQ(child.range.begin, end) << boundary;
            end = child.range.end;
        }
        EXPECT_EQ(end, 1) << boundary;
    }
}

TEST(LoadEqualizer, FollowsALoadThatMoves) {
    Balanced balanced = loadBalanced(4, "mode 2D");
    double sum = 0;
    constexpr int kFrames = 120;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double x = .1 + .6 * frame / kFrames;
        const Spot spot{{x, .3, x + .2, .8}};
        balanced.draw(spot);
        sum += imbalance(balanced, spot);
    }
    EXPECT_LE(sum / kFrames, 1.25);  // 2.7 where the cuts stay as they begin
}

/// Most of it on the side of the data that a camera is at which goes round it.
struct Turning {
    double framesAround = 60;

    /// In what comes before `end`.
    double before(double end, int frame) const {
        const double angle = 2 * M_PI * frame / framesAround;
        return 10 * (end + .8 / (2 * M_PI) * (std::sin(2 * M_PI * end - angle) + std::sin(angle)));
    }
    double in(const fabric::Range& range, int frame) const {
        return before(range.end, frame) - before(range.begin, frame);
    }
};

/// Of a second round with two frames in flight: the times of one are known when the second after
/// it is planned.
double imbalanceInFlight(int count, const Turning& load) {
    Balanced balanced = loadBalanced(count, "mode DB");
    FrameTimes last;
    double sum = 0;
    const int round = static_cast<int>(load.framesAround);
    for (int frame = 0; frame < 2 * round; ++frame) {
        balanced.apply();
        FrameTimes times{balanced.number,
                         std::vector<CompoundTime>(balanced.resolved.compounds.size())};
        double longest = 0;
        for (const std::size_t child : children(balanced)) {
            times.compounds[child].draw = load.in(balanced.at(child).range, frame);
            longest = std::max(longest, times.compounds[child].draw);
        }
        sum += frame >= round ? longest * count / load.before(1, frame) : 0;
        if (frame > 0)
            balanced.equalizers.record(last);
        last = times;
    }
    return sum / round;
}

TEST(LoadEqualizer, GoesAheadOfALoadThatTurnsWithTwoFramesInFlight) {
    // 1.21, 1.13, 1.08 and 1.16 where cuts go to where the load was.
    EXPECT_LE(imbalanceInFlight(2, {30}), 1.17);
    EXPECT_LE(imbalanceInFlight(2, {60}), 1.10);
    EXPECT_LE(imbalanceInFlight(2, {120}), 1.06);
    EXPECT_LE(imbalanceInFlight(4, {120}), 1.13);
}

TEST(LoadEqualizer, StartsWithEqualParts) {
    Balanced balanced = loadBalanced(4, "mode DB");
    balanced.apply();
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(balanced.at(i + 1).range,
                  (fabric::Range{.25 * static_cast<double>(i), .25 * static_cast<double>(i + 1)}));
}

TEST(LoadEqualizer, LeavesChildrenAloneThatTakeAboutEquallyLong) {
    Balanced balanced = loadBalanced(2, "mode DB");
    const auto load = [&](const config::ResolvedCompound& part) {
        return part.range.begin == 0 ? 10.0 : 10.5;
    };
    balanced.draw(load);
    balanced.draw(load);
    EXPECT_EQ(balanced.at(1).range, (fabric::Range{0, .5}));
}

TEST(LoadEqualizer, MovesFromWhereTheCutWas) {
    Balanced balanced = loadBalanced(2, "mode DB damping .5");
    const Spot spot{{.9, 0, 1, 1}};
    double cut = .5;
    for (int frame = 0; frame < 8; ++frame) {
        balanced.draw(spot);
        balanced.apply();
        EXPECT_GE(balanced.at(1).range.end, cut);
        cut = balanced.at(1).range.end;
    }
    EXPECT_NEAR(cut, 17. / 18 + 1e-3, .01);  // an ever more damped cut would stop half way, at .72
}

TEST(LoadEqualizer, DoesNotMoveWithFullDampingOrWithinItsResistance) {
    for (const char* settings : {"mode DB damping 1", "mode DB resistance .5",
                                 "mode VERTICAL damping 1", "mode VERTICAL resistance [ 640 0 ]"}) {
        Balanced balanced = loadBalanced(2, settings);
        for (int frame = 0; frame < 5; ++frame) balanced.draw(Spot{{.9, 0, 1, 1}});
        const config::ResolvedCompound& first = balanced.at(1);
        EXPECT_EQ(std::min(first.range.end, first.viewport.width), .5) << settings;
    }
}

TEST(LoadEqualizer, CountsReadingBackEncodingAndTransmission) {
    Balanced balanced = loadBalanced(2, "mode DB");
    for (int frame = 0; frame < 12; ++frame) {
        balanced.apply();
        FrameTimes times{balanced.number, std::vector<CompoundTime>(3)};
        for (std::size_t i : {1, 2})
            times.compounds[i].draw = 10 * (balanced.at(i).range.end - balanced.at(i).range.begin);
        times.compounds[2].readback = 1;
        times.compounds[2].transmit = 3;
        balanced.equalizers.record(times);
    }
    EXPECT_NEAR(balanced.at(1).range.end, .7, .05);  // 7 ms each
}

TEST(LoadEqualizer, ChargesTheDestinationForWhatItAssembles) {
    Balanced balanced = loadBalanced(2, "mode DB");
    for (int frame = 0; frame < 12; ++frame) {
        balanced.apply();
        FrameTimes times{balanced.number, std::vector<CompoundTime>(3)};
        times.compounds[0].assemble = 4;
        for (std::size_t i : {1, 2})
            times.compounds[i].draw = 10 * (balanced.at(i).range.end - balanced.at(i).range.begin);
        balanced.equalizers.record(times);
    }
    EXPECT_NEAR(balanced.at(1).range.end, .3, .05);  // 3 + 4 ms, and 7
}

TEST(LoadEqualizer, LeavesTheDestinationToAssembleWhereEnoughOthersDraw) {
    Balanced balanced = loadBalanced(4, "mode 2D assemble_only_limit 3");
    balanced.apply();
    EXPECT_FALSE(balanced.at(1).tasks.draw);
    balanced.gone = {*balanced.at(4).channel};
    balanced.apply();
    EXPECT_TRUE(balanced.at(1).tasks.draw);
}

TEST(LoadEqualizer, CutsWhatIsCoveredNotWhatIsEmpty) {
    Balanced balanced = loadBalanced(2, "mode VERTICAL damping 0");
    balanced.apply();
    FrameTimes times{balanced.number, std::vector<CompoundTime>(3)};
    times.compounds[1].draw = 30;
    times.compounds[1].covered = {.5, 0, .5, 1};  // of [0, .5): [.25, .5)
    times.compounds[2].draw = 10;
    times.compounds[2].covered = {0, 0, .1, 1};
    balanced.equalizers.record(times);
    balanced.apply();
    EXPECT_NEAR(balanced.at(1).viewport.width, .25 + .25 * 20 / 30, .002);
}

TEST(LoadEqualizer, GivesNothingToAChannelThatIsGoneAndAShareWhenItIsBack) {
    for (const char* mode : {"mode 2D", "mode DB"}) {
        Balanced balanced = loadBalanced(3, mode);
        for (int frame = 0; frame < 12; ++frame) balanced.draw(Spot{{.2, 0, .3, 1}});
        balanced.gone = {*balanced.at(2).channel};
        double sum = 0;
        for (const double each : balanced.draw(Spot{{.2, 0, .3, 1}})) sum += each;
        EXPECT_FALSE(balanced.at(2).tasks.draw);
        EXPECT_NEAR(sum, 100, 1e-6) << "the others draw all";
        for (int frame = 0; frame < 10; ++frame) balanced.draw(Spot{{.2, 0, .3, 1}});
        EXPECT_LE(imbalance(balanced, {{.2, 0, .3, 1}}), 1.5 * 1.15) << mode << ", of two in three";
        balanced.gone.clear();
        balanced.draw(Spot{{.2, 0, .3, 1}});
        EXPECT_TRUE(balanced.at(2).tasks.draw);
        for (int frame = 0; frame < 9; ++frame) balanced.draw(Spot{{.2, 0, .3, 1}});
        EXPECT_LE(imbalance(balanced, {{.2, 0, .3, 1}}), 1.15) << mode;
    }
}

TEST(LoadEqualizer, SharesOutWhatIsGivenToNobodyPresent) {
    Balanced balanced = loadBalanced(3, "mode 2D");
    for (std::size_t i : {1, 2, 3}) balanced.gone.push_back(*balanced.at(i).channel);
    balanced.apply();
    for (std::size_t i : {1, 2, 3}) EXPECT_TRUE(balanced.at(i).tasks.draw);
}

TEST(LoadEqualizer, SharesBetweenGroupsByTheirNumber) {
    const std::string two = "compound { channel \"s1\" } compound { channel \"s2\" }";
    Balanced balanced(configurationOf(
        2,
        "compound { channel ( segment 0 view 0 ) load_equalizer { mode DB } compound { } "
        "compound { load_equalizer { mode 2D } " +
            two + " } }"));
    for (int frame = 0; frame < 12; ++frame)
        balanced.draw([](const config::ResolvedCompound& part) {
            return 90 * (part.range.end - part.range.begin) * part.viewport.width *
                   part.viewport.height;
        });
    EXPECT_NEAR(balanced.at(1).range.end, 1. / 3, .03);
    EXPECT_NEAR(balanced.at(3).viewport.width, .5, .03);
}

/// Whether a group of compounds is told to draw or not, its children alone do.
TEST(LoadEqualizer, LearnsFromGroupsThatAreToldToDraw) {
    const auto moved = [](const std::string& task) {
        Balanced balanced(configurationOf(
            2,
            "compound { channel ( segment 0 view 0 ) load_equalizer { } compound { } "
            "compound { channel \"s1\" " +
                task +
                " compound { viewport [ 0 0 1 .5 ] } compound { channel \"s2\" viewport [ 0 .5 1 "
                ".5 ] outputframe { name \"k\" } } inputframe { name \"k\" } "
                "outputframe { name \"f\" } } inputframe { name \"f\" } }"));
        for (int frame = 0; frame < 12; ++frame) balanced.draw(Spot{{0, 0, .2, 1}});
        return balanced.live.compounds[0].children[0].viewport;
    };
    const config::Viewport plain = moved("");
    EXPECT_LT(plain.width, .3);
    EXPECT_EQ(moved("task [ CLEAR DRAW ASSEMBLE READBACK ]"), plain);
}

/// Any double, the odd ones often.
rc::Gen<double> anyTime() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return rc::gen::oneOf(
        rc::gen::element(0.0, -1.0, kInfinity, -kInfinity, CompoundTime::kUnknown, 1e300, 1e-300),
        rc::gen::map(rc::gen::inRange(0, 1000), [](int i) { return i / 10.0; }));
}

RC_GTEST_PROP(LoadEqualizer, GivesEveryPixelAndPieceToOneWhateverTheTimes, ()) {
    const int count = *rc::gen::inRange(1, 9);
    const auto mode = *rc::gen::element<std::string>("2D", "DB", "HORIZONTAL", "VERTICAL");
    const auto kind = *rc::gen::element<std::string>("load_equalizer", "tree_equalizer");
    const int boundary = *rc::gen::inRange(0, 91);
    Balanced balanced(configurationOf(
        count - 1,
        sharedBetween(count, fmt::format("{} {{ mode {} damping {} boundary {} }}", kind, mode,
                                         *rc::gen::inRange(0, 11) / 10.0,
                                         mode == "DB" ? fmt::format("{}", boundary / 1000.0)
                                                      : fmt::format("[ {0} {0} ]", boundary)))));
    for (int frame = 0; frame < 12; ++frame) {
        balanced.gone.clear();
        for (int i = 1; i <= count; ++i)
            if (*rc::gen::inRange(0, 8) == 0)
                balanced.gone.push_back(*balanced.at(static_cast<std::size_t>(i)).channel);
        balanced.apply();
        const bool isAnyoneHere = balanced.gone.size() < static_cast<std::size_t>(count);
        std::int64_t area = 0;
        double range = 0;
        FrameTimes times{balanced.number, {}};
        times.compounds.resize(static_cast<std::size_t>(*rc::gen::inRange(0, count + 3)));
        for (CompoundTime& time : times.compounds) {
            time.draw = *anyTime();
            time.transmit = *anyTime();
            time.assemble = *anyTime();
            time.covered = {*anyTime(), *anyTime(), *anyTime(), *anyTime()};
        }
        for (const std::size_t child : children(balanced)) {
            const config::ResolvedCompound& part = balanced.at(child);
            const bool isGone =
                std::ranges::find(balanced.gone, *part.channel) != balanced.gone.end();
            RC_ASSERT(part.tasks.draw == (!isGone || !isAnyoneHere));
            RC_ASSERT(part.range.begin >= 0 && part.range.end <= 1);
            RC_ASSERT(fabric::PixelViewport({0, 0, 1280, 720}).contains(part.pixelViewport));
            area += part.pixelViewport.area();
            range += part.range.end - part.range.begin;
            if (part.tasks.draw && mode != "DB" && boundary > 1) {
                RC_ASSERT(part.pixelViewport.x % boundary == 0);
                RC_ASSERT(part.pixelViewport.y % boundary == 0);
            }
            if (part.tasks.draw && mode == "DB" && boundary > 0) {
                const double units = part.range.begin / (boundary / 1000.0);
                RC_ASSERT(std::abs(units - std::round(units)) < 1e-6);
            }
            for (const std::size_t other : children(balanced))
                RC_ASSERT(
                    (mode == "DB" || other == child ||
                     fabric::intersection(part.pixelViewport, balanced.at(other).pixelViewport)
                         .isEmpty()));
        }
        RC_ASSERT((mode == "DB" ? std::abs(range - 1) < 1e-9 : area == 1280 * 720));
        balanced.equalizers.record(times);
    }
}

}  // namespace
}  // namespace eyrie::equalizer
