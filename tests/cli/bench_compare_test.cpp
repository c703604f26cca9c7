// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>

#include <gmock/gmock.h>

#include "cli/bench/compare.h"
#include "cli/bench/compare_report.h"
#include "cli/bench/report.h"
#include "tests/support/json.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli::bench {
namespace {

using testing::HasSubstr;

/// Of `passes` passes whose frames take `milliseconds` more or less, at two errors.
Report reportTaking(double milliseconds, int passes = 5, std::string scene = "dem.eyt") {
    Report report{{std::move(scene), "orbit", 640, 360, 8, passes, "eyrie bench"}, {}};
    for (const double tau : {1.0, 4.0}) {
        BenchRun run{tau == 1 ? "1 px" : "4 px", tau, 0, "", {}};
        for (int pass = 0; pass <= passes; ++pass)
            for (int i = 0; i < 8; ++i) {
                PlayedFrame frame{pass, i * 0.1, milliseconds * (1 + 0.01 * pass + 0.1 * i), {}};
                frame.statistics.tauAskedPixels = tau;
                frame.statistics.tauAchievedPixels = 0.9 * tau;
                frame.statistics.triangles = 1000;
                frame.statistics.nodes = 3;
                run.played.frames.push_back(frame);
            }
        report.runs.push_back(run);
    }
    return report;
}

class CompareReports : public testing::Test {
protected:
    absl::StatusOr<WrittenReport> written(const Report& report, const char* name) const {
        const std::string path = folder_.write(name, summaryJson(report));
        return readReport(path);
    }
    absl::StatusOr<Comparison> compared(const Report& a, const Report& b,
                                        bool force = false) const {
        return compare(written(a, "a.json").value(), written(b, "b.json").value(), force);
    }
    std::string refusal(const std::string& summary) const {
        const auto report = readReport(folder_.write("damaged.json", summary));
        EXPECT_EQ(report.status().code(), absl::StatusCode::kInvalidArgument) << summary;
        return std::string(report.status().message());
    }

    const test::TemporaryFolder folder_;
};

Verdict verdictOf(const Comparison& comparison, const std::string& name) {
    for (const Figure& figure : comparison.runs.at(0).figures)
        if (figure.name == name)
            return figure.verdict;
    ADD_FAILURE() << name << " is not compared";
    return Verdict::Equal;
}

TEST_F(CompareReports, TheSameReportTwiceHasNothingBeyondNoise) {
    for (const int passes : {1, 3, 4, 5, 20}) {
        const auto same = compared(reportTaking(20, passes), reportTaking(20, passes));
        ASSERT_TRUE(same.ok()) << same.status();
        EXPECT_EQ(countBeyondNoise(*same), 0);
        EXPECT_THAT(table(*same), HasSubstr("nothing is beyond noise"));
        EXPECT_THAT(same->notes, testing::IsEmpty());
    }
}

TEST_F(CompareReports, SayWhenFramesWereInFlightInOneOnly) {
    Report inFlight = reportTaking(20);
    for (BenchRun& run : inFlight.runs) run.played.framesInFlight = 2;
    const auto mixed = compared(reportTaking(20), inFlight);
    ASSERT_TRUE(mixed.ok()) << mixed.status();
    ASSERT_FALSE(mixed->notes.empty());
    EXPECT_THAT(mixed->notes.front(), HasSubstr("b.json 2; the times of frames are not"));
    EXPECT_THAT(mixed->notes.front(), HasSubstr("a.json has 1 frames in flight"));
}

TEST_F(CompareReports, ATenthMoreIsBeyondPassesThatSpreadByATwentieth) {
    const auto slower = compared(reportTaking(20), reportTaking(22));
    ASSERT_TRUE(slower.ok()) << slower.status();
    ASSERT_EQ(slower->runs.size(), 2U);
    EXPECT_EQ(verdictOf(*slower, "frame, median"), Verdict::More);
    const Ratio& ratio = *slower->runs[0].figures[0].ratio;
    EXPECT_NEAR(ratio.estimate, 1.1, 1e-9);
    EXPECT_NEAR(ratio.low, 1.1 * 1.31 / 1.35, 1e-9);
    EXPECT_NEAR(ratio.high, 1.1 * 1.35 / 1.31, 1e-9);
    EXPECT_NEAR(ratio.confidence, 1 - 2. / 252, 1e-9);
    EXPECT_THAT(table(*slower), HasSubstr("slower"));
    EXPECT_EQ(verdictOf(compared(reportTaking(22), reportTaking(20)).value(), "frame, median"),
              Verdict::Less);
    EXPECT_EQ(verdictOf(compared(reportTaking(20), reportTaking(20.5)).value(), "frame, median"),
              Verdict::WithinNoise);
    EXPECT_EQ(
        verdictOf(compared(reportTaking(20, 3), reportTaking(40, 3)).value(), "frame, median"),
        Verdict::TooFewPasses);
}

TEST_F(CompareReports, ErrorsDifferByAnyDifferenceTrianglesByMoreThanOcclusionMakes) {
    Report other = reportTaking(20);
    for (PlayedFrame& frame : other.runs[0].played.frames) frame.statistics.triangles = 1004;
    other.runs[0].played.frames[3].statistics.tauAchievedPixels = 0.9000001;
    const auto little = compared(reportTaking(20), other);
    ASSERT_TRUE(little.ok());
    EXPECT_EQ(verdictOf(*little, "triangles, mean"), Verdict::WithinNoise);
    EXPECT_EQ(verdictOf(*little, "error promised"), Verdict::More);
    EXPECT_EQ(countBeyondNoise(*little), 1);
    for (PlayedFrame& frame : other.runs[0].played.frames) frame.statistics.triangles = 1006;
    const auto more = compared(reportTaking(20), other);
    ASSERT_TRUE(more.ok());
    EXPECT_EQ(verdictOf(*more, "triangles, mean"), Verdict::More);
}

TEST_F(CompareReports, FramesOverTauAreCountedByPasses) {
    const auto beyond = [](int passes) {
        Report report = reportTaking(20, passes);
        for (BenchRun& run : report.runs)
            for (PlayedFrame& frame : run.played.frames)
                if (frame.seconds < 0.15)
                    frame.statistics.tauAchievedPixels = 2 * run.tauPixels;
        return report;
    };
    const auto comparison = compared(beyond(5), beyond(3));
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    EXPECT_EQ(verdictOf(*comparison, "frames over tau, a pass"), Verdict::Equal);
}

TEST_F(CompareReports, SayWhereCoresDiffer) {
    WrittenReport more = written(reportTaking(20), "more.json").value();
    more.cores += 14;
    const auto comparison = compare(written(reportTaking(20), "a.json").value(), more, false);
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    EXPECT_THAT(comparison->notes, testing::ElementsAre(HasSubstr("machines differ")));
}

TEST_F(CompareReports, WithoutOcclusionTrianglesAreHeldToTheLast) {
    Report before = reportTaking(20);
    before.facts.occlusion = "off";
    Report after = before;
    EXPECT_EQ(verdictOf(compared(before, after).value(), "triangles, mean"), Verdict::Equal);
    for (PlayedFrame& frame : after.runs[0].played.frames) frame.statistics.triangles = 1001;
    EXPECT_EQ(verdictOf(compared(before, after).value(), "triangles, mean"), Verdict::More);
}

Report reportMeasuring(int frames, double maxPixels) {
    Report report = reportTaking(20);
    for (BenchRun& run : report.runs)
        run.measured = MeasuredErrors{
            std::vector<FrameError>(static_cast<std::size_t>(frames),
                                    {.promisedPixels = 1, .maxPixels = maxPixels, .compared = 9}),
            {}};
    return report;
}

TEST_F(CompareReports, ErrorsMeasuredOfOtherFramesAreNoDifference) {
    const auto same = compared(reportMeasuring(6, 0.5), reportMeasuring(6, 0.6));
    ASSERT_TRUE(same.ok()) << same.status();
    EXPECT_EQ(verdictOf(*same, "error measured, worst"), Verdict::More);
    EXPECT_THAT(same->notes, testing::IsEmpty());
    const auto more = compared(reportMeasuring(6, 0.5), reportMeasuring(24, 0.6));
    ASSERT_TRUE(more.ok()) << more.status();
    EXPECT_EQ(verdictOf(*more, "error measured, worst"), Verdict::NotRepeated);
    EXPECT_EQ(countBeyondNoise(*more), 0);
    EXPECT_THAT(
        more->notes,
        testing::Each(testing::ContainsRegex("measured of 6 of 8 frames in .*, of 24 of 8 in ")));
    EXPECT_EQ(more->notes.size(), 2U);
}

TEST_F(CompareReports, ErrorsMeasuredOfAsManyFramesThatAreNotEmptyMayBeOfOthers) {
    Report six = reportMeasuring(5, 0.6);
    for (BenchRun& run : six.runs) run.measured->frames.insert(run.measured->frames.begin(), {{}});
    const auto other = compared(reportMeasuring(5, 0.5), six);
    ASSERT_TRUE(other.ok()) << other.status();
    EXPECT_EQ(verdictOf(*other, "error measured, worst"), Verdict::NotRepeated);
    EXPECT_THAT(other->notes,
                testing::Each(testing::ContainsRegex("measured of 5 of 8 frames in .*, of 6 of ")));
    EXPECT_EQ(other->notes.size(), 2U);

    Report longer = reportMeasuring(5, 0.6);
    longer.facts.frames = 16;
    const auto forced = compared(reportMeasuring(5, 0.5), longer, true);
    ASSERT_TRUE(forced.ok()) << forced.status();
    EXPECT_EQ(verdictOf(*forced, "error measured, worst"), Verdict::NotRepeated);
    EXPECT_THAT(forced->notes, testing::Contains(testing::ContainsRegex("5 of 16 in ")).Times(2));
}

TEST_F(CompareReports, OfErrorsOfBeforeNobodyKnowsOfWhichFramesTheyAre) {
    std::string old = summaryJson(reportMeasuring(5, 0.5));
    for (std::size_t at = 0; (at = old.find("framesJudged", at)) != std::string::npos; ++at)
        old.replace(at, 12, "before");
    const auto a = readReport(folder_.write("old.json", old));
    ASSERT_TRUE(a.ok()) << a.status();
    const auto both = compare(*a, *a, false);
    ASSERT_TRUE(both.ok()) << both.status();
    EXPECT_EQ(verdictOf(*both, "error measured, worst"), Verdict::NotRepeated);
    EXPECT_THAT(both->notes, testing::Each(HasSubstr("measured of some of 8 frames in ")));
}

/// As reportTaking, at a frame time to hold or by two renderers; tau and triangles go up and down
/// by a twentieth from frame to frame, and are so many times as much.
Report reportOfFreeTau(double milliseconds, int renderers, unsigned seed, double times = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> around(0.95, 1.05);
    Report report = reportTaking(20);
    for (BenchRun& run : report.runs) {
        run.budgetMilliseconds = milliseconds;
        if (milliseconds > 0)
            run.label = "33 ms";
        run.renderers = renderers;
        for (PlayedFrame& frame : run.played.frames) {
            frame.statistics.tauAchievedPixels = times * around(random);
            frame.statistics.triangles = static_cast<std::uint64_t>(1000 * times * around(random));
        }
    }
    return report;
}

TEST_F(CompareReports, WhatDoesNotRepeatIsJudgedByHowPassesSpread) {
    for (const auto& [milliseconds, renderers] : {std::pair(33.0, 0), {0.0, 2}}) {
        const Report before = reportOfFreeTau(milliseconds, renderers, 1);
        const auto same = compared(before, reportOfFreeTau(milliseconds, renderers, 2));
        ASSERT_TRUE(same.ok()) << same.status();
        EXPECT_EQ(countBeyondNoise(*same), 0) << table(*same);
        EXPECT_EQ(verdictOf(*same, "error promised, p95"), Verdict::WithinNoise);
        EXPECT_EQ(verdictOf(*same, "frames over tau, a pass"), Verdict::NotRepeated);
        const auto more = compared(before, reportOfFreeTau(milliseconds, renderers, 2, 1.3));
        ASSERT_TRUE(more.ok()) << more.status();
        EXPECT_EQ(verdictOf(*more, "error promised, p95"), Verdict::More);
        EXPECT_EQ(verdictOf(*more, "triangles, mean"), Verdict::More);
    }
}

/// As reportOfFreeTau at a frame time, but of the same error and points in every frame.
Report reportPromising(double tauAchieved, std::uint64_t points = 1, int passes = 5) {
    Report report = reportTaking(20, passes);
    for (BenchRun& run : report.runs) {
        run.budgetMilliseconds = 33;
        for (PlayedFrame& frame : run.played.frames) {
            frame.statistics.tauAchievedPixels = tauAchieved;
            frame.statistics.points = points;
        }
    }
    return report;
}

TEST_F(CompareReports, WhatIsZeroOrWithoutABoundIsJudgedByTheOrderOfPasses) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const auto promised = [&](double a, double b, int passes = 5) {
        const auto both =
            compared(reportPromising(a, 1, passes), reportPromising(b, 1, passes)).value();
        return verdictOf(both, "error promised, p95");
    };
    EXPECT_EQ(promised(0.9, kNone), Verdict::More);
    EXPECT_EQ(promised(kNone, 0.9), Verdict::Less);
    EXPECT_EQ(promised(0.9, kNone, 3), Verdict::TooFewPasses);
    EXPECT_EQ(promised(kNone, kNone), Verdict::Equal);
    EXPECT_EQ(promised(0, 0), Verdict::Equal);
    Report some = reportPromising(0.9);
    for (BenchRun& run : some.runs)
        for (PlayedFrame& frame : run.played.frames)
            if (frame.pass == 2)
                frame.statistics.tauAchievedPixels = kNone;
    EXPECT_EQ(verdictOf(compared(reportPromising(0.9), some).value(), "error promised, p95"),
              Verdict::WithinNoise);
    const auto lost = compared(reportPromising(0.9), reportPromising(kNone));
    EXPECT_EQ(countBeyondNoise(*lost), 2) << "one a run: " << table(*lost);
    const auto points = compared(reportPromising(0.9, 0), reportPromising(0.9, 500));
    EXPECT_EQ(verdictOf(*points, "points, mean"), Verdict::More);
}

TEST_F(CompareReports, ErrorsWithoutABoundAreReadAsEarlierReportsHaveThem) {
    const std::string now = summaryJson(reportPromising(std::numeric_limits<double>::infinity()));
    std::string before = now;
    for (std::size_t at = 0; (at = before.find("\"Infinity\"", at)) != std::string::npos;)
        before.replace(at, 10, "null");
    ASSERT_NE(before, now);
    const auto a = readReport(folder_.write("before.json", before));
    const auto b = readReport(folder_.write("now.json", now));
    ASSERT_TRUE(a.ok() && b.ok()) << a.status() << b.status();
    EXPECT_EQ(a->runs.at(0).tauAchievedMax, std::numeric_limits<double>::infinity());
    EXPECT_EQ(b->runs.at(0).tauAchievedMax, std::numeric_limits<double>::infinity());
}

TEST_F(CompareReports, PassesOfBeforeErrorsWereToldOfEachAreNotJudgedByThem) {
    std::string old = summaryJson(reportPromising(0.9));
    for (std::size_t at = 0; (at = old.find("\"tauP95\"", at)) != std::string::npos; ++at)
        old.replace(at, 8, "\"before\"");
    const auto a = readReport(folder_.write("old.json", old));
    ASSERT_TRUE(a.ok()) << a.status();
    for (const auto& [before, after] :
         {std::pair(*a, *a), {*a, *written(reportPromising(0.9), "new.json")}}) {
        const auto both = compare(before, after, false);
        ASSERT_TRUE(both.ok()) << both.status();
        EXPECT_EQ(verdictOf(*both, "error promised, p95"), Verdict::TooFewPasses);
        EXPECT_EQ(verdictOf(*both, "triangles, mean"), Verdict::TooFewPasses);
        EXPECT_EQ(countBeyondNoise(*both), 0);
    }
}

TEST_F(CompareReports, FrameTimesHeldFromAnotherTauOnAreNotTheSame) {
    const Report before = reportOfFreeTau(33, 0, 1);
    Report after = before;
    after.runs[1].tauPixels = 8;
    const auto mixed = compared(before, after);
    ASSERT_TRUE(mixed.ok()) << mixed.status();
    EXPECT_EQ(mixed->runs.size(), 1U);
    EXPECT_THAT(mixed->notes, testing::ElementsAre(
                                  testing::ContainsRegex("only .*a.json has 33 ms at 4 px or more"),
                                  testing::ContainsRegex("only .*b.json has 33 ms at 8 px")));
}

TEST_F(CompareReports, SayWhereWhatIsHiddenWasNotLeftOutAlike) {
    Report off = reportTaking(20);
    off.facts.occlusion = "off";
    const auto mixed = compared(reportTaking(20), off);
    ASSERT_TRUE(mixed.ok());
    EXPECT_THAT(mixed->notes, testing::ElementsAre(HasSubstr("--occlusion auto")));
}

TEST(PassRatio, OfTheSameThingIsBeyondNoiseAsSeldomAsItSays) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.05);
    const auto passes = [&](int count, double level) {
        std::vector<double> values;
        for (int i = 0; i < count; ++i) values.push_back(level * std::exp(noise(random)));
        return values;
    };
    constexpr int kTries = 4000;
    for (const int count : {4, 5, 8, 20}) {
        int missed = 0;
        for (int i = 0; i < kTries; ++i) {
            const Ratio ratio = ratioOf(passes(count, 30), passes(count, 30));
            missed += ratio.low > 1 || ratio.high < 1 ? 1 : 0;
        }
        EXPECT_LT(missed, kTries * (count == 4 ? 0.04 : 0.015)) << count;
    }
    int seen = 0;
    for (int i = 0; i < 200; ++i) seen += ratioOf(passes(8, 30), passes(8, 36)).low > 1 ? 1 : 0;
    EXPECT_GT(seen, 190) << "a difference of four spreads is seen";
}

TEST_F(CompareReports, OnlyTheSameFlightOverTheSameSceneIsCompared) {
    Report other = reportTaking(20, 5, "another.eyt");
    const auto refused = compared(reportTaking(20), other);
    EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(
        std::string(refused.status().message()),
        testing::AllOf(HasSubstr("dem.eyt"), HasSubstr("another.eyt"), HasSubstr("--force")));
    const auto forced = compared(reportTaking(20), other, true);
    ASSERT_TRUE(forced.ok());
    EXPECT_THAT(forced->notes, testing::ElementsAre(HasSubstr("another.eyt")));
    other = reportTaking(20);
    other.facts.width = 320;
    EXPECT_FALSE(compared(reportTaking(20), other).ok());
}

TEST_F(CompareReports, FlightsOfOneNameThatAreNotTheSameAreRefused) {
    Report other = reportTaking(20);
    other.facts.flightHash = 7;
    EXPECT_THAT(std::string(compared(reportTaking(20), other).status().message()),
                testing::AllOf(HasSubstr("other flights"), HasSubstr("--force")));
    EXPECT_TRUE(compared(reportTaking(20), other, true).ok());
    WrittenReport before = written(reportTaking(20), "a.json").value();
    before.flightHash.clear();
    EXPECT_TRUE(compare(before, written(other, "b.json").value(), false).ok()) << "nobody knows";
}

TEST_F(CompareReports, OtherScreensAreRefused) {
    Report other = reportTaking(20);
    other.facts.seen = "--config cave.eqc --segment 2";
    EXPECT_THAT(std::string(compared(reportTaking(20), other).status().message()),
                testing::AllOf(HasSubstr("--segment 2"), HasSubstr("--force")));
    EXPECT_TRUE(compared(reportTaking(20), other, true).ok());
    other.facts.seen = "\x1b[31m";
    EXPECT_THAT(std::string(compared(reportTaking(20), other).status().message()),
                HasSubstr("\\x1b[31m"))
        << "what a report says is fit for a terminal";
    WrittenReport before = written(reportTaking(20), "a.json").value();
    before.seen.reset();
    EXPECT_TRUE(compare(before, written(other, "b.json").value(), false).ok()) << "nobody knows";
}

TEST_F(CompareReports, ConfigurationsOfOneNameThatAreNotTheSameAreRefused) {
    Report cave = reportTaking(20);
    cave.facts.seen = "--config cave.eqc";
    cave.facts.configurationHash = 5;
    Report other = cave;
    EXPECT_TRUE(compared(cave, other).ok());
    other.facts.configurationHash = 7;
    EXPECT_THAT(std::string(compared(cave, other).status().message()),
                testing::AllOf(HasSubstr("other configurations"), HasSubstr("--config cave.eqc"),
                               HasSubstr("--force")));
    EXPECT_TRUE(compared(cave, other, true).ok());
    WrittenReport before = written(cave, "a.json").value();
    before.configurationHash.clear();
    EXPECT_TRUE(compare(before, written(other, "b.json").value(), false).ok()) << "nobody knows";
}

TEST_F(CompareReports, DataOfOneNameThatAreNotTheSameAreSaid) {
    Report other = reportTaking(20);
    EXPECT_THAT(compared(reportTaking(20), other)->notes, testing::IsEmpty());
    other.facts.sceneHash = 7;
    EXPECT_THAT(compared(reportTaking(20), other)->notes,
                testing::ElementsAre(HasSubstr("other data of the name dem.eyt")));
}

TEST_F(CompareReports, RunsOfOneReportOnlyAreSaid) {
    Report other = reportTaking(20);
    other.runs.pop_back();
    EXPECT_THAT(compared(reportTaking(20), other)->notes,
                testing::ElementsAre(testing::ContainsRegex("only .*a.json has 4 px")));
    other.runs[0].renderers = 2;
    EXPECT_THAT(std::string(compared(reportTaking(20), other).status().message()),
                HasSubstr("no run in common"));
}

TEST_F(CompareReports, DamagedReportsAreRefusedWithTheField) {
    const std::string good = summaryJson(reportTaking(20));
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string damaged = good;
        damaged.replace(damaged.find(from), from.size(), to);
        return refusal(damaged);
    };
    EXPECT_EQ(readReport(folder_.path("none")).status().code(), absl::StatusCode::kNotFound);
    std::filesystem::create_symlink("loop", folder_.path("loop"));
    EXPECT_EQ(readReport(folder_.path("loop")).status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(refusal(""), HasSubstr("damaged.json: this is no summary of eyrie bench"));
    EXPECT_THAT(refusal(good.substr(0, good.size() / 2)), HasSubstr("damaged.json"));
    EXPECT_THAT(refusal("[1]"), HasSubstr("damaged.json: bench.scene is missing"));
    EXPECT_THAT(with("\"trianglesMean\"", "\"triangles\""),
                HasSubstr("damaged.json: runs[0].trianglesMean is missing; expected a number"));
    EXPECT_THAT(with("\"renderers\": 0", "\"renderers\": 0.5"),
                HasSubstr("runs[0].renderers is 0.5"));
    EXPECT_THAT(with("\"renderers\": 0", "\"renderers\": -1"), HasSubstr("is -1"));
    EXPECT_THAT(with("\"renderers\": 0", "\"renderers\": \"one\""), HasSubstr("is not a number"));
    EXPECT_THAT(with("\"width\": 640", "\"width\": 1e300"), HasSubstr("bench.width is 1e+300"));
}

TEST_F(CompareReports, AComparisonDoesNotTakeThePlaceOfAReport) {
    const auto comparison = compared(reportTaking(20, 5), reportTaking(22, 5));
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    folder_.write("summary.json", "{}");
    folder_.write("index.html", "the report");
    EXPECT_TRUE(absl::IsInvalidArgument(writeComparison(*comparison, folder_.path("."))));
    EXPECT_EQ(std::filesystem::file_size(folder_.path("index.html")), 10U);
}

TEST_F(CompareReports, AComparisonTakesThePlaceOfNoPageButAComparisons) {
    const auto comparison = compared(reportTaking(20, 5), reportTaking(22, 5));
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    folder_.write("index.html", "somebody's");
    EXPECT_TRUE(absl::IsInvalidArgument(writeComparison(*comparison, folder_.path("."))));
    std::filesystem::remove(folder_.path("index.html"));
    EXPECT_TRUE(writeComparison(*comparison, folder_.path(".")).ok());
    EXPECT_TRUE(writeComparison(*comparison, folder_.path(".")).ok()) << "its own";
    std::filesystem::create_symlink("loop", folder_.path("loop"));
    EXPECT_FALSE(writeComparison(*comparison, folder_.path("loop")).ok());
}

TEST_F(CompareReports, ThePageAndTheJsonSayTheSame) {
    const auto comparison =
        compared(reportTaking(20, 5, "</script>.eyt"), reportTaking(22, 5, "</script>.eyt"));
    ASSERT_TRUE(comparison.ok()) << comparison.status();
    const auto json = test::parseJson(comparisonJson(*comparison));
    const auto runs = test::list(json, "runs");
    ASSERT_EQ(runs.size(), 2U);
    const auto median = test::list(runs[0], "figures").at(0);
    EXPECT_EQ(test::at(median, "verdict").string_value(), "slower");
    EXPECT_TRUE(test::at(median, "beyondNoise").bool_value());
    EXPECT_NEAR(test::number(median, "ratio"), 1.1, 1e-9);
    EXPECT_EQ(test::number(json, "beyondNoise"), 6);
    ASSERT_TRUE(writeComparison(*comparison, folder_.path("out")).ok());
    const std::string page = comparisonPage(*comparison);
    EXPECT_THAT(page, HasSubstr("\"verdict\": \"slower\""));
    EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
    EXPECT_THAT(page, testing::Not(HasSubstr("EYRIE_")));
}

}  // namespace
}  // namespace eyrie::cli::bench
