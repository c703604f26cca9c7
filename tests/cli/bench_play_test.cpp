// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include <gmock/gmock.h>

#include "cli/bench/flights.h"
#include "cli/bench/play.h"
#include "cli/bench/resident_memory.h"

namespace eyrie::cli::bench {
namespace {

/// Whose frames say by their error which camera they are of; drawn by any thread.
class FakePictures final : public PictureSource {
public:
    explicit FakePictures(int atOnce) : atOnce_(atOnce) {}

    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        if (++drawn == failing)
            return absl::UnavailableError("no renderer");
        coordinator::RenderedFrame frame;
        const int smaller = request.budgetMilliseconds ? 2 : 1;
        const coordinator::Shown& shown = request.shown.front();
        frame.image = fabric::makeImage({0, 0, shown.eyesAcross() * (request.width / smaller),
                                         shown.eyesUp() * (request.height / smaller)},
                                        {}, request.wantsDepth);
        frame.statistics.nodes = 1;
        if (isSeen)
            frame.image.colour.back() = {90, 90, 90, 255};
        frame.statistics.tauAskedPixels = request.tauPixels;
        frame.statistics.tauAchievedPixels = request.camera.eye.x;
        if (request.budgetMilliseconds)
            frame.statistics.budget =
                fabric::BudgetUse{*request.budgetMilliseconds, 30, request.tauPixels, 100, 1};
        return frame;
    }
    int framesAtOnce() const override { return atOnce_; }
    fabric::SceneInfo sceneInfo() const override { return scene; }
    fabric::Rgba background() const override { return {}; }

    std::atomic<int> drawn{0};
    int failing = 0;  ///< which one
    bool isSeen = true;
    fabric::SceneInfo scene;

private:
    const int atOnce_;
};

absl::StatusOr<Played> playWith(
    FakePictures& pictures, const std::function<void()>& withEach = [] {},
    PlayOptions options = {}) {
    const fabric::Flight flight = orbit(fabric::Box{{0, 0, 0}, {10, 10, 5}});
    options.frames = 20;
    options.repeats = 2;
    int done = 0;
    const auto frameDone = [&] {
        ++done;
        withEach();
    };
    auto played = play(pictures, flight, options, frameDone, {});
    EXPECT_EQ(done, !played.ok() ? done : options.keeps.empty() ? 60 : 80);
    return played;
}

std::vector<std::pair<double, double>> errors(const Played& played) {
    std::vector<std::pair<double, double>> all;
    for (const PlayedFrame& frame : played.frames)
        all.emplace_back(frame.seconds, frame.statistics.tauAchievedPixels);
    return all;
}

TEST(BenchPlay, HasTheSameFramesInTheSameOrderHoweverManyAreInFlight) {
    FakePictures alone(1);
    FakePictures several(3);
    const auto expected = playWith(alone);
    const auto played = playWith(several);
    ASSERT_TRUE(expected.ok() && played.ok()) << expected.status() << played.status();
    ASSERT_EQ(expected->frames.size(), 60U);
    EXPECT_EQ(errors(*played), errors(*expected));
    EXPECT_EQ(expected->framesInFlight, 1);
    EXPECT_EQ(played->framesInFlight, 3);
}

TEST(BenchPlay, FrameTimeAndLatencyAreOneThingWhereOneFrameIsInFlight) {
    FakePictures alone(1);
    const auto played = playWith(alone);
    ASSERT_TRUE(played.ok()) << played.status();
    for (const PlayedFrame& frame : played->frames)
        EXPECT_EQ(frame.milliseconds, frame.latencyMilliseconds);
}

/// Where several are in flight, it is within the times of frames.
TEST(BenchPlay, TellsWhatTheBenchItselfTakesHoweverManyAreInFlight) {
    const auto work = [] {
        const auto begin = std::chrono::steady_clock::now();
        while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(1)) {
        }
    };
    for (const int atOnce : {1, 3}) {
        FakePictures pictures(atOnce);
        const auto played = playWith(pictures, work);
        ASSERT_TRUE(played.ok()) << played.status();
        double frames = 0;
        for (const PlayedFrame& frame : played->frames) {
            EXPECT_GE(frame.milliseconds, 0);
            EXPECT_GE(frame.latencyMilliseconds, 0);
            frames += frame.pass > 0 ? frame.milliseconds : 0;
        }
        EXPECT_GE(played->overheadPercent / 100 * frames, 40) << "a millisecond each";
    }
}

TEST(BenchPlay, ErrorsOfTwoEyesInOnePictureAreOfAnEyesSize) {
    FakePictures plain(1);
    const auto expected = playWith(plain);
    ASSERT_TRUE(expected.ok()) << expected.status();
    for (const auto stereo : {compound::Stereo::SideBySide, compound::Stereo::TopBottom}) {
        PlayOptions options;
        options.request.shown.front().stereo = stereo;
        FakePictures pictures(1);
        const auto played = playWith(
            pictures, [] {}, options);
        ASSERT_TRUE(played.ok()) << played.status();
        EXPECT_EQ(errors(*played), errors(*expected));
        EXPECT_EQ(played->frames.front().stretch, 1);
        options.request.budgetMilliseconds = 33;
        const auto smaller = playWith(
            pictures, [] {}, options);
        ASSERT_TRUE(smaller.ok()) << smaller.status();
        EXPECT_EQ(smaller->frames.front().stretch, 2);
    }
}

TEST(BenchPlay, KeepsPicturesAndDepthsOfAPassOfItsOwn) {
    FakePictures plain(1);
    const auto expected = playWith(plain);
    ASSERT_TRUE(expected.ok()) << expected.status();
    for (const int atOnce : {1, 3}) {
        FakePictures pictures(atOnce);
        PlayOptions options;
        options.keeps = {3, 10, 19};
        const auto played = playWith(
            pictures, [] {}, options);
        ASSERT_TRUE(played.ok()) << played.status();
        EXPECT_EQ(errors(*played), errors(*expected)) << "which are the passes that are measured";
        ASSERT_EQ(played->kept.size(), 3U);
        EXPECT_EQ(keptBytes(*played), 3U * 8 * options.request.width * options.request.height);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto index = static_cast<std::size_t>(options.keeps[i]);
            EXPECT_TRUE(played->kept[i].image.hasDepth());
            EXPECT_EQ(played->kept[i].statistics.tauAchievedPixels,
                      expected->frames[index].statistics.tauAchievedPixels);
        }
    }
}

TEST(BenchPlay, TellsErrorsInPixelsOfTheSizeAskedForAndKeepsThemInThePicturesOwn) {
    FakePictures pictures(1);
    PlayOptions options;
    const auto whole = playWith(
        pictures, [] {}, options);
    options.request.budgetMilliseconds = 33;
    options.keeps = {0};
    const auto smaller = playWith(
        pictures, [] {}, options);
    ASSERT_TRUE(whole.ok() && smaller.ok());
    const auto promised = [](const Played& played) {
        return played.frames[0].statistics.tauAchievedPixels;
    };
    EXPECT_EQ(promised(*smaller), 2 * promised(*whole));
    EXPECT_EQ(smaller->frames[0].statistics.budget->tauPixels, 2 * options.request.tauPixels);
    EXPECT_EQ(smaller->frames[0].stretch, 2);
    EXPECT_EQ(whole->frames[0].stretch, 1);
    EXPECT_EQ(smaller->kept[0].statistics.tauAchievedPixels, promised(*whole));
    EXPECT_EQ(stretch({905, 509}, 1280, 720), 720. / 509) << "the longer way";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // those keep what is freed
/// As a run before this one has, in blocks too small to be the system's own.
TEST(ResidentMemory, PeaksDoNotHaveWhatWasFreedBefore) {
    constexpr std::size_t kBlock = 4096;
    constexpr std::size_t kBlocks = 32768;
    const auto last = [] {
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < kBlocks; ++i) {
            blocks.push_back(std::make_unique<char[]>(kBlock));
            std::fill_n(blocks.back().get(), kBlock, 'x');
        }
        return std::move(blocks.back());  // above all others, which cannot be cut off
    }();
    const std::uint64_t before = peakResidentBytes();
    resetPeakResidentBytes();
    EXPECT_LT(peakResidentBytes() + kBlock * kBlocks / 2, before);
}
#endif

/// Nodes may be in view of which no pixel is seen.
TEST(BenchPlay, AFrameShowsSomethingByItsPixels) {
    FakePictures pictures(1);
    const auto seen = playWith(pictures);
    ASSERT_TRUE(seen.ok()) << seen.status();
    EXPECT_TRUE(std::ranges::all_of(seen->frames, &PlayedFrame::showsSomething));
    int done = 0;
    const auto half = playWith(pictures, [&] { pictures.isSeen = ++done % 2 == 0; });
    ASSERT_TRUE(half.ok()) << half.status();
    EXPECT_EQ(std::ranges::count(half->frames, true, &PlayedFrame::showsSomething), 30);
}

TEST(BenchPlay, AFlightThatSeesNothingSaysSoWithTheRemedyForScenesOfTheirSize) {
    FakePictures pictures(1);
    pictures.isSeen = false;
    pictures.scene.bounds = {{0, 0, 0}, {3, 0, 0}};
    EXPECT_THAT(playWith(pictures).status().ToString(),
                testing::HasSubstr("(3, 0, 0); fly where the data are"));
    pictures.scene.bounds.max.x = 0.0005;
    EXPECT_THAT(playWith(pictures).status().ToString(),
                testing::HasSubstr("(0.0005, 0, 0); the scene is 0.5 mm across"));
}

TEST(BenchPlay, AFrameThatCannotBeHadEndsItWithItsSecond) {
    for (const int atOnce : {1, 3}) {
        FakePictures pictures(atOnce);
        pictures.failing = 7;
        const auto played = playWith(pictures);
        EXPECT_THAT(
            std::string(played.status().message()),
            testing::AllOf(testing::HasSubstr("of the flight"), testing::HasSubstr("no renderer")));
    }
}

}  // namespace
}  // namespace eyrie::cli::bench
