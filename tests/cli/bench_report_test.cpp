// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "cli/bench/report.h"
#include "cli/bench/run_summary.h"
#include "cli/tune_mesh.h"
#include "tests/support/json.h"

namespace eyrie::cli::bench {
namespace {

using test::number;
using test::parseJson;

PlayedFrame frame(int pass, double milliseconds, double tauAchieved = 0.5) {
    PlayedFrame frame{pass, 0.25, milliseconds, {}};
    frame.statistics.tauAskedPixels = 1;
    frame.statistics.tauAchievedPixels = tauAchieved;
    frame.statistics.triangles = 100;
    frame.statistics.bytesLoaded = 7;
    return frame;
}

/// Of one pass that loads and one that counts, at tau 1.
std::vector<BenchRun> oneRun() {
    BenchRun run{1, {{frame(0, 500), frame(1, 20), frame(1, 10), frame(1, 40)}, 1 << 20, {}}};
    return {run};
}

BenchFacts facts(std::string scene = "dem.eyt") {
    return {std::move(scene), "orbit", 1280, 720, 3, 1, 0, "2D"};
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
    const RunSummary summary = summarize(oneRun()[0].played);
    EXPECT_EQ(summary.frame.p50, 20);
    EXPECT_EQ(summary.frame.max, 40);
    EXPECT_EQ(summary.fpsMedian, 50);
    EXPECT_EQ(summary.firstPass.max, 500);
    EXPECT_EQ(summary.bytesLoaded, 28u);
    EXPECT_DOUBLE_EQ(summary.trianglesMean, 100);
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
    auto runs = oneRun();
    runs[0].budgetMilliseconds = 33;
    for (PlayedFrame& one : runs[0].played.frames) {
        one.milliseconds += 1000;
        one.statistics.budget = fabric::BudgetUse{33, 30, 0.5, 100, 1};
    }
    const test::JsonValue run = test::list(parseJson(summaryJson(facts(), runs)), "runs").at(0);
    EXPECT_EQ(number(run, "budgetMs"), 33);
    EXPECT_EQ(number(run, "withinBudget"), 0);
    EXPECT_EQ(number(run, "tauAchieved.p95"), 0.5);
    EXPECT_THAT(table(runs), testing::HasSubstr("33 ms to hold: 0.0 % of frames within 40 ms"));
    EXPECT_THAT(framesCsv(runs), testing::HasSubstr(",33,30.000,0.5\n"));
}

TEST(RunSummary, StagesAreThoseOfTheFramesThatWereMeasured) {
    Played played = oneRun()[0].played;
    for (const double fill : {8.0, 30.0, 9.0})
        played.stages.push_back({.draw = 5 + fill, .vertices = 5, .fill = fill});
    EXPECT_EQ(summarize(played).stages.vertices, 5);
    EXPECT_EQ(summarize(played).stages.fill, 9);
    EXPECT_EQ(fabric::limitingStage(summarize(played).stages), "fill");
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
    const auto summary = parseJson(summaryJson(facts(), oneRun()));
    EXPECT_EQ(test::at(summary, "machine.eyrie").kind_case(), test::JsonValue::kStringValue);
    const auto runs = test::list(summary, "runs");
    ASSERT_EQ(runs.size(), 1u);
    const test::JsonValue& run = runs[0];
    EXPECT_EQ(number(run, "tau"), 1);
    EXPECT_EQ(number(run, "fpsMedian"), 50);
    EXPECT_EQ(number(run, "frameMs.p50"), 20);
    EXPECT_EQ(number(run, "frameMs.p95"), 40);
    EXPECT_EQ(number(run, "frameMs.p99"), 40);
    EXPECT_EQ(number(run, "trianglesMean"), 100);
    EXPECT_EQ(number(run, "bytesLoaded"), 28);
    EXPECT_EQ(number(run, "peakResidentBytes"), 1 << 20);
    EXPECT_EQ(number(run, "tauAchievedMax"), 0.5);
}

TEST(BenchReport, ABoundThatIsNoneIsNullInJson) {
    auto runs = oneRun();
    runs[0].played.frames[1] = frame(1, 20, std::numeric_limits<double>::infinity());
    const auto summary = parseJson(summaryJson(facts(), runs));
    EXPECT_EQ(test::at(test::list(summary, "runs").at(0), "tauAchievedMax").kind_case(),
              test::JsonValue::kNullValue);
}

TEST(BenchReport, TheTableOfFramesHasALineAFrame) {
    const std::string csv = framesCsv(oneRun());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
    EXPECT_THAT(csv, testing::HasSubstr("1,0,0.25,500.000,"));
}

TEST(BenchReport, AFilesNameCannotEndThePagesScript) {
    const std::string page = reportPage(facts("</script><b>.eyt"), oneRun());
    EXPECT_THAT(page, testing::HasSubstr("<\\/script><b>.eyt"));
    EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
}

TEST(BenchReport, ThePageNeedsNothingElse) {
    const std::string page = reportPage(facts(), oneRun());
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("src=")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("<link")));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("REPORT_DATA")));
}

}  // namespace
}  // namespace eyrie::cli::bench
