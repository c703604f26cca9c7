// SPDX-License-Identifier: Apache-2.0
// `eyrie bench` as its users run it.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <absl/strings/str_split.h>
#include <gmock/gmock.h>

#include "tests/support/image_files.h"
#include "tests/support/json.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using test::eyrie;
using test::number;
using test::succeeded;

class Bench : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TemporaryFolder>();
        ASSERT_TRUE(succeeded({"synth", "terrain", "--size", "257", "--seed", "3", "-o", dem()}));
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string dem() { return folder_->path("dem.eyt"); }
    static std::string path(const std::string& name) { return folder_->path(name); }

    static test::JsonValue summaryOf(const std::string& report) {
        const auto text = test::readFile(report + "/summary.json");
        EXPECT_TRUE(text.ok()) << text.status();
        return test::parseJson(text.value_or("{}"));
    }

    static std::string writeFlight(const std::string& name, const std::string& keys) {
        std::ofstream(path(name)) << R"({"keys":[)" << keys << "]}";
        return path(name);
    }

    static inline std::unique_ptr<test::TemporaryFolder> folder_;
};

/// A key at `seconds` that looks at the terrain's middle from the south.
std::string key(double seconds, double height) {
    return "{\"seconds\":" + std::to_string(seconds) + R"(,"camera":{"eye":[503840,5194000,)" +
           std::to_string(height) + R"(],"target":[503840,5203840,1500]}})";
}

TEST_F(Bench, AReportHasARunForEachTau) {
    const std::string report = path("report");
    ASSERT_TRUE(succeeded({"bench", dem(), "--tau", "1,4", "--size", "320x180", "--frames", "4",
                           "--repeats", "2", "-o", report}));
    EXPECT_EQ(test::namesIn(report),
              (std::set<std::string>{"frames.csv", "index.html", "summary.json"}));
    const auto runs = test::list(summaryOf(report), "runs");
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_LE(number(runs[0], "tauAchievedMax"), 1);
    EXPECT_LE(number(runs[1], "tauAchievedMax"), 4);
    EXPECT_GT(number(runs[0], "tauAchievedMax"), 0);
    EXPECT_GT(number(runs[0], "trianglesMean"), number(runs[1], "trianglesMean"));
    EXPECT_GT(number(runs[0], "fpsMedian"), 0);
    EXPECT_GT(number(runs[0], "stagesMs.vertices"), 0);
    EXPECT_NE(test::at(runs[0], "limitingStage").string_value(), "");
    EXPECT_GT(number(runs[0], "bytesLoaded"), 0);
    EXPECT_GT(number(runs[0], "peakResidentBytes"), 1e6);
}

/// --eye is drawn by one renderer at least.
TEST_F(Bench, WhatIsAskedForTwiceIsMeasuredOnce) {
    const auto labels = [&](std::vector<std::string> asked) {
        asked.insert(asked.begin(), {"bench", dem(), "--size", "80x45", "--frames", "1",
                                     "--repeats", "1", "-o", path("once")});
        EXPECT_TRUE(succeeded(asked));
        std::vector<std::string> found;
        for (const test::JsonValue& run : test::list(summaryOf(path("once")), "runs"))
            found.push_back(test::at(run, "label").string_value());
        return found;
    };
    EXPECT_THAT(labels({"--tau", "4,1,4.0,1"}), testing::ElementsAre("4 px", "1 px"));
    EXPECT_THAT(labels({"--budget-ms", "33,33", "--renderers", "0,0"}),
                testing::ElementsAre("33 ms"));
    EXPECT_THAT(labels({"--tau", "1", "--renderers", "0,1", "--eye", "left"}),
                testing::ElementsAre("1 px"));
}

TEST_F(Bench, OfARecordedFlightKeepsTauForAnyNumberOfProcesses) {
    const std::string flight = writeFlight("flight.json", key(0, 2500) + "," + key(2, 4000));
    const auto errorWith = [&](const std::vector<std::string>& renderers, const char* name) {
        std::vector<std::string> arguments{"bench",     dem(),    "--flight", flight,     "--tau",
                                           "2",         "--size", "320x180",  "--frames", "3",
                                           "--repeats", "1",      "-o",       path(name)};
        arguments.insert(arguments.end(), renderers.begin(), renderers.end());
        EXPECT_TRUE(succeeded(arguments));
        return number(test::list(summaryOf(path(name)), "runs").at(0), "tauAchievedMax");
    };
    // Not the same number: each channel looks closely at some of its own tiles.
    const auto keepsTau = testing::AllOf(testing::Gt(0.5), testing::Le(2));
    EXPECT_THAT(errorWith({}, "alone"), keepsTau);
    EXPECT_THAT(errorWith({"--renderers", "2"}, "two"), keepsTau);
    EXPECT_THAT(errorWith({"--renderers", "2", "--compound", "DB"}, "two_db"), keepsTau);
}

TEST_F(Bench, TunesAMeshAndTheFileSaysSo) {
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "3000", "--seed", "3", "-o", path("m.ply")}));
    const std::string away = R"("camera":{"eye":[0,-30,0],"target":[0,0,0]}})";
    const std::string flight =
        writeFlight("away.json", R"({"seconds":0,)" + away + R"(,{"seconds":1,)" + away);
    const test::Outcome tuned =
        eyrie({"import", "mesh", path("m.ply"), "--tune", flight, "-o", path("m.eym"), "--json"},
              {}, std::chrono::minutes(4));
    ASSERT_EQ(tuned.exit, (test::Exit{0, 0})) << tuned.errors;
    const auto tried = test::list(test::parseJson(tuned.output), "tuned");
    ASSERT_EQ(tried.size(), 1U) << "the smallest leaf holds all of it";
    EXPECT_EQ(number(tried[0], "leafTriangles"), 4096);
    EXPECT_GT(number(tried[0], "frameMs"), 0);
    const test::Outcome facts = eyrie({"info", path("m.eym"), "--json"});
    EXPECT_EQ(number(test::parseJson(facts.output), "tunedLeafTriangles"), 4096);
    const auto before = test::namesIn(path(""));
    for (const char* none : {"missing.json", "loop"})
        EXPECT_EQ(
            eyrie({"import", "mesh", path("m.ply"), "--tune", none, "-o", path("n.eym")}).exit,
            (test::Exit{2, 0}));
    EXPECT_EQ(test::namesIn(path("")), before);
}

/// A terrain and two balls above it, one of them twice as large.
TEST_F(Bench, MeasuresWhatASceneShowsAgainstItsSources) {
    ASSERT_TRUE(
        succeeded({"synth", "terrain", "--size", "129", "--seed", "3", "-o", path("t.tif")}));
    ASSERT_TRUE(succeeded({"import", "terrain", path("t.tif"), "-o", path("t.eyt")}));
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "6000", "--seed", "3", "-o", path("b.ply")}));
    folder_->write("scene.json", R"({"objects":[{"terrain":"t.eyt"},
        {"mesh":"b.ply","transform":{"translation":[501500,5198500,3000],"scale":400}},
        {"mesh":"b.ply","transform":{"translation":[502900,5198500,3000],"scale":800}}]})");
    const test::TemporaryFolder cache;
    const std::string report = path("reference");
    ASSERT_TRUE(succeeded({"bench", path("scene.json"), "--tau", "1,8", "--size", "160x90",
                           "--frames", "3", "--repeats", "1", "--reference", "--reference-frames",
                           "2", "--cache", cache.path("imports"), "-o", report}));
    EXPECT_THAT(test::namesIn(report), testing::Contains("errors.csv"));
    const test::JsonValue summary = summaryOf(report);
    const auto runs = test::list(summary, "runs");
    ASSERT_EQ(runs.size(), 2U);
    for (const auto& run : runs) {
        EXPECT_TRUE(test::at(run, "measuredWithinPromise").bool_value());
        EXPECT_GT(number(run, "errorPx.max"), 0);
        EXPECT_LE(number(run, "errorPx.max"), number(run, "tauAchievedMax") + 1.0 / 256);
        EXPECT_LE(number(run, "errorPx.p99"), number(run, "errorPx.max"));
        EXPECT_EQ(number(run, "holes") + number(run, "falseHits") + number(run, "misplaced"), 0);
        EXPECT_GT(number(run, "ssim"), 0.8);
    }
    EXPECT_LE(number(runs[0], "errorPx.p99"), number(runs[1], "errorPx.p99"));
    EXPECT_GE(test::list(summary, "uniform").size(), 1U);
}

/// What does not fit is left out and promised, and colours are compared with what would be there.
TEST_F(Bench, WithLittleMemoryPromisesMoreAndKeepsIt) {
    ASSERT_TRUE(
        succeeded({"synth", "terrain", "--size", "257", "--seed", "4", "-o", path("few.tif")}));
    ASSERT_TRUE(succeeded({"import", "terrain", path("few.tif"), "-o", path("few.eyt")}));
    ASSERT_TRUE(
        succeeded({"synth", "mesh", "--size", "30000", "--seed", "4", "-o", path("few.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("few.ply"), "-o", path("few.eym")}));
    for (const auto& [data, flight] : {std::pair("few.eyt", "worst"), {"few.eym", "orbit"}}) {
        SCOPED_TRACE(data);
        const auto runWith = [&](const std::string& memory) {
            const std::string report = path("few");
            EXPECT_TRUE(
                succeeded({"bench", path(data), "--flight", flight, "--tau", "0.25", "--size",
                           "320x180", "--frames", "8", "--repeats", "1", "--reference",
                           "--reference-frames", "8", "--memory", memory, "-o", report}));
            return test::list(summaryOf(report), "runs").at(0);
        };
        const test::JsonValue all = runWith("1G");
        const test::JsonValue few = runWith("400K");
        EXPECT_LE(number(all, "tauAchievedMax"), 0.25);
        EXPECT_GT(number(few, "tauAchievedMax"), 0.25);
        EXPECT_LT(number(few, "trianglesMean"), number(all, "trianglesMean"));
        EXPECT_GT(number(few, "errorPx.max"), number(all, "errorPx.max"));
        EXPECT_TRUE(test::at(few, "measuredWithinPromise").bool_value());
        EXPECT_LT(number(few, "psnrDb"), 60);
    }
}

TEST_F(Bench, PlaysCameraPathsOfOlderProgramsAndSaysWhatItAssumed) {
    std::ofstream(path("path.txt")) << "-90 0 0\n1 0 0 -2  0 30 0\n60 0.2 0 -1.5  0 30 0\n";
    const test::Outcome outcome =
        eyrie({"bench", dem(), "--flight", path("path.txt"), "--tau", "4", "--size", "160x90",
               "--frames", "3", "--repeats", "1", "-o", path("pathed")});
    ASSERT_EQ(outcome.exit.status, 0) << outcome.errors;
    EXPECT_THAT(outcome.errors, testing::HasSubstr("path.txt: An eqPly path, at 30 frames a "
                                                   "second, the scene as its model"));
    EXPECT_EQ(test::at(summaryOf(path("pathed")), "bench.flight").string_value(), "path.txt");
}

/// Turns on the spot, far cuts, near and far, an S low over all of it, and once around: the flights
/// on which errors are told, and none of their frames left out.
TEST_F(Bench, EveryFrameOfTheTestFlightsKeepsItsPromiseAtEveryTau) {
    ASSERT_TRUE(
        succeeded({"synth", "terrain", "--size", "257", "--seed", "4", "-o", path("all.tif")}));
    ASSERT_TRUE(succeeded({"import", "terrain", path("all.tif"), "-o", path("all.eyt")}));
    ASSERT_TRUE(
        succeeded({"synth", "mesh", "--size", "30000", "--seed", "4", "-o", path("all.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("all.ply"), "-o", path("all.eym")}));
    for (const char* data : {"all.eyt", "all.eym"})
        for (const auto& [flight, count] :
             {std::pair("worst", 24), {"walkthrough", 24}, {"orbit", 12}}) {
            SCOPED_TRACE(std::string(data) + ", " + flight);
            const std::string report = path("all-frames");
            const std::string frameCount = std::to_string(count);
            EXPECT_TRUE(succeeded({"bench", path(data), "--flight", flight, "--tau", "0.5,1,2,4,8",
                                   "--size", "160x90", "--frames", frameCount, "--repeats", "1",
                                   "--reference", "--reference-frames", frameCount, "-o", report}));
            const auto runs = test::list(summaryOf(report), "runs");
            ASSERT_EQ(runs.size(), 5U);
            for (const auto& run : runs) {
                EXPECT_GE(number(run, "framesMeasured"), count * 5 / 6) << "some show nothing";
                EXPECT_TRUE(test::at(run, "measuredWithinPromise").bool_value());
            }
            // Of terrain, and of meshes in full detail, normals are the source's.
            const auto normals = [](const test::JsonValue& run) {
                return number(run, "normalErrorMeanDegreesMax");
            };
            if (std::string(data) == "all.eym")
                EXPECT_GT(normals(runs[4]), 0);
            else
                EXPECT_EQ(normals(runs[4]), 0);
            const auto errors = test::readFile(report + "/errors.csv");
            ASSERT_TRUE(errors.ok()) << errors.status();
            EXPECT_EQ(std::count(errors->begin(), errors->end(), '\n'), 1 + 5 * count);
            const auto frames = test::readFile(report + "/frames.csv");
            ASSERT_TRUE(frames.ok()) << frames.status();
            const std::vector<std::string> lines = absl::StrSplit(*frames, '\n');
            ASSERT_EQ(std::ssize(lines), 1 + 5 * 2 * count + 1);
            EXPECT_EQ(std::ranges::count(lines[0], ','), std::ranges::count(lines[1], ','));
        }
}

TEST_F(Bench, PicturesThatHoldAFrameTimeKeepTheirPromise) {
    ASSERT_TRUE(
        succeeded({"synth", "mesh", "--size", "30000", "--seed", "4", "-o", path("held.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("held.ply"), "-o", path("held.eym")}));
    const std::string report = path("held");
    // A millisecond makes pictures coarse and, mostly, small.
    ASSERT_TRUE(succeeded({"bench", path("held.eym"), "--flight", "worst", "--budget-ms", "1,30",
                           "--renderers", "0,2", "--size", "320x180", "--frames", "24", "--repeats",
                           "1", "--reference", "--reference-frames", "12", "-o", report}));
    const auto runs = test::list(summaryOf(report), "runs");
    ASSERT_EQ(runs.size(), 4U);
    for (const auto& run : runs) {
        EXPECT_GE(number(run, "framesMeasured"), 10) << "some show nothing";
        EXPECT_TRUE(test::at(run, "measuredWithinPromise").bool_value());
        EXPECT_GT(number(run, "errorPx.max"), 0);
    }
    const auto errors = test::readFile(report + "/errors.csv");
    ASSERT_TRUE(errors.ok()) << errors.status();
    EXPECT_EQ(std::count(errors->begin(), errors->end(), '\n'), 1 + 4 * 12);
    EXPECT_THAT(*errors, testing::HasSubstr("\n1 ms,0.5,2,"));
}

/// What a picture shows is held against the source that it was made of, wherever things meet. The
/// terrain has gaps, some of them behind its crests.
TEST_F(Bench, ScenesOfManyThingsKeepTheirPromise) {
    ASSERT_TRUE(succeeded({"import", "terrain",
                           EYRIE_SOURCE_DIR "/../shared/data/terrain/mt_rainier_90m.tif.gz", "-o",
                           path("gaps.eyt")}));
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "9000", "--seed", "8", "-o", path("m.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("m.ply"), "-o", path("m.eym")}));
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> share(-1, 1);
        const auto placed = [&](const std::string& data, double scale) {
            return "{" + data + R"(,"transform":{"scale":)" + std::to_string(scale) +
                   R"(,"axisDegrees":[0.6,0,0.8,)" + std::to_string(90 * share(random)) +
                   R"(],"translation":[)" + std::to_string(615000 + 30000 * share(random)) + "," +
                   std::to_string(5150000 + 30000 * share(random)) + "," +
                   std::to_string(3000 + 3000 * share(random)) + "]}}";
        };
        const std::string mesh = R"("mesh":"m.eym")";
        folder_->write("many.json", R"({"objects":[{"terrain":"gaps.eyt"},)" + placed(mesh, 20000) +
                                        "," + placed(mesh, 9000) + "]}");
        const std::string report = path("many");
        EXPECT_TRUE(succeeded({"bench", path("many.json"), "--tau", "2", "--size", "200x150",
                               "--frames", "6", "--repeats", "1", "--reference", "-o", report}))
            << "seed " << seed;
        const auto runs = test::list(summaryOf(report), "runs");
        ASSERT_EQ(runs.size(), 1U);
        EXPECT_LE(number(runs[0], "errorPx.max"), 2 + 1.0 / 256) << "seed " << seed;
    }
}

/// Of triangles seen edge-on the depth is their planes', beyond them: it is no broken promise.
TEST_F(Bench, PromisesOfNextToNothingAreKept) {
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "2000", "--seed", "3", "-o", path("e.ply")}));
    const test::TemporaryFolder cache;
    const std::string report = path("edge-on");
    ASSERT_TRUE(succeeded({"bench", path("e.ply"), "--tau", "1", "--size", "320x240", "--frames",
                           "4", "--repeats", "1", "--reference", "--cache", cache.path("imports"),
                           "-o", report}));
    const auto runs = test::list(summaryOf(report), "runs");
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_LT(number(runs[0], "tauAchievedMax"), 0.01);
    EXPECT_LE(number(runs[0], "errorPx.max"), number(runs[0], "tauAchievedMax") + 1.0 / 256);
}

/// The same view once, beside one that looks away, and twice.
TEST_F(Bench, WhatIsMeasuredHasNothingOfFramesThatShowNothing) {
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "2000", "--seed", "3", "-o", path("n.ply")}));
    const std::string there = R"({"seconds":0,"camera":{"eye":[4,0,0],"target":[0,0,0]}})";
    const std::string away = R"({"seconds":9,"camera":{"eye":[4,0,0],"target":[8,0,0]}})";
    const test::TemporaryFolder cache;
    const auto measured = [&](const std::string& name, const std::string& keys) {
        const std::string flight = writeFlight(name + ".json", keys);
        EXPECT_TRUE(succeeded({"bench", path("n.ply"), "--flight", flight, "--tau", "8", "--size",
                               "160x90", "--frames", "2", "--repeats", "1", "--reference",
                               "--cache", cache.path("imports"), "-o", path(name)}));
        return summaryOf(path(name));
    };
    const test::JsonValue seen = measured("seen", there);
    const test::JsonValue half = measured("half seen", there + "," + away);
    const auto runOf = [](const auto& summary) { return test::list(summary, "runs").at(0); };
    EXPECT_EQ(number(runOf(half), "framesMeasured"), 1);
    EXPECT_EQ(number(runOf(half), "framesJudged"), 2);
    EXPECT_EQ(number(runOf(half), "trianglesMeasured"), number(runOf(seen), "trianglesMeasured"));
    const auto finestOf = [](const auto& summary) { return test::list(summary, "uniform").at(0); };
    EXPECT_EQ(number(finestOf(half), "triangles"), number(finestOf(seen), "triangles"));
}

TEST_F(Bench, RefusesAReferenceThatIsNone) {
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "3000", "--seed", "5", "-o", path("r.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("r.ply"), "-o", path("r.eym")}));
    const auto refusal = [&](const std::string& scene, const std::vector<std::string>& more,
                             int status) {
        std::vector<std::string> arguments{"bench", scene, "-o", path("none")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{status, 0})) << outcome.errors;
        EXPECT_FALSE(std::filesystem::exists(path("none")));
        return outcome.errors;
    };
    EXPECT_THAT(refusal(dem(), {"--reference"}, 2), testing::HasSubstr("--source"))
        << "it was made of no file";
    EXPECT_THAT(refusal(path("r.eym"), {"--reference", "--reference-memory", "64K"}, 1),
                testing::HasSubstr("--reference-memory"));
    EXPECT_THAT(refusal(path("r.eym"),
                        {"--reference", "--reference-memory", "8M", "--reference-frames", "24"}, 1),
                testing::HasSubstr("24 frames of 1280 x 720 pixels"));
    EXPECT_THAT(refusal(path("r.eym"), {"--source", path("r.ply")}, 2),
                testing::HasSubstr("--reference"));
    for (const auto& [option, value] : {std::pair("--stereo", "anaglyph"),
                                        {"--stereo", "side-by-side"},
                                        {"--stereo", "top-bottom"},
                                        {"--eye", "left"},
                                        {"--canvas", "0"},
                                        {"--segment", "0"}})
        EXPECT_THAT(refusal(path("r.eym"), {"--reference", option, value}, 2),
                    testing::HasSubstr("what the camera itself sees"))
            << option << " " << value;
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "3000", "--seed", "6", "-o", path("r.ply")}));
    EXPECT_THAT(
        refusal(path("r.eym"), {"--reference"}, 2),
        testing::AllOf(testing::HasSubstr("is not what " + path("r.eym") + " was imported from"),
                       testing::Not(testing::HasSubstr("nor is"))))
        << "one file, which lies beside its import";
    std::filesystem::remove(path("r.ply"));
    EXPECT_THAT(refusal(path("r.eym"), {"--reference"}, 2), testing::HasSubstr(path("r.ply")));
}

/// An eye beside the camera is drawn behind a coordinator.
TEST_F(Bench, ARunSaysWhoDrewIt) {
    ASSERT_TRUE(succeeded({"bench", dem(), "--eye", "left", "--tau", "4", "--size", "160x90",
                           "--frames", "2", "--repeats", "1", "-o", path("eye")}));
    EXPECT_EQ(number(test::list(summaryOf(path("eye")), "runs").at(0), "renderers"), 1);
}

TEST_F(Bench, RefusesFlightsThatAreNone) {
    const auto refusal = [&](const std::string& keys) {
        const test::Outcome outcome =
            eyrie({"bench", dem(), "--flight", writeFlight("bad.json", keys), "-o", path("none")});
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
        EXPECT_FALSE(std::filesystem::exists(path("none")));
        return outcome.errors;
    };
    EXPECT_THAT(refusal(""), testing::HasSubstr("bad.json: the flight has no keys"));
    EXPECT_THAT(refusal(key(2, 900) + "," + key(1, 900)),
                testing::HasSubstr("keys[1].seconds is 1, not after the 2"));
    EXPECT_THAT(refusal(R"({"seconds":"NaN","camera":{"eye":[0,0,0],"target":[1,0,0]}})"),
                testing::HasSubstr("keys[0].seconds is not a finite number"));
}

TEST_F(Bench, AFlightThatNeverSeesTheSceneIsRefused) {
    const std::string away =
        writeFlight("away.json", R"({"seconds":0,"camera":{"eye":[0,0,9],"target":[-10,0,9]}})");
    const test::Outcome outcome = eyrie({"bench", dem(), "--flight", away, "--size", "160x90",
                                         "--frames", "2", "-o", path("none")});
    EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
    EXPECT_THAT(outcome.errors, testing::HasSubstr("away.json: no frame of the flight shows"));
    EXPECT_FALSE(std::filesystem::exists(path("none")));
}

/// Of which all is nearer to the eye than anything that is drawn.
TEST_F(Bench, SaysThatASceneIsTooSmallToBeSeen) {
    ASSERT_TRUE(succeeded({"synth", "mesh", "--size", "2000", "--seed", "3", "-o", path("s.ply")}));
    folder_->write("small.json", R"({"objects":[{"mesh":"s.ply","transform":{"scale":0.0001}}]})");
    const test::TemporaryFolder cache;
    const test::Outcome played =
        eyrie({"bench", path("small.json"), "--tau", "1", "--size", "160x90", "--frames", "4",
               "--repeats", "1", "--cache", cache.path("imports"), "-o", path("small")});
    EXPECT_EQ(played.exit, (test::Exit{2, 0})) << played.errors;
    EXPECT_THAT(played.errors, testing::ContainsRegex("no frame of the flight shows anything.*"
                                                      "the scene is 0.*scale it up"));
    EXPECT_FALSE(std::filesystem::exists(path("small")));
}

TEST_F(Bench, AConfigurationIsToldOfOnceAndKnownByWhatItSays) {
    const auto write = [&](const std::string& name, const std::string& rest) {
        return folder_->write(name, R"(#Equalizer 1.2 ascii
server { config {
    appNode { pipe { window { channel { name "all" } } } }
    layout { view { } }
    canvas { layout 0 wall { bottom_left [ -1 -1 -1 ] bottom_right [ 1 -1 -1 ]
                             top_left [ -1 1 -1 ] } segment { channel "all" } }
    canvas { layout 0 }
    )" + rest + "} }\n");
    };
    const std::string flight = writeFlight("still.json", key(0, 2500));
    const auto hashOf = [&](const std::string& config, std::string& told) {
        const test::Outcome outcome =
            eyrie({"bench", dem(), "--flight", flight, "--config", config, "--tau", "4,8", "--size",
                   "160x90", "--frames", "2", "--repeats", "1", "-o", path("configured")});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        told = outcome.errors;
        return test::at(summaryOf(path("configured")), "bench.configurationHash").string_value();
    };
    std::string told;
    const std::string plain = hashOf(write("a.eqc", ""), told);
    EXPECT_EQ(hashOf(write("b.eqc", "# the same\n"), told), plain);
    EXPECT_NE(hashOf(write("a.eqc", "latency 2\n"), told), plain);
    const std::string warning = "warning: ";
    const auto first = told.find(warning);
    ASSERT_NE(first, std::string::npos) << told;
    EXPECT_EQ(told.find(warning, first + 1), std::string::npos) << told;
}

TEST_F(Bench, AStillCameraIsAFlightAndEmptyFramesAreCounted) {
    const std::string out = R"({"seconds":9,"camera":{"eye":[503840,5194000,2500],)"
                            R"("target":[503840,5190000,2500]}})";
    const std::string still = writeFlight("still.json", key(0, 2500));
    const std::string half = writeFlight("half.json", key(0, 2500) + "," + out);
    const auto runOf = [&](const std::string& flight, const char* name) {
        const test::Outcome outcome =
            eyrie({"bench", dem(), "--flight", flight, "--tau", "4", "--size", "160x90", "--frames",
                   "2", "--repeats", "1", "-o", path(name)});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
        return std::pair(test::list(summaryOf(path(name)), "runs").at(0), outcome.output);
    };
    EXPECT_EQ(number(runOf(still, "still").first, "framesEmpty"), 0);
    const auto [run, said] = runOf(half, "half");
    EXPECT_EQ(number(run, "framesEmpty"), 2);
    EXPECT_THAT(said, testing::HasSubstr("2 of 4 frames show nothing of the scene"));
}

TEST_F(Bench, ErrorsAndTrianglesOfTheWorstFlightRepeatExactly) {
    // Which of what is hidden is left out goes by time.
    const auto runsOf = [&](const char* name) {
        EXPECT_TRUE(succeeded({"bench", dem(), "--flight", "worst", "--tau", "2", "--size",
                               "160x90", "--frames", "24", "--repeats", "1", "--renderers", "0,1",
                               "--occlusion", "off", "-o", path(name)}));
        return test::list(summaryOf(path(name)), "runs");
    };
    const auto first = runsOf("first");
    const auto second = runsOf("second");
    ASSERT_EQ(first.size(), 2U);
    const test::Outcome compared =
        eyrie({"bench", "--compare", path("first"), path("second"), "-o", path("compared")});
    EXPECT_EQ(compared.exit, (test::Exit{0, 0})) << compared.errors;
    EXPECT_THAT(compared.output, testing::HasSubstr("2 px, 1 renderer"));
    EXPECT_EQ(test::namesIn(path("compared")),
              (std::set<std::string>{"comparison.json", "index.html"}));
    for (std::size_t i = 0; i < first.size(); ++i)
        for (const char* figure : {"tauAchievedMax", "trianglesMean", "framesBeyondTau"})
            EXPECT_EQ(number(first[i], figure), number(second[i], figure)) << figure;
    EXPECT_EQ(number(first[0], "trianglesMean"), number(first[1], "trianglesMean"));
    EXPECT_EQ(number(first[1], "renderers"), 1);
    EXPECT_GT(number(first[1], "bytesLoadedFirstPass"), 0) << "each run loads for itself";
}

/// Which of what is hidden is left out goes by time.
TEST_F(Bench, MeasuredErrorsRepeatToTheByte) {
    ASSERT_TRUE(
        succeeded({"synth", "terrain", "--size", "257", "--seed", "4", "-o", path("same.tif")}));
    ASSERT_TRUE(succeeded({"import", "terrain", path("same.tif"), "-o", path("same.eyt")}));
    ASSERT_TRUE(
        succeeded({"synth", "mesh", "--size", "30000", "--seed", "4", "-o", path("same.ply")}));
    ASSERT_TRUE(succeeded({"import", "mesh", path("same.ply"), "-o", path("same.eym")}));
    for (const char* data : {"same.eyt", "same.eym"}) {
        SCOPED_TRACE(data);
        const auto errorsOf = [&](const char* name) {
            EXPECT_TRUE(
                succeeded({"bench", path(data), "--flight", "worst", "--tau", "8", "--size",
                           "160x90", "--frames", "12", "--repeats", "1", "--reference",
                           "--reference-frames", "12", "--occlusion", "off", "-o", path(name)}));
            const auto errors = test::readFile(path(name) + "/errors.csv");
            EXPECT_TRUE(errors.ok()) << errors.status();
            return errors.value_or("");
        };
        const std::string first = errorsOf("same-first");
        EXPECT_EQ(std::ranges::count(first, '\n'), 1 + 12);
        EXPECT_EQ(errorsOf("same-second"), first);
    }
}

TEST_F(Bench, RefusesWhatItCannotMeasure) {
    const auto refusal = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"bench", dem(), "-o", path("none")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << outcome.errors;
        return outcome.errors;
    };
    EXPECT_THAT(refusal({"--tau", "1,0"}), testing::HasSubstr("--tau has 0"));
    EXPECT_THAT(refusal({"--tau", "nan"}), testing::HasSubstr("--tau"));
    EXPECT_THAT(refusal({"--frames", "0"}), testing::HasSubstr("--frames"));
    EXPECT_THAT(refusal({"--flight", "missing.json"}), testing::HasSubstr("missing.json"));
    EXPECT_THAT(refusal({"--renderers", "1,65"}), testing::HasSubstr("--renderers"));
    EXPECT_THAT(refusal({"--compare", "a", "b"}), testing::HasSubstr("--compare"));
    EXPECT_THAT(refusal({"--force"}), testing::HasSubstr("--force"));
    const auto said = [](const std::vector<std::string>& arguments) {
        const test::Outcome outcome = eyrie(arguments);
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << outcome.output;
        return outcome.errors;
    };
    EXPECT_THAT(said({"bench"}), testing::HasSubstr("bench needs a scene"));
    EXPECT_THAT(said({"bench", dem()}), testing::HasSubstr("-o FOLDER"));
    EXPECT_THAT(said({"bench", "--compare", path("no-such"), path("no-such")}),
                testing::HasSubstr("no-such"));
    EXPECT_THAT(said({"bench", "--compare", path("")}), testing::HasSubstr("--compare"));
    EXPECT_THAT(said({"bench", "--compare", path("a"), path("b"), "--tau", "5", "--size", "3x3",
                      "--reference", "--log-format", "text", "-o", path("c")}),
                testing::HasSubstr("--compare measures nothing: --tau, --size, --reference\n"));
}

TEST_F(Bench, SaysThatACompoundIsOfSeveralRenderers) {
    const auto errors = [&](const std::string& renderers) {
        return eyrie({"bench", dem(), "--compound", "DB", "--renderers", renderers, "--size",
                      "64x36", "--frames", "2", "--repeats", "1", "--tau", "8", "-o",
                      path("compound")})
            .errors;
    };
    EXPECT_THAT(errors("0,1"), testing::HasSubstr("--compound DB has no effect"));
    EXPECT_THAT(errors("1,2"), testing::Not(testing::HasSubstr("has no effect")));
}

}  // namespace
}  // namespace eyrie
