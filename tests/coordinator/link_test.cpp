// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/stream/link_estimate.h"
#include "coordinator/stream/quality.h"
#include "tests/coordinator/simulated_link.h"

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Time = SimulatedLink::Time;

SimulatedLink::Settings linkOf(double megabits) {
    SimulatedLink::Settings settings;
    settings.megabits = [=](Time) { return megabits; };
    return settings;
}

struct Figures {
    double framesPerSecond = 0;
    double medianMilliseconds = 0;
    double worstMilliseconds = 0;
    int worstLevel = 0;
};

/// Of the frames drawn from `from` to `to`.
Figures figures(const std::vector<SimulatedLink::Drawn>& drawn, Time from, Time to) {
    std::vector<double> latencies;
    Figures figures;
    for (const SimulatedLink::Drawn& one : drawn) {
        if (one.at < from || one.at >= to)
            continue;
        latencies.push_back(one.latency.count());
        figures.worstLevel = std::max(figures.worstLevel, one.level);
    }
    if (latencies.empty())
        return figures;
    std::sort(latencies.begin(), latencies.end());
    figures.framesPerSecond = 1000.0 * static_cast<double>(latencies.size()) / (to - from).count();
    figures.medianMilliseconds = latencies[latencies.size() / 2];
    figures.worstMilliseconds = latencies.back();
    return figures;
}

void tell(const char* what, const Figures& figures) {
    testing::Test::RecordProperty(what, static_cast<int>(figures.framesPerSecond));
    std::printf("%s: %.1f frames/s, %.0f ms median, %.0f ms worst, level %d\n", what,
                figures.framesPerSecond, figures.medianMilliseconds, figures.worstMilliseconds,
                figures.worstLevel);
}

TEST(StreamOnASimulatedLink, HoldsThirtyFramesAndNinetyMillisecondsAtTwentyMegabits) {
    const Figures now =
        figures(SimulatedLink(linkOf(20)).run(Time(12'000)), Time(2000), Time(12'000));
    tell("20 Mbit/s", now);
    EXPECT_GE(now.framesPerSecond, 30);
    EXPECT_LE(now.medianMilliseconds, 90);
    EXPECT_LE(now.worstMilliseconds, 150);
}

TEST(StreamOnASimulatedLink, IsAnAnimationFrameLaterWhereThePageSendsViewsWithThose) {
    SimulatedLink::Settings settings = linkOf(20);
    settings.viewsEvery = Time(1000.0 / 60);
    const Figures now =
        figures(SimulatedLink(settings).run(Time(12'000)), Time(2000), Time(12'000));
    tell("20 Mbit/s, views at 60 Hz", now);
    EXPECT_GE(now.medianMilliseconds, 98);
    EXPECT_LE(now.medianMilliseconds, 112);
}

TEST(StreamOnASimulatedLink, HoldsFifteenFramesAndAHundredAndFiftyMillisecondsAtFiveMegabits) {
    const Figures now =
        figures(SimulatedLink(linkOf(5)).run(Time(12'000)), Time(2000), Time(12'000));
    tell("5 Mbit/s", now);
    EXPECT_GE(now.framesPerSecond, 15);
    EXPECT_LE(now.medianMilliseconds, 150);
    EXPECT_LE(now.worstMilliseconds, 250);
}

TEST(StreamOnASimulatedLink, SettlesWithinTwoSecondsOfAFallAndIsNeverHalfASecondLate) {
    SimulatedLink::Settings settings = linkOf(0);
    settings.megabits = [](Time now) { return now < Time(5000) ? 50.0 : 5.0; };
    const auto drawn = SimulatedLink(settings).run(Time(15'000));
    const Figures fall = figures(drawn, Time(5000), Time(7000));
    const Figures settled = figures(drawn, Time(7000), Time(15'000));
    tell("fall", fall);
    tell("settled", settled);
    EXPECT_LE(fall.worstMilliseconds, 500);
    EXPECT_GE(settled.framesPerSecond, 15);
    EXPECT_LE(settled.medianMilliseconds, 150);
    EXPECT_LE(settled.worstMilliseconds, 250);
}

TEST(StreamOnASimulatedLink, ShowsWholePicturesByVideoWhereJpegsAreShrunk) {
    SimulatedLink::Settings settings = linkOf(5);
    settings.showsVideo = true;
    const Figures now =
        figures(SimulatedLink(settings).run(Time(12'000)), Time(2000), Time(12'000));
    tell("5 Mbit/s, H.264", now);
    EXPECT_EQ(now.worstLevel, 0);
    EXPECT_GE(now.framesPerSecond, 15);
    EXPECT_LE(now.medianMilliseconds, 150);
    EXPECT_LE(now.worstMilliseconds, 250);
}

TEST(StreamOnASimulatedLink, TakesVideoWithinTwoSecondsOfAFallAndJpegsAfterARise) {
    SimulatedLink::Settings settings = linkOf(0);
    settings.showsVideo = true;
    settings.megabits = [](Time now) {
        return now >= Time(5000) && now < Time(12'000) ? 5.0 : 50.0;
    };
    const auto drawn = SimulatedLink(settings).run(Time(20'000));
    tell("fall, H.264", figures(drawn, Time(5000), Time(7000)));
    tell("settled, H.264", figures(drawn, Time(7000), Time(12'000)));
    EXPECT_LE(figures(drawn, Time(5000), Time(7000)).worstMilliseconds, 500);
    EXPECT_LE(figures(drawn, Time(7000), Time(12'000)).worstMilliseconds, 250);
    for (const SimulatedLink::Drawn& one : drawn) {
        const bool isSlow = one.at >= Time(7000) && one.at < Time(12'000);
        if (isSlow || one.at < Time(5000) || one.at > Time(16'000)) {
            EXPECT_EQ(one.codec, isSlow ? Codec::H264 : Codec::Jpeg) << one.at.count();
        }
    }
}

TEST(StreamOnASimulatedLink, RisesAgainWhenTheLinkDoes) {
    SimulatedLink::Settings settings = linkOf(0);
    settings.megabits = [](Time now) { return now < Time(5000) ? 3.0 : 100.0; };
    const auto drawn = SimulatedLink(settings).run(Time(12'000));
    const Figures risen = figures(drawn, Time(9000), Time(12'000));
    tell("risen", risen);
    EXPECT_EQ(risen.worstLevel, 0);
    EXPECT_LE(risen.medianMilliseconds, 90);
}

TEST(StreamOnASimulatedLink, CostsNothingWhereTheLinkIsFast) {
    SimulatedLink::Settings settings = linkOf(2000);
    settings.roundTrip = Time(0.5);
    const Figures local = figures(SimulatedLink(settings).run(Time(4000)), Time(500), Time(4000));
    tell("loopback", local);
    EXPECT_EQ(local.worstLevel, 0);
    EXPECT_LE(local.medianMilliseconds, 40);
}

TEST(StreamOnASimulatedLink, KeepsThreeQuartersOfTheSidesWhateverABusyBrowserTakes) {
    for (const double megabits : {20.0, 2000.0}) {
        SimulatedLink::Settings settings = linkOf(megabits);
        settings.threads = Time(12);
        settings.hiccups = Time(20);
        const Figures now =
            figures(SimulatedLink(settings).run(Time(12'000)), Time(2000), Time(12'000));
        tell("busy browser", now);
        EXPECT_GE(QualityControl::level(now.worstLevel).scale, 0.75);
        EXPECT_GE(now.framesPerSecond, 25);
        EXPECT_LE(now.medianMilliseconds, 130);
    }
}

TEST(StreamOnASimulatedLink, SendsPicturesThatAreHardToCompressSmaller) {
    SimulatedLink::Settings settings = linkOf(20);
    settings.bytesAtBest = 250'000;
    const Figures now = figures(SimulatedLink(settings).run(Time(8000)), Time(2000), Time(8000));
    tell("noise", now);
    EXPECT_GE(now.framesPerSecond, 20);
    EXPECT_LE(now.worstMilliseconds, 250);
}

TEST(LinkEstimate, TellsTheRateFromWhatCameOneAfterTheOther) {
    LinkEstimate link;
    const Clock::time_point start;
    link.roundTrip(milliseconds(50), start);
    for (std::uint64_t i = 1; i <= 5; ++i) link.sent(i, LinkEstimate::kWhole, 10'000, start);
    for (std::uint64_t i = 1; i <= 5; ++i)  // 10 ms each
        link.arrived(i, LinkEstimate::kWhole, start + milliseconds(50 + 10 * i));
    EXPECT_NEAR(*link.bytesPerSecond(start + milliseconds(100)), 1e6, 1);
    EXPECT_EQ(link.bytesUnderWay(), 0u);
}

TEST(LinkEstimate, FallsWhileSomethingIsOverdue) {
    LinkEstimate link;
    const Clock::time_point start;
    link.roundTrip(milliseconds(50), start);
    link.sent(1, LinkEstimate::kWhole, 10'000, start);
    link.arrived(1, LinkEstimate::kWhole, start + milliseconds(60));
    const double before = *link.bytesPerSecond(start + milliseconds(60));
    link.sent(2, LinkEstimate::kWhole, 10'000, start + milliseconds(60));
    EXPECT_EQ(*link.bytesPerSecond(start + milliseconds(200)), before);
    EXPECT_NEAR(*link.bytesPerSecond(start + milliseconds(1110)), 1e4, 1);
}

TEST(LinkEstimate, TakesTheTimeOfThreadsForNothing) {
    LinkEstimate link;
    const Clock::time_point start;
    link.roundTrip(milliseconds(50), start);
    Clock::time_point now = start;
    const auto send = [&](std::uint64_t frame, std::size_t bytes, milliseconds taken) {
        link.sent(frame, LinkEstimate::kWhole, bytes, now);
        now += milliseconds(50) + taken;
        link.arrived(frame, LinkEstimate::kWhole, now);
    };
    std::uint64_t frame = 0;
    while (frame < 5) send(++frame, 20'000, milliseconds(35));
    const double rate = *link.bytesPerSecond(now);
    EXPECT_NEAR(rate, 20'000 / 0.031, 1) << "35 ms, of which threads may have had 4";
    while (frame < 50) send(++frame, 1'000, milliseconds(5));
    EXPECT_EQ(*link.bytesPerSecond(now), rate) << "small ones tell no more";
    while (frame < 60) send(++frame, 20'000, milliseconds(5));
    EXPECT_NEAR(*link.bytesPerSecond(now), 20'000 / 0.005, 1) << "it is that much at least";
}

TEST(LinkEstimate, BelievesNothingOfWhatWasNotSent) {
    LinkEstimate link;
    const Clock::time_point start;
    link.arrived(1, LinkEstimate::kWhole, start);
    EXPECT_FALSE(link.bytesPerSecond(start).has_value());
    link.sent(1, 100, 100, start + milliseconds(10));
    link.sent(1, 200, 100, start + milliseconds(10));
    link.arrived(7, LinkEstimate::kWhole, start + milliseconds(20));
    EXPECT_EQ(link.bytesUnderWay(), 200u);
    link.arrived(1, 150, start - seconds(9));  // before it was sent
    EXPECT_EQ(link.bytesUnderWay(), 100u);
    EXPECT_EQ(link.waitingSince(), start + milliseconds(10));
    EXPECT_LE(*link.bytesPerSecond(start), 100 * 1000);
}

TEST(LinkEstimate, WaitsSinceSomethingArrivedThatWasSentBefore) {
    LinkEstimate link;
    const Clock::time_point start;
    for (std::uint64_t i = 1; i <= 5; ++i) link.sent(1, i * 100, 100, start);
    EXPECT_EQ(link.waitingSince(), start);
    link.arrived(1, 100, start + seconds(6));
    EXPECT_EQ(link.waitingSince(), start + seconds(6));
    link.arrived(1, 500, start + seconds(8));
    EXPECT_FALSE(link.waitingSince().has_value());
    link.sent(2, LinkEstimate::kWhole, 100, start + seconds(20));
    EXPECT_EQ(link.waitingSince(), start + seconds(20));
}

TEST(QualityControl, FallsAtOnceAndRisesStepByStep) {
    QualityControl quality;
    const Clock::time_point start;
    quality.adapt(1e3, 1e6, start);
    EXPECT_EQ(quality.index(), 0) << "nothing is known of frames yet";
    quality.encoded(0, 90'000, 1e6);
    quality.adapt({}, 1e6, start);
    EXPECT_EQ(quality.index(), 0) << "nor of the link";
    quality.adapt(1e3, 1e6, start);
    const int worst = QualityControl::levelCount() - 1;
    EXPECT_EQ(quality.index(), worst);
    quality.adapt(1e9, 1e6, start + milliseconds(299));
    EXPECT_EQ(quality.index(), worst);
    quality.adapt(1e9, 1e6, start + milliseconds(300));
    EXPECT_EQ(quality.index(), worst - 1);
}

TEST(QualityControl, LeavesSmallFramesAsTheyAre) {
    QualityControl quality;
    quality.encoded(0, 8000, 1e6);
    quality.adapt(1e3, 1e6, Clock::time_point());
    EXPECT_EQ(quality.index(), 0);
}

TEST(QualityControl, OrdersLevelsFromTheBestDown) {
    for (int i = 1; i < QualityControl::levelCount(); ++i) {
        const Level& better = QualityControl::level(i - 1);
        const Level& worse = QualityControl::level(i);
        EXPECT_TRUE(worse.scale < better.scale ||
                    (worse.scale == better.scale && worse.quality < better.quality));
    }
}

}  // namespace
}  // namespace eyrie::stream
