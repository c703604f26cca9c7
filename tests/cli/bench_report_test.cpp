// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "cli/bench/page.h"
#include "cli/bench/report.h"
#include "cli/bench/run_summary.h"
#include "cli/tune_mesh.h"
#include "tests/support/json.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli::bench {
namespace {

using test::number;
using test::parseJson;

PlayedFrame frame(int pass, double milliseconds, double tauAchieved = 0.5) {
    PlayedFrame frame{pass, 0.25, milliseconds, {}, milliseconds};
    frame.statistics.tauAskedPixels = 1;
    frame.statistics.tauAchievedPixels = tauAchieved;
    frame.statistics.triangles = 80;
    frame.statistics.points = 20;
    frame.statistics.bytesLoaded = 7;
    return frame;
}

/// Of one pass that loads and one that counts, at tau 1.
std::vector<BenchRun> oneRun() {
    const Played played{{frame(0, 500), frame(1, 20), frame(1, 10), frame(1, 40)}, 1 << 20, {}};
    return {{"1 px", 1, 0, "", played}};
}

Report report(std::string scene = "dem.eyt") {
    return {{std::move(scene), "orbit", 1280, 720, 3, 1, "eyrie bench dem.eyt -o report"},
            oneRun()};
}

TEST(Quantile, IsTheNearestRank) {
    std::vector<double> values(100);
    std::iota(values.rbegin(), values.rend(), 1);  // 100 down to 1
    EXPECT_EQ(quantile(values, 0.5), 50);
    EXPECT_EQ(quantile(values, 0.95), 95);
    EXPECT_EQ(quantile(values, 0.99), 99);
    EXPECT_EQ(quantile(values, 1), 100);
    EXPECT_EQ(quantile({7}, 0.5), 7);
}

TEST(RunSummary, TheFirstPassCountsForItselfOnly) {
    Played played = oneRun()[0].played;
    const RunSummary summary = summarize(played);
    EXPECT_EQ(summary.frame.p50, 20);
    EXPECT_EQ(summary.frame.max, 40);
    EXPECT_EQ(summary.fpsMedian, 50);
    EXPECT_EQ(summary.firstPass.max, 500);
    EXPECT_EQ(summary.bytesLoaded, 28u);
    played.frames[0].statistics.triangles = 9000;
    played.frames[0].statistics.points = 900;
    EXPECT_DOUBLE_EQ(summarize(played).trianglesMean, 80);
    EXPECT_DOUBLE_EQ(summarize(played).pointsMean, 20);
}

/// Two in flight that follow each other at once, then wait: 100 frames of two passes in 1.5 s each.
TEST(RunSummary, TheMedianOfFramesInFlightIsNoneOfTheGapsInABurst) {
    Played played;
    for (int pass = 0; pass < 3; ++pass)
        for (int i = 0; i < 50; ++i) {
            played.frames.push_back(frame(pass, 29));
            played.frames.push_back(frame(pass, 1));
        }
    EXPECT_EQ(summarize(played).frame.p50, 1);
    played.framesInFlight = 2;
    const RunSummary summary = summarize(played);
    EXPECT_EQ(summary.frame.p50, 15);
    EXPECT_EQ(summary.frame.p95, 29);
    EXPECT_EQ(summary.firstPass.p50, 15);
    ASSERT_EQ(summary.passes.size(), 2U);
    EXPECT_EQ(summary.passes[1].frame.p50, 15);
    EXPECT_DOUBLE_EQ(summary.fpsMedian, 1000.0 / 15);
}

TEST(RunSummary, TheErrorIsThatOfTheWorstFrame) {
    Played played{{frame(0, 1), frame(1, 1, 0.9), frame(1, 1, 1.5)}, 0, {}};
    EXPECT_EQ(summarize(played).tauAchievedMax, 1.5);
    EXPECT_EQ(summarize(played).framesBeyond, 1u);
}

/// The second frame ends the first second.
TEST(RunSummary, FramesAreInTimeUpToAFifthLongerThanAskedForOnceASecondHasPassed) {
    Played played{
        {frame(0, 900), frame(0, 150), frame(0, 39), frame(1, 39.6), frame(1, 41), frame(1, 20)},
        0,
        {}};
    EXPECT_TRUE(std::isnan(summarize(played).withinBudget));
    for (PlayedFrame& one : played.frames)
        one.statistics.budget = fabric::BudgetUse{33, 30, 0.5, 100, 1};
    EXPECT_EQ(summarize(played).withinBudget, 0.75);
    EXPECT_EQ(summarize(played).tauAchieved.p95, 0.5);
}

TEST(BenchReport, ARunAtAFrameTimeSaysHowItWasHeld) {
    Report held = report();
    held.runs[0].budgetMilliseconds = 33;
    for (PlayedFrame& one : held.runs[0].played.frames) {
        one.milliseconds += 1000;
        one.statistics.budget = fabric::BudgetUse{33, 30, 0.5, 100, 1};
    }
    const test::JsonValue run = test::list(parseJson(summaryJson(held)), "runs").at(0);
    EXPECT_EQ(number(run, "budgetMs"), 33);
    EXPECT_EQ(number(run, "withinBudget"), 0);
    EXPECT_EQ(number(run, "tauAchieved.p95"), 0.5);
    EXPECT_THAT(table(held.runs),
                testing::HasSubstr("33 ms to hold: 0.0 % of frames within 39.6 ms"));
    EXPECT_THAT(framesCsv(held.runs), testing::HasSubstr(",33,30.000,0.5,20.000,1.0000\n"));
}

TEST(BenchReport, FramesDrawnSmallerSaySoEverywhere) {
    Report held = report();
    held.runs[0].budgetMilliseconds = 33;
    const Report whole = held;
    held.runs[0].played.frames[1].stretch = 1.5;
    held.runs[0].played.frames[2].stretch = 4;
    const test::JsonValue run = test::list(parseJson(summaryJson(held)), "runs").at(0);
    EXPECT_EQ(number(run, "framesSmaller"), 2);
    EXPECT_EQ(number(run, "stretchMax"), 4);
    EXPECT_THAT(framesCsv(held.runs), testing::HasSubstr(",4.0000\n"));
    EXPECT_THAT(table(held.runs),
                testing::HasSubstr("; 2 of 4 frames were drawn smaller, their pixels stretched up "
                                   "to 4.00 times\n"));
    EXPECT_THAT(table(whole.runs), testing::Not(testing::HasSubstr("smaller")));
}

TEST(BenchReport, ARunTooShortToTellHowItsFrameTimeWasHeldSaysSo) {
    Report held = report();
    held.runs[0].budgetMilliseconds = 33;
    EXPECT_THAT(table(held.runs), testing::HasSubstr("33 ms to hold: no frame after the first"));
}

TEST(BenchReport, FramesThatPromiseMoreThanWasAskedSaySoEverywhere) {
    Report broken = report();
    broken.runs[0].played.frames[2] = frame(1, 10, 1.5);
    const std::string csv = framesCsv(broken.runs);
    EXPECT_THAT(csv, testing::HasSubstr(",tauAchieved,beyondTau,complete,"));
    EXPECT_THAT(csv, testing::HasSubstr(",0.5,0,1,"));
    EXPECT_THAT(csv, testing::HasSubstr(",1.5,1,1,"));
    const test::JsonValue run = test::list(parseJson(summaryJson(broken)), "runs").at(0);
    EXPECT_EQ(number(run, "framesBeyondTau"), 1);
    EXPECT_THAT(table(broken.runs),
                testing::HasSubstr("1 px, one process: 1 of 4 frames promise more than was asked"));
    EXPECT_THAT(table(oneRun()), testing::Not(testing::HasSubstr("promise more")));
    EXPECT_THAT(reportPage(broken), testing::HasSubstr("[0,1,0.250,10.00,1]"));
}

TEST(RunSummary, StagesAreThoseOfTheFramesThatWereMeasured) {
    Played played = oneRun()[0].played;
    for (const double fill : {8.0, 30.0, 9.0})
        played.stages.push_back({.draw = 5 + fill, .vertices = 5, .fill = fill});
    EXPECT_EQ(summarize(played).stages.vertices, 5);
    EXPECT_EQ(summarize(played).stages.fill, 9);
    EXPECT_EQ(fabric::limitingStage(summarize(played).stages), "fill");
    for (PlayedFrame& one : played.frames) one.statistics.milliseconds.draw = 14;
    const fabric::StageMilliseconds means = summarize(played).means;
    EXPECT_DOUBLE_EQ(means.total, (20. + 10 + 40) / 3);
    EXPECT_DOUBLE_EQ(means.vertices, 14 * 15. / 62);
    EXPECT_DOUBLE_EQ(means.vertices + means.fill, 14);
}

TEST(MeshTuning, KeepsTheFastestAndOfEqualOnesTheSmallest) {
    std::vector<TriedLeaf> tried(3);
    const double milliseconds[] = {10.2, 12, 10};
    const std::uint64_t bytes[] = {100, 80, 120};
    for (std::size_t i = 0; i < 3; ++i) {
        tried[i].leafTriangles = kTriedLeafTriangles[i];
        tried[i].medianMs = milliseconds[i];
        tried[i].report.bytes = bytes[i];
    }
    EXPECT_EQ(bestOf(tried), 0U);  // 2 % slower, and smaller
    tried[0].medianMs = 10.5;
    EXPECT_EQ(bestOf(tried), 2U);
    EXPECT_THAT(table(MeshTuning{tried, 2}), testing::HasSubstr("16384      10.00"));
}

TEST(BenchReport, TheSummaryHasTheFieldsOfTheContract) {
    const auto summary = parseJson(summaryJson(report()));
    EXPECT_EQ(test::at(summary, "machine.eyrie").kind_case(), test::JsonValue::kStringValue);
    const auto runs = test::list(summary, "runs");
    ASSERT_EQ(runs.size(), 1u);
    const test::JsonValue& run = runs[0];
    EXPECT_EQ(number(run, "tau"), 1);
    EXPECT_EQ(number(run, "fpsMedian"), 50);
    EXPECT_EQ(number(run, "frameMs.p50"), 20);
    EXPECT_EQ(number(run, "frameMs.p95"), 40);
    EXPECT_EQ(number(run, "frameMs.p99"), 40);
    EXPECT_EQ(number(run, "trianglesMean"), 80);
    EXPECT_EQ(number(run, "pointsMean"), 20);
    EXPECT_EQ(number(run, "bytesLoaded"), 28);
    EXPECT_EQ(number(run, "peakResidentBytes"), 1 << 20);
    EXPECT_EQ(number(run, "tauAchievedMax"), 0.5);
    EXPECT_EQ(number(run, "tauAchieved.p95"), 0.5);
    EXPECT_EQ(number(test::list(run, "passes").at(0), "triangles"), 80);
}

/// What a reference found: values that are made up, and say so.
Report madeUpReport() {
    Report made = report("made-up values");
    MeasuredErrors measured;
    for (const double share : {0.3, 0.9, 0.6})
        measured.frames.push_back({.seconds = 4 * share,
                                   .promisedPixels = 1,
                                   .p50Pixels = 0.1 * share,
                                   .p99Pixels = 0.5 * share,
                                   .maxPixels = share,
                                   .compared = 1000,
                                   .holes = 1,
                                   .falseHits = 0,
                                   .misplaced = 2,
                                   .silhouettePixels = 0.8 * share,
                                   .psnrDb = 40 - share,
                                   .ssim = 1 - 0.01 * share,
                                   .flip = 0.02 * share,
                                   .triangles = static_cast<std::size_t>(1000 * share)});
    measured.worst.push_back({measured.frames[1], "made-up picture", "made-up heat map"});
    measured.frames[2].stretch = 2;
    made.runs[0].measured = measured;
    made.uniform = {{6400, 19200, 0.1125, 0.5}, {1600, 4800, 0.225, 1}, {400, 1200, 0.9, 4}};
    return made;
}

TEST(BenchReport, MeasuredErrorsAreThoseOfTheWorstFrames) {
    const auto summary = parseJson(summaryJson(madeUpReport()));
    const test::JsonValue run = test::list(summary, "runs").at(0);
    EXPECT_DOUBLE_EQ(number(run, "errorPx.p50"), 0.06);
    EXPECT_DOUBLE_EQ(number(run, "errorPx.p99"), 0.45);
    EXPECT_DOUBLE_EQ(number(run, "errorPx.max"), 0.9);
    EXPECT_DOUBLE_EQ(number(run, "errorPx.rounded"), 2. / 256);
    EXPECT_EQ(number(run, "holes"), 3);
    EXPECT_EQ(number(run, "misplaced"), 6);
    EXPECT_DOUBLE_EQ(number(run, "silhouettePx"), 0.72);
    EXPECT_DOUBLE_EQ(number(run, "psnrDb"), 39.1);
    EXPECT_DOUBLE_EQ(number(run, "ssim"), 0.991);
    EXPECT_DOUBLE_EQ(number(run, "flip"), 0.018);
    EXPECT_EQ(number(run, "framesMeasured"), 3);
    EXPECT_FALSE(test::at(run, "measuredWithinPromise").bool_value()) << "it has holes";
    EXPECT_NEAR(number(run, "trianglesMeasured"), 600, 1e-9) << "not those of all played frames";
    EXPECT_NEAR(number(run, "efficiency"), 800. / 600, 1e-9) << "800: between 1600 and 400";
    EXPECT_NEAR(number(run, "efficiencyWhole"), 2400. / 600, 1e-9) << "with those out of view";
    EXPECT_EQ(test::list(summary, "uniform").size(), 3U);
}

TEST(BenchReport, FramesThatShowNothingAreNotMeasured) {
    Report made = madeUpReport();
    const auto p50 = summarize(*made.runs[0].measured).p50Pixels;
    for (int i = 0; i < 5; ++i)
        made.runs[0].measured->frames.insert(
            made.runs[0].measured->frames.begin(),
            FrameError{.seconds = 0.1 * i, .promisedPixels = 3, .triangles = 200});
    EXPECT_EQ(summarize(*made.runs[0].measured).p50Pixels, p50);
    const auto run = test::list(parseJson(summaryJson(made)), "runs").at(0);
    EXPECT_EQ(number(run, "framesMeasured"), 3);
    EXPECT_EQ(number(run, "framesJudged"), 8);
    EXPECT_EQ(number(run, "errorPx.promised"), 1);
    EXPECT_NEAR(number(run, "trianglesMeasured"), 600, 1e-9) << "drawn in view, and not seen";
    EXPECT_NEAR(number(run, "efficiency"), 800. / 600, 1e-9);
    EXPECT_THAT(reportPage(made), testing::Not(testing::HasSubstr("\"seconds\": 0.1,")));
}

TEST(BenchReport, AFrameFartherOffThanItPromisedBreaksThePromise) {
    Report made = madeUpReport();
    for (FrameError& frame : made.runs[0].measured->frames) frame.holes = frame.misplaced = 0;
    made.runs[0].measured->worst[0].error = made.runs[0].measured->frames[1];
    const Report kept = made;
    made.runs[0].measured->frames[2].promisedPixels = 0.5;
    const auto run = test::list(parseJson(summaryJson(made)), "runs").at(0);
    EXPECT_FALSE(test::at(run, "measuredWithinPromise").bool_value());
    EXPECT_THAT(reportPage(made), testing::HasSubstr("\"kept\": false"));
    EXPECT_THAT(reportPage(kept), testing::Not(testing::HasSubstr("\"kept\": false")));
}

TEST(BenchReport, WhatWasNotMeasuredIsNotInTheSummary) {
    const auto summary = parseJson(summaryJson(report()));
    const auto run = test::list(summary, "runs").at(0);
    for (const char* field : {"errorPx", "holes", "measuredWithinPromise", "efficiency"})
        EXPECT_EQ(test::at(run, field).kind_case(), test::JsonValue::KIND_NOT_SET) << field;
    EXPECT_EQ(test::at(summary, "uniform").kind_case(), test::JsonValue::KIND_NOT_SET);
}

TEST(Efficiency, IsNotGuessedBeyondWhatWasMeasured) {
    const std::vector<UniformLevel> levels = madeUpReport().uniform;
    EXPECT_NEAR(efficiency(levels, 0.1125, 100).value(), 64, 1e-9);
    EXPECT_NEAR(efficiency(levels, 0.9, 100).value(), 4, 1e-9);
    EXPECT_EQ(efficiency(levels, 0.1, 100), std::nullopt);
    EXPECT_EQ(efficiency(levels, 1, 100), std::nullopt);
    EXPECT_EQ(efficiency(levels, 0.3, 0), std::nullopt);
    EXPECT_EQ(efficiency({levels[0]}, 0.1125, 100), std::nullopt);
}

TEST(Efficiency, SaysWhyItIsNone) {
    const std::vector<UniformLevel> levels = madeUpReport().uniform;
    EXPECT_EQ(whyNoEfficiency(levels, 0.1125, 100), "");
    EXPECT_EQ(whyNoEfficiency(levels, 0.1, 100), "finer than the finest uniform level");
    EXPECT_EQ(whyNoEfficiency(levels, 1, 100), "coarser than the coarsest uniform level");
    EXPECT_EQ(whyNoEfficiency(levels, 0.3, 0), "nothing was drawn");
    EXPECT_EQ(whyNoEfficiency({levels[0]}, 0.1, 100), "finer than the finest uniform level");
    EXPECT_EQ(whyNoEfficiency({}, 0.1, 100), "no uniform level has an error");
    Report made = madeUpReport();
    for (FrameError& frame : made.runs[0].measured->frames) frame.p99Pixels = 0.05;
    const auto run = test::list(parseJson(summaryJson(made)), "runs").at(0);
    EXPECT_EQ(test::at(run, "efficiencyMissing").string_value(),
              "finer than the finest uniform level");
    EXPECT_EQ(test::at(run, "efficiency").kind_case(), test::JsonValue::KIND_NOT_SET);
}

TEST(BenchReport, WorstFramesAreInThePage) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\x80"), "//6A");
    const std::string page = reportPage(madeUpReport());
    EXPECT_THAT(page, testing::HasSubstr(base64("made-up picture")));
    EXPECT_THAT(page, testing::HasSubstr(base64("made-up heat map")));
}

TEST(BenchReport, EachPassHasItsOwnFigures) {
    Played played = oneRun()[0].played;
    for (const double milliseconds : {3.0, 1.0, 2.0})
        played.frames.push_back(frame(2, milliseconds));
    played.frames.back().statistics.tauAchievedPixels = 0.75;
    played.frames.back().statistics.triangles = 110;
    const std::vector<PassSummary> passes = summarize(played).passes;
    ASSERT_EQ(passes.size(), 2U);
    EXPECT_EQ(passes[0].frame.p50, 20);
    EXPECT_EQ(passes[1].frame.p50, 2);
    EXPECT_EQ(passes[0].tauP95, 0.5);
    EXPECT_EQ(passes[1].tauP95, 0.75);
    EXPECT_DOUBLE_EQ(passes[0].triangles, 80);
    EXPECT_DOUBLE_EQ(passes[1].triangles, 90);
    EXPECT_DOUBLE_EQ(passes[1].points, 20);
}

TEST(BenchReport, ABoundThatIsNoneIsInfinityInJson) {
    Report endless = report();
    endless.runs[0].played.frames[1] = frame(1, 20, std::numeric_limits<double>::infinity());
    const auto summary = parseJson(summaryJson(endless));
    EXPECT_EQ(test::at(test::list(summary, "runs").at(0), "tauAchievedMax").string_value(),
              "Infinity");
}

TEST(BenchReport, TheTableOfFramesHasALineAFrame) {
    const std::string csv = framesCsv(oneRun());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    EXPECT_THAT(csv, testing::HasSubstr("\n1 px,1,0,0,0.25,500.000,"));
}

TEST(BenchReport, NamesFrameTimeAndLatencyApart) {
    std::vector<BenchRun> runs = oneRun();
    runs[0].played.framesInFlight = 2;
    for (PlayedFrame& one : runs[0].played.frames) one.latencyMilliseconds = one.milliseconds + 7;
    const auto run = test::list(parseJson(summaryJson(Report{report().facts, runs})), "runs").at(0);
    EXPECT_EQ(number(run, "frameMs.p50"), 15) << "of 20, 10 and 40, two in turn";
    EXPECT_DOUBLE_EQ(number(run, "fpsMedian"), 1000.0 / 15);
    EXPECT_EQ(number(run, "latencyMs.p50"), 27);
    EXPECT_EQ(number(run, "framesInFlight"), 2);
    EXPECT_EQ(number(run, "stagesMs.total"), 27) << "stages are of one frame's life";
    EXPECT_THAT(table(runs),
                testing::ContainsRegex("in flight  latency ms.*\n.* 15.0 .* 2 +27.0 "));
    EXPECT_THAT(framesCsv(runs), testing::HasSubstr(",latency,stretch\n"));
    EXPECT_THAT(framesCsv(runs), testing::HasSubstr(",,,27.000,1.0000\n"));
}

TEST(BenchReport, AFilesNameCannotEndThePagesScript) {
    const std::string page = reportPage(report("</script><b>.eyt"));
    EXPECT_THAT(page, testing::HasSubstr("\\u003c/script>\\u003cb>.eyt"));
    EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
}

TEST(BenchReport, HasNoErrorsOfAnEarlierReportBesideIt) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("errors.csv")) << "of another report";
    ASSERT_TRUE(writeReport(report(), folder.path("")).ok());
    EXPECT_FALSE(std::filesystem::exists(folder.path("errors.csv")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("frames.csv")));
}

/// The page goes to a device that is full.
TEST(BenchReport, WithoutRoomForAllOfItLeavesTheEarlierReport) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(writeReport(report("earlier.eyt"), folder.path("")).ok());
    const auto size = std::filesystem::file_size(folder.path("frames.csv"));
    std::filesystem::remove(folder.path("index.html"));
    std::filesystem::create_symlink("/dev/full", folder.path("index.html"));
    Report later = report("later.eyt");
    later.runs.push_back(later.runs[0]);
    EXPECT_TRUE(absl::IsResourceExhausted(writeReport(later, folder.path(""))));
    EXPECT_EQ(std::filesystem::file_size(folder.path("frames.csv")), size);
    std::ifstream summary(folder.path("summary.json"));
    EXPECT_THAT(std::string(std::istreambuf_iterator<char>(summary), {}),
                testing::HasSubstr("earlier.eyt"));
}

TEST(BenchReport, DoesNotTakeThePlaceOfOthersFiles) {
    for (const char* name : {"errors.csv", "frames.csv", "index.html", "summary.json"}) {
        const test::TemporaryFolder folder;
        folder.write(name, "{}");
        const absl::Status refused = checkReportFolder(folder.path(""));
        EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
        EXPECT_THAT(refused.ToString(), testing::HasSubstr(name));
        std::filesystem::remove(folder.path(name));
        ASSERT_TRUE(writeReport(report(), folder.path("")).ok());
        folder.write(name == std::string("summary.json") ? "errors.csv" : name, "a report's");
        EXPECT_TRUE(checkReportFolder(folder.path("")).ok()) << "an earlier report's";
    }
}

TEST(BenchReport, AFolderThatCannotTakeItIsRefusedBeforeAnythingIsMade) {
    const test::TemporaryFolder folder;
    EXPECT_TRUE(checkReportFolder(folder.path("a/b")).ok());
    EXPECT_FALSE(std::filesystem::exists(folder.path("a")));
    EXPECT_TRUE(
        absl::IsInvalidArgument(checkReportFolder(folder.path("a/" + std::string(300, 'b')))));
    EXPECT_FALSE(std::filesystem::exists(folder.path("a")));
    std::filesystem::create_symlink("loop", folder.path("loop"));
    EXPECT_FALSE(checkReportFolder(folder.path("loop")).ok());
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path("loop"))) << "which it did not make";
    std::ofstream(folder.path("file")) << "no folder";
    EXPECT_TRUE(absl::IsInvalidArgument(checkReportFolder(folder.path("file"))));
    EXPECT_TRUE(absl::IsInvalidArgument(checkReportFolder(folder.path("file/b"))));
    std::filesystem::create_directories(folder.path("c/summary.json"));
    EXPECT_TRUE(absl::IsInvalidArgument(checkReportFolder(folder.path("c"))));
}

TEST(BenchReport, ThePageNeedsNothingElse) {
    const std::string page = reportPage(report());
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("src=")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("<link")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("url(")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("REPORT_DATA")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("EYRIE_")));
}

}  // namespace
}  // namespace eyrie::cli::bench
