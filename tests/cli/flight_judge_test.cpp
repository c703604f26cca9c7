// SPDX-License-Identifier: Apache-2.0
// How frames of a flight are held against what they show, and what is said of them.
#include "cli/bench/flight_judge.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "cli/bench/errors_csv.h"
#include "cli/bench/flights.h"
#include "cli/bench/reference.h"
#include "fabric/frustum.h"

namespace eyrie::cli::bench {
namespace {

TEST(JudgedFrames, TakeMoreTheMoreAreKeptButNoMoreThanArePlayed) {
    const std::uint64_t one = neededBytes({640, 360, 24, 1});
    EXPECT_EQ(neededBytes({640, 360, 24, 24}) - one, 23U * 640 * 360 * 20);
    EXPECT_EQ(neededBytes({640, 360, 24, 1000}), neededBytes({640, 360, 24, 24}));
    EXPECT_EQ(neededBytes({1280, 720, 24, 1}), 4 * one);
    EXPECT_EQ(neededBytes({640, 360, 24, 6, 3}) - neededBytes({640, 360, 24, 6}),
              3U * 6 * 640 * 360 * 8)
        << "pictures that three runs keep";
}

TEST(JudgedFrames, AreOneOfEachPartOfTheFlight) {
    for (const int played : {1, 5, 6, 7, 24, 120, 1000})
        for (const int count : {1, 4, 6, 7, 1000}) {
            const std::vector<int> frames = judgedFrames({.played = played, .judged = count});
            const int parts = std::min(played, count);
            ASSERT_EQ(frames.size(), static_cast<std::size_t>(parts));
            for (int i = 0; i < parts; ++i) {
                EXPECT_GE(frames[static_cast<std::size_t>(i)], i * played / parts);
                EXPECT_LT(frames[static_cast<std::size_t>(i)], (i + 1) * played / parts);
            }
        }
}

/// Of which every second is of another kind: turned back, or far away.
TEST(JudgedFrames, OfTheWorstFlightAreOfShotsOfBothKinds) {
    const fabric::Flight flight = worst(fabric::Box{{0, 0, 0}, {10, 10, 5}});
    for (const int played : {12, 24, 48, 60, 120, 240}) {
        std::array<int, 6> seen{};  // of each third, even and odd
        for (const int frame : judgedFrames({.played = played, .judged = 6})) {
            const double seconds = flight.seconds() * frame / (played - 1);
            const int shot = std::min(static_cast<int>(seconds / 0.5), 23);
            ++seen.at(static_cast<std::size_t>(shot / 8 * 2 + shot % 2));
        }
        EXPECT_GT(seen[0] + seen[2] + seen[4], 0) << played;
        EXPECT_GT(seen[1] + seen[3] + seen[5], 0) << played;
        if (played >= 24) {
            EXPECT_THAT(seen, testing::Each(1)) << played;
        }
    }
}

/// A plane whose pictures have it `lift` higher.
class LiftedPlane final : public PictureSource {
public:
    explicit LiftedPlane(float lift) : drawn_(grid(7 + lift)) {}

    static std::shared_ptr<truth::TerrainRayCaster> source() {
        return std::make_shared<truth::TerrainRayCaster>(grid(7));
    }

    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        coordinator::RenderedFrame frame;
        frame.image = fabric::makeImage({0, 0, request.width, request.height}, {}, true);
        const auto view =
            truth::castView(truth::Pinhole(request.camera, request.width, request.height), drawn_);
        for (std::size_t i = 0; i < view.hits.size(); ++i)
            frame.image.depth[i] = static_cast<float>(fabric::kNearMetres / view.hits[i].first);
        return frame;
    }
    fabric::SceneInfo sceneInfo() const override { return {}; }
    fabric::Rgba background() const override { return {}; }

private:
    static truth::HeightGrid grid(float height) {
        return {.columns = 65, .rows = 65, .heights = std::vector<float>(65 * 65, height)};
    }
    const truth::TerrainRayCaster drawn_;
};

/// A picture of 320 x 180 that was asked for and, of the lifted plane, drawn at `width` x `height`
/// with some promise in its own pixels, held against the plane.
FrameError judged(int width, int height, double promisedPixels) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Flight flight{
        {{0, {.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20}}}};
    FlightJudge judge(std::move(scene), flight, {320, 180, 1, 1}, {});
    LiftedPlane pictures(0.25F);
    coordinator::FrameRequest request;
    request.camera = flight.keys[0].camera;
    request.width = width;
    request.height = height;
    std::vector<coordinator::RenderedFrame> shown{pictures.draw(request).value()};
    shown[0].statistics.tauAchievedPixels = promisedPixels;
    shown[0].statistics.budget = {.milliseconds = 33, .tauPixels = 3};
    request.width = 320;
    request.height = 180;
    const auto measured = judge.judge(std::move(shown), pictures, request, [] {}, {});
    EXPECT_TRUE(measured.ok()) << measured.status();
    return measured.ok() ? measured->frames.at(0) : FrameError{};
}

TEST(FlightJudge, HoldsASmallerPictureAgainstItsPromiseInPixelsOfTheSizeAskedFor) {
    const FrameError whole = judged(320, 180, 100);
    const FrameError half = judged(160, 90, 50);
    EXPECT_GT(whole.maxPixels, 2);
    EXPECT_EQ(half.compared, 160U * 90);
    EXPECT_NEAR(half.maxPixels, whole.maxPixels, 0.02 * whole.maxPixels);
    EXPECT_NEAR(half.p50Pixels, whole.p50Pixels, 0.02 * whole.p50Pixels);
    EXPECT_EQ(whole.stretch, 1);
    EXPECT_EQ(half.stretch, 2);
    EXPECT_EQ(half.promisedPixels, 100);
    EXPECT_EQ(half.drawnTauPixels, 3) << "which the frame time came to";
    const double own = half.maxPixels / 2;
    EXPECT_TRUE(keepsPromise(judged(160, 90, 1.01 * own)));
    EXPECT_FALSE(keepsPromise(judged(160, 90, 0.9 * own)));
    EXPECT_FALSE(keepsPromise(judged(320, 180, 1.01 * own))) << "twice as many of its own pixels";
}

TEST(FlightJudge, AFrameThatShowsNothingDidNotComeClosestToItsPromise) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera away{.eye = {32, -60, 30}, .target = {32, -120, 60}, .fovYDegrees = 20};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(std::move(scene), fabric::Flight{{{0, away}, {1, there}}},
                      {.width = 160, .height = 90, .played = 2, .judged = 2}, {});
    LiftedPlane pictures(0.25F);
    coordinator::FrameRequest request;
    request.width = 160;
    request.height = 90;
    const auto measured = judge.judge(pictures, pictures, request, [] {}, {});
    ASSERT_TRUE(measured.ok()) << measured.status();
    EXPECT_TRUE(isEmpty(measured->frames.at(0)));
    EXPECT_EQ(measured->worst.at(0).error.seconds, 1);
}

/// The second is drawn where it is, but for a hole.
TEST(FlightJudge, AFrameWithHolesIsWorseThanOneThatComesNearItsPromise) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(std::move(scene), fabric::Flight{{{0, there}, {1, there}}},
                      {.width = 160, .height = 90, .played = 2, .judged = 2}, {});
    LiftedPlane lifted(0.25F);
    LiftedPlane exact(0);
    coordinator::FrameRequest request;
    request.camera = there;
    request.width = 160;
    request.height = 90;
    std::vector<coordinator::RenderedFrame> shown{lifted.draw(request).value(),
                                                  exact.draw(request).value()};
    for (coordinator::RenderedFrame& frame : shown) frame.statistics.tauAchievedPixels = 2;
    for (std::size_t row = 40; row < 50; ++row)
        std::fill_n(shown[1].image.depth.begin() + static_cast<std::ptrdiff_t>(row * 160 + 75), 10,
                    0.0F);
    const auto measured = judge.judge(std::move(shown), exact, request, [] {}, {});
    ASSERT_TRUE(measured.ok()) << measured.status();
    EXPECT_TRUE(keepsPromise(measured->frames.at(0)));
    EXPECT_GT(measured->frames[0].maxPixels, 1);
    EXPECT_LT(measured->frames.at(1).maxPixels, 0.1);
    EXPECT_EQ(measured->frames[1].holes, 100U);
    EXPECT_EQ(measured->worst.at(0).error.seconds, 1);
}

/// With a hole in it, drawn by so many channels.
FrameError judgedWithAHole(std::size_t channels, bool complete, bool memoryRaisedTau) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(std::move(scene), fabric::Flight{{{0, there}}},
                      {.width = 160, .height = 90, .played = 1, .judged = 1}, {});
    LiftedPlane exact(0);
    coordinator::FrameRequest request;
    request.camera = there;
    request.width = 160;
    request.height = 90;
    std::vector<coordinator::RenderedFrame> shown{exact.draw(request).value()};
    shown[0].statistics.complete = complete;
    shown[0].statistics.memoryRaisedTau = memoryRaisedTau;
    shown[0].parts.resize(channels);
    for (std::size_t row = 40; row < 50; ++row)
        std::fill_n(shown[0].image.depth.begin() + static_cast<std::ptrdiff_t>(row * 160 + 75), 10,
                    0.0F);
    const auto measured = judge.judge(std::move(shown), exact, request, [] {}, {});
    EXPECT_TRUE(measured.ok()) << measured.status();
    return measured.ok() ? measured->frames.at(0) : FrameError{};
}

TEST(FlightJudge, HolesBreakNoPromiseBetweenChannelsOfDifferentDataAlone) {
    for (const FrameError& seams :
         {judgedWithAHole(2, false, false), judgedWithAHole(2, true, true)}) {
        EXPECT_EQ(seams.holes, 100U) << "they are told";
        EXPECT_TRUE(keepsPromise(seams));
        FrameError drawnBeside = seams;
        drawnBeside.falseHits = 1;
        EXPECT_FALSE(keepsPromise(drawnBeside));
    }
    EXPECT_FALSE(keepsPromise(judgedWithAHole(2, true, false)));
    EXPECT_FALSE(keepsPromise(judgedWithAHole(1, false, false)));
    EXPECT_FALSE(keepsPromise(judgedWithAHole(1, true, true)));
}

/// Tells at which tau it was asked for pictures.
class TauPictures final : public PictureSource {
public:
    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        taus.push_back(request.tauPixels);
        return exact_.draw(request);
    }
    fabric::SceneInfo sceneInfo() const override { return {}; }
    fabric::Rgba background() const override { return {}; }

    std::vector<double> taus;

private:
    LiftedPlane exact_{0};
};

TEST(FlightJudge, ComparesColoursWithTheFinestWhicheverRunComesFirst) {
    const auto plane = LiftedPlane::source();
    ReferenceScene scene{{{{plane, nullptr}, "plane.eyt"}},
                         std::make_shared<truth::PlacedSurfaces>(
                             std::vector<truth::PlacedSurface>{{plane, fabric::Mat4(1)}})};
    const fabric::Camera there{.eye = {32, -60, 30}, .target = {32, -32, 7}, .fovYDegrees = 20};
    FlightJudge judge(
        std::move(scene), fabric::Flight{{{0, there}}},
        {.width = 160, .height = 90, .played = 1, .judged = 1, .finestTauPixels = 0.01}, {});
    LiftedPlane pictures(0.25F);
    TauPictures finest;
    for (const double tau : {1.0, 0.01}) {
        coordinator::FrameRequest request;
        request.width = 160;
        request.height = 90;
        request.tauPixels = tau;
        ASSERT_TRUE(judge.judge(pictures, finest, request, [] {}, {}).ok());
    }
    EXPECT_THAT(finest.taus, testing::ElementsAre(0.01)) << "drawn once, for both";
}

std::vector<BenchRun> runWith(double maxPixels, double promisedPixels) {
    BenchRun run;
    run.label = "2 px";
    run.tauPixels = 2;
    run.measured.emplace();
    run.measured->frames.push_back({.promisedPixels = 1, .maxPixels = 0.25});
    run.measured->frames.push_back(
        {.seconds = 7, .promisedPixels = promisedPixels, .maxPixels = maxPixels});
    return {run};
}

TEST(CheckPromises, NamesTheFrameThatBreaksItsOwn) {
    EXPECT_TRUE(checkPromises(runWith(1.5, 1.5)).ok());
    EXPECT_TRUE(checkPromises(runWith(90, std::numeric_limits<double>::infinity())).ok());
    const absl::Status broken = checkPromises(runWith(1.6, 1.5));
    EXPECT_EQ(broken.code(), absl::StatusCode::kInternal);
    EXPECT_THAT(broken.ToString(), testing::HasSubstr("second 7.000"));
    EXPECT_THAT(broken.ToString(), testing::HasSubstr("broken at 2 px, second 7.000"));
    std::vector<BenchRun> seenThrough = runWith(1.5, 1.5);
    seenThrough[0].measured->frames[0].holes = 3;
    EXPECT_THAT(checkPromises(seenThrough).ToString(), testing::HasSubstr("3 pixels are empty"));
}

TEST(ErrorsCsv, HasALineAFrameAndIsNothingWithoutAReference) {
    EXPECT_EQ(errorsCsv({BenchRun{}}), "");
    const std::string csv = errorsCsv(runWith(1.25, 1.5));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    EXPECT_THAT(csv, testing::HasSubstr("\n2 px,2,0,7.000,1.5,0,0,1.25,"));
}

}  // namespace
}  // namespace eyrie::cli::bench
