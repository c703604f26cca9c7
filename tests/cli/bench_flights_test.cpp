// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <unistd.h>

#include "cli/bench/flights.h"
#include "fabric/status.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli::bench {
namespace {

using fabric::Vec3;

const fabric::Box kTerrain{{500'000, 5'200'000, 300}, {540'000, 5'240'000, 2'900}};
const fabric::Box kMesh{{-0.1, -0.05, 0.05}, {0.1, 0.04, 0.2}};
const fabric::Box kPlane{{0, 0, 7}, {100, 50, 7}};
const fabric::Box kNeedle{{3, 3, 0}, {3, 3, 10}};
const fabric::Box kPoint{{1, 2, 3}, {1, 2, 3}};

absl::StatusOr<fabric::CameraPath> flightNamed(const std::string& name, const fabric::Box& bounds) {
    ASSIGN_OR_RETURN(const NamedFlight flight, NamedFlight::read(name));
    return flight.over(bounds);
}

Vec3 direction(const fabric::FlightKey& key) {
    return glm::normalize(key.camera.target - key.camera.eye);
}

TEST(BuiltInFlight, HasAPictureInEveryFrameOfAnyDataAndCount) {
    for (const fabric::Box& bounds : {kTerrain, kMesh, kPlane, kNeedle, kPoint})
        for (const char* name : {"orbit", "walkthrough", "worst"})
            for (const int count : {1, 2, 25, 120, 121, 4801}) {
                const auto flight = flightNamed(name, bounds);
                ASSERT_TRUE(flight.ok()) << flight.status();
                ASSERT_TRUE(fabric::validate(flight->flight).ok())
                    << fabric::validate(flight->flight);
                const auto frames = framesOf(flight->flight, count);
                EXPECT_TRUE(frames.ok()) << name << ", " << count << ": " << frames.status();
            }
}

/// Between two frames: by how much the view turns, and how far the eye goes, in diagonals.
struct Step {
    double degrees = 0;
    double diagonals = 0;
};

std::vector<Step> stepsOf(const fabric::Box& bounds, int count) {
    const auto frames = framesOf(worst(bounds), count);
    std::vector<Step> steps;
    for (std::size_t i = 1; i < frames->size(); ++i) {
        const fabric::FlightKey& before = (*frames)[i - 1];
        const fabric::FlightKey& after = (*frames)[i];
        const double cosine = std::clamp(glm::dot(direction(before), direction(after)), -1., 1.);
        steps.push_back(
            {std::acos(cosine) * 180 / std::numbers::pi,
             glm::distance(before.camera.eye, after.camera.eye) / glm::length(bounds.size())});
    }
    return steps;
}

TEST(WorstFlight, TurnsAroundCutsAndJumpsWithinAFrame) {
    for (const fabric::Box& bounds : {kTerrain, kMesh})
        for (const int count : {120, 121, 997}) {
            int turns = 0, cuts = 0, jumps = 0, steady = 0;
            for (const Step& step : stepsOf(bounds, count)) {
                turns += step.degrees > 160 && step.diagonals < 0.2 ? 1 : 0;
                cuts += step.diagonals > 0.25 && step.diagonals < 2 ? 1 : 0;
                jumps += step.diagonals > 3 ? 1 : 0;
                steady += step.degrees < 10 && step.diagonals < 0.15 ? 1 : 0;
            }
            EXPECT_GE(turns, 7) << count;
            EXPECT_GE(cuts, 7) << count;
            EXPECT_GE(jumps, 7) << count;
            EXPECT_GE(steady, count - 25) << count << ": shots are straight";
        }
}

TEST(FlightFile, ThatLeadsThroughNoPictureIsRefusedWithItsSecond) {
    fabric::Flight flight;  // the eye passes through its target half way
    flight.keys = {{0, {{0, 0, 0}, {0, 10, 0}}}, {2, {{0, 20, 0}, {0, 10, 0}}}};
    const auto frames = framesOf(flight, 3);
    EXPECT_THAT(std::string(frames.status().message()),
                testing::HasSubstr("second 1.000 of the flight, between keys[0] and keys[1]: "));
    EXPECT_TRUE(framesOf(flight, 2).ok());
}

TEST(FlightFile, OfOneKeyIsACameraThatStands) {
    const test::TemporaryFolder folder;
    const auto flight = flightNamed(
        folder.write("still.json",
                     R"({"keys":[{"seconds":4,"camera":{"eye":[0,0,9],"target":[1,0,0]}}]})"),
        kTerrain);
    ASSERT_TRUE(flight.ok()) << flight.status();
    const auto frames = framesOf(flight->flight, 7);
    ASSERT_TRUE(frames.ok());
    ASSERT_EQ(frames->size(), 7U);
    for (const fabric::FlightKey& frame : *frames)
        EXPECT_EQ(frame, (fabric::FlightKey{0, flight->flight.keys[0].camera}));
}

TEST(FlightFile, MayBeAPipeAndIsReadOnceForAllRuns) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const std::string text = R"({"keys":[{"camera":{"eye":[0,0,9],"target":[1,0,0]}}]})";
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    const auto flight = NamedFlight::read("/dev/fd/" + std::to_string(ends[0]));
    ::close(ends[0]);
    ASSERT_TRUE(flight.ok()) << flight.status();
    for (int run = 0; run < 2; ++run) {
        const auto path = flight->over(kTerrain);
        ASSERT_TRUE(path.ok()) << path.status();
        EXPECT_EQ(path->flight.keys.at(0).camera.eye, Vec3(0, 0, 9));
    }
}

TEST(FlightFile, RefusalsNameFileKeyAndField) {
    const test::TemporaryFolder folder;
    const auto refusal = [&](const std::string& keys) {
        const auto flight = flightNamed(folder.write("f.json", "{\"keys\":[" + keys + "]}"), kMesh);
        EXPECT_EQ(flight.status().code(), absl::StatusCode::kInvalidArgument);
        return std::string(flight.status().message());
    };
    const auto key = [](const char* seconds, const char* eye, const char* more = "") {
        return std::string(R"({"seconds":)") + seconds + R"(,"camera":{"eye":)" + eye +
               R"(,"target":[1,0,0])" + more + "}}";
    };
    using testing::AllOf;
    using testing::HasSubstr;
    const std::string good = key("0", "[0,0,9]") + ",";
    EXPECT_THAT(refusal(""), AllOf(HasSubstr("f.json"), HasSubstr("no keys")));
    EXPECT_THAT(refusal(good + key("-1", "[0,0,9]")),
                HasSubstr("f.json: keys[1].seconds is -1, not after the 0"));
    EXPECT_THAT(refusal(good + key("0", "[0,0,9]")), HasSubstr("f.json: keys[1].seconds is 0"));
    EXPECT_THAT(refusal(good + key("\"Infinity\"", "[0,0,9]")),
                HasSubstr("f.json: keys[1].seconds is not a finite number"));
    EXPECT_THAT(refusal(good + key("1", "[0,\"NaN\",9]")),
                AllOf(HasSubstr("f.json: keys[1]"), HasSubstr("camera.eye")));
    EXPECT_THAT(refusal(good + key("1", "[1,0,0]")), HasSubstr("f.json: keys[1]"));
    EXPECT_THAT(refusal(good + key("1", "[0,0,9]", R"(,"fovyDegrees":"NaN")")),
                AllOf(HasSubstr("f.json: keys[1]"), HasSubstr("fovyDegrees")));
}

TEST(FlightFile, MayBeACameraPathOfOlderProgramsAndSaysWhatWasAssumed) {
    const test::TemporaryFolder folder;
    const std::string lines = "0 0 9  0 0 1  0 -1 0\n0 1 9  0 0 1  0 -1 0\n";
    const auto normals = flightNamed(folder.write("cam.txt", lines), {{0, 5, 8}, {1, 9, 10}});
    ASSERT_TRUE(normals.ok()) << normals.status();
    EXPECT_THAT(normals->note, testing::HasSubstr("the normals point at the eye"));
    EXPECT_EQ(normals->flight.keys.size(), 2U);
    EXPECT_EQ(normals->flight.keys[0].camera.fovYDegrees, 45);
    const auto eqPly = flightNamed(folder.write("eq.txt", "0 0 0\n1 0 0 -4 0 0 0\n9 0 0 -2 0 0 0"),
                                   {{-2, -1, -1}, {2, 1, 1}});
    ASSERT_TRUE(eqPly.ok()) << eqPly.status();
    EXPECT_EQ(eqPly->flight.keys[0].camera.eye, fabric::Vec3(0, 0, 8)) << "half of 4 m is 1";
    const auto json = flightNamed(
        folder.write("f.txt", "\n {\"keys\":[{\"camera\":{\"eye\":[0,0,9],\"target\":[1,0,0]}}]}"),
        kMesh);
    ASSERT_TRUE(json.ok()) << "by what is in it, not by its name: " << json.status();
    EXPECT_EQ(json->note, "");
}

TEST(FlightFile, ThatIsNeitherJsonNorAPathSaysWhatEachIs) {
    const test::TemporaryFolder folder;
    const auto refusal = [&](const std::string& text) {
        const auto flight = flightNamed(folder.write("cam.txt", text), kMesh);
        EXPECT_EQ(flight.status().code(), absl::StatusCode::kInvalidArgument);
        return std::string(flight.status().message());
    };
    using testing::AllOf;
    using testing::HasSubstr;
    const std::string neither =
        "cam.txt: neither a flight as JSON, {\"keys\":[...]}, nor a camera path: ";
    EXPECT_THAT(refusal(""), AllOf(HasSubstr(neither), HasSubstr("lines of 7 (eqPly)")));
    EXPECT_THAT(refusal("0 0 0\nhere\n"),
                HasSubstr(neither + "line 2 has something else than numbers"));
}

}  // namespace
}  // namespace eyrie::cli::bench
