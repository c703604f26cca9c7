// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/compare.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/runs.h"

namespace eyrie::cli::bench {
namespace {

/// Of the rank sum's normal approximation: 1 in 200 on each side.
constexpr double kOneInTwoHundred = 2.5758;

/// How many of the least, and of the greatest, of n m ratios are left out.
std::size_t leftOut(double n, double m) {
    const double spread = std::sqrt(n * m * (n + m + 1) / 12);
    return static_cast<std::size_t>(
        std::max(0.0, std::floor(n * m / 2 - kOneInTwoHundred * spread - 0.5)));
}

/// Of an interval that leaves out none of n m ratios: it misses in 2 of the orders in which n and m
/// values may come, C(n + m, n).
double confidenceOfAll(double n, double m) {
    const double orders =
        std::exp(std::lgamma(n + m + 1) - std::lgamma(n + 1) - std::lgamma(m + 1));
    return 1 - 2 / orders;
}

template <typename Select>
std::vector<double> passesOf(const WrittenRun& run, const Select& select) {
    std::vector<double> values;
    for (const PassSummary& pass : run.passes) values.push_back(select(pass));
    return values;
}

Verdict verdictOf(const Ratio& ratio) {
    if (ratio.confidence < kLeastConfidence)
        return Verdict::TooFewPasses;
    if (ratio.low > 1)
        return Verdict::More;
    return ratio.high < 1 ? Verdict::Less : Verdict::WithinNoise;
}

/// Of passes that have no ratio, as some are 0 or without a bound: whether all of one come before
/// all of the other.
Verdict verdictOfOrder(const std::vector<double>& a, const std::vector<double>& b) {
    const auto [leastA, mostA] = std::ranges::minmax(a);
    const auto [leastB, mostB] = std::ranges::minmax(b);
    if (std::min(leastA, leastB) == std::max(mostA, mostB))
        return Verdict::Equal;
    const auto n = static_cast<double>(a.size());
    const auto m = static_cast<double>(b.size());
    if (confidenceOfAll(n, m) < kLeastConfidence)
        return Verdict::TooFewPasses;
    if (mostA < leastB)
        return Verdict::More;
    return mostB < leastA ? Verdict::Less : Verdict::WithinNoise;
}

/// `shown` is of all of a run, `select` of a pass.
template <typename Shown, typename Select>
Figure ofPasses(const char* name, const char* unit, const WrittenRun& a, const WrittenRun& b,
                const Shown& shown, const Select& select) {
    Figure result{name, unit, shown(a), shown(b), {}, Verdict::TooFewPasses};
    const std::vector<double> inA = passesOf(a, select);
    const std::vector<double> inB = passesOf(b, select);
    const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
    if (inA.empty() || inB.empty())
        return result;
    if (!std::ranges::all_of(inA, positive) || !std::ranges::all_of(inB, positive)) {
        result.verdict = verdictOfOrder(inA, inB);
        return result;
    }
    result.ratio = ratioOf(inA, inB);
    result.verdict = verdictOf(*result.ratio);
    return result;
}

/// The same of errors, triangles or points, which passes of old reports do not tell.
template <typename Shown, typename Select>
Figure ofDrawn(const char* name, const char* unit, const WrittenRun& a, const WrittenRun& b,
               const Shown& shown, const Select& select) {
    if (!a.passesTellDrawn || !b.passesTellDrawn)
        return {name, unit, shown(a), shown(b), {}, Verdict::TooFewPasses};
    return ofPasses(name, unit, a, b, shown, select);
}

Figure ofTimes(const char* name, double Percentiles::*figure, const WrittenRun& a,
               const WrittenRun& b) {
    return ofPasses(
        name, "ms", a, b, [&](const WrittenRun& run) { return run.frame.*figure; },
        [&](const PassSummary& pass) { return pass.frame.*figure; });
}

/// What repeats to the bit, so that any difference is one.
Figure exact(const char* name, const char* unit, double a, double b) {
    const Verdict verdict = a == b ? Verdict::Equal : a < b ? Verdict::More : Verdict::Less;
    return {name, unit, a, b, {}, verdict};
}

/// Which of what is hidden is left out is decided by times measured on the way, so that triangles
/// of the same cuts differ by up to some thousandths.
constexpr double kShareByOcclusion = 0.005;

/// What repeats but for `noise`, a share of it.
Figure counted(const char* name, double noise, double a, double b) {
    Figure figure = exact(name, "", a, b);
    if (a != b && std::abs(b - a) <= noise * a)
        figure.verdict = Verdict::WithinNoise;
    return figure;
}

Figure once(const char* name, const char* unit, double a, double b) {
    return {name, unit, a, b, {}, Verdict::NotRepeated};
}

/// Whether what is drawn follows from what was asked for alone. Where a frame time is to be held,
/// tau follows from times; and of several renderers each looks closely at tiles of its own.
bool repeats(const WrittenRun& run) { return run.budgetMilliseconds == 0 && run.renderers <= 1; }

/// Memory differs by what the kernel keeps for itself from one start to the next, and is not told.
bool areOtherMachines(const WrittenReport& a, const WrittenReport& b) {
    return a.processor != b.processor || a.device != b.device || a.cores != b.cores ||
           a.driver != b.driver;
}

std::string machineOf(const WrittenReport& report) {
    return fmt::format("{}, {} cores, {}, {}", report.processor, report.cores, report.device,
                       report.driver);
}

/// Of all passes, the first too.
double beyondAPass(const WrittenRun& run) {
    return run.framesBeyond / static_cast<double>(run.passes.size() + 1);
}

/// `figure` is exact or once.
void addMeasured(const WrittenRun& a, const WrittenRun& b,
                 Figure figure(const char*, const char*, double, double),
                 std::vector<Figure>& figures) {
    if (a.errorP99 && b.errorP99)
        figures.push_back(figure("error measured, p99", "px", *a.errorP99, *b.errorP99));
    if (a.errorMax && b.errorMax)
        figures.push_back(figure("error measured, worst", "px", *a.errorMax, *b.errorMax));
}

void addDrawn(const WrittenRun& a, const WrittenRun& b, double countNoise, bool areFramesTheSame,
              std::vector<Figure>& figures) {
    figures.push_back(exact("error promised", "px", a.tauAchievedMax, b.tauAchievedMax));
    figures.push_back(exact("frames over tau, a pass", "", beyondAPass(a), beyondAPass(b)));
    figures.push_back(counted("triangles, mean", countNoise, a.trianglesMean, b.trianglesMean));
    if (a.pointsMean > 0 || b.pointsMean > 0)
        figures.push_back(counted("points, mean", countNoise, a.pointsMean, b.pointsMean));
    addMeasured(a, b, areFramesTheSame ? exact : once, figures);
}

/// The same of what does not repeat: by how passes spread.
void addDrawnAnew(const WrittenRun& a, const WrittenRun& b, std::vector<Figure>& figures) {
    figures.push_back(ofDrawn(
        "error promised, p95", "px", a, b,
        [](const WrittenRun& run) {
            return quantile(passesOf(run, [](auto& pass) { return pass.tauP95; }), 0.5);
        },
        [](const PassSummary& pass) { return pass.tauP95; }));
    figures.push_back(once("frames over tau, a pass", "", beyondAPass(a), beyondAPass(b)));
    figures.push_back(ofDrawn(
        "triangles, mean", "", a, b, [](const WrittenRun& run) { return run.trianglesMean; },
        [](const PassSummary& pass) { return pass.triangles; }));
    if (a.pointsMean > 0 || b.pointsMean > 0)
        figures.push_back(ofDrawn(
            "points, mean", "", a, b, [](const WrittenRun& run) { return run.pointsMean; },
            [](const PassSummary& pass) { return pass.points; }));
    addMeasured(a, b, once, figures);
}

std::vector<Figure> figuresOf(const WrittenRun& a, const WrittenRun& b, double countNoise,
                              bool areFramesTheSame) {
    std::vector<Figure> figures = {ofTimes("frame, median", &Percentiles::p50, a, b),
                                   ofTimes("frame, p95", &Percentiles::p95, a, b),
                                   ofTimes("frame, p99", &Percentiles::p99, a, b)};
    if (repeats(a) && repeats(b))
        addDrawn(a, b, countNoise, areFramesTheSame, figures);
    else
        addDrawnAnew(a, b, figures);
    figures.push_back(once("first pass, median", "ms", a.firstPassMedian, b.firstPassMedian));
    figures.push_back(once("loaded", "MiB", a.bytesLoaded / 0x1p20, b.bytesLoaded / 0x1p20));
    figures.push_back(
        once("memory", "MiB", a.peakResidentBytes / 0x1p20, b.peakResidentBytes / 0x1p20));
    return figures;
}

bool isSameKind(const WrittenRun& a, const WrittenRun& b) {
    // A label that is a frame time does not say from which tau on frames are coarser.
    const bool isSameTau = a.budgetMilliseconds == 0 || a.tauPixels == b.tauPixels;
    return a.label == b.label && isSameTau && a.renderers == b.renderers &&
           a.compound == b.compound;
}

/// Whether errors were measured of the same frames of the flight: of others they are others.
bool areOfTheSameFrames(const WrittenRun& a, int framesOfA, const WrittenRun& b, int framesOfB) {
    return framesOfA == framesOfB && a.framesJudged && a.framesJudged == b.framesJudged;
}

/// "6 of 120".
std::string judgedOf(const WrittenRun& run, int frames) {
    return fmt::format("{} of {}", run.framesJudged ? std::to_string(*run.framesJudged) : "some",
                       frames);
}

std::string nameOf(const WrittenRun& run) {
    const std::string tau =
        run.budgetMilliseconds > 0 ? fmt::format(" at {} px or more", run.tauPixels) : "";
    return fmt::format("{}{}, {}", run.label, tau, drawnBy(run.renderers, run.compound));
}

void noteRunsOfOneOnly(const WrittenReport& own, const WrittenReport& other,
                       std::vector<std::string>& notes) {
    for (const WrittenRun& run : own.runs)
        if (std::ranges::none_of(other.runs, [&](auto& one) { return isSameKind(run, one); }))
            notes.push_back(fmt::format("only {} has {}", own.name, nameOf(run)));
}

/// Of hashes, where both reports tell them.
bool areOther(const std::string& a, const std::string& b) {
    return !a.empty() && !b.empty() && a != b;
}

/// What was measured differently, in words; empty where nothing was.
std::string differenceOf(const WrittenReport& a, const WrittenReport& b) {
    const auto said = [](const WrittenReport& report) {
        return fmt::format("{} is of {}, flight {}, {} x {} pixels, {} frames", report.name,
                           report.scene, report.flight, report.width, report.height, report.frames);
    };
    const auto key = [](const WrittenReport& report) {
        return std::tuple(report.scene, report.flight, report.width, report.height, report.frames);
    };
    if (key(a) != key(b))
        return said(a) + "; " + said(b);
    const auto screen = [](const WrittenReport& report) {
        return fmt::format("{} is of {}", report.name,
                           report.seen->empty() ? "what is seen without --config" : *report.seen);
    };
    if (a.seen && b.seen && a.seen != b.seen)
        return screen(a) + "; " + screen(b);
    if (areOther(a.configurationHash, b.configurationHash))
        return fmt::format("{} and {} are of other configurations that are both named by {}",
                           a.name, b.name, a.seen.value_or("--config"));
    return areOther(a.flightHash, b.flightHash)
               ? fmt::format("{} and {} are of other flights that are both named {}", a.name,
                             b.name, a.flight)
               : "";
}

}  // namespace

Ratio ratioOf(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (const double before : a)
        for (const double after : b) ratios.push_back(after / before);
    std::ranges::sort(ratios);
    const auto n = static_cast<double>(a.size());
    const auto m = static_cast<double>(b.size());
    const std::size_t k = leftOut(n, m);
    const std::size_t last = ratios.size() - 1;
    return {(ratios[last / 2] + ratios[(last + 1) / 2]) / 2, ratios[k], ratios[last - k],
            k == 0 ? confidenceOfAll(n, m) : 0.99};
}

absl::StatusOr<Comparison> compare(WrittenReport a, WrittenReport b, bool force) {
    Comparison comparison;
    if (const std::string difference = differenceOf(a, b); !difference.empty()) {
        if (!force)
            return absl::InvalidArgumentError(difference +
                                              "; only the same can be compared, or say --force");
        comparison.notes.push_back(difference);
    }
    if (areOther(a.sceneHash, b.sceneHash) && a.scene == b.scene)
        comparison.notes.push_back(
            fmt::format("{} and {} drew other data of the name {}, or placed otherwise", a.name,
                        b.name, a.scene));
    if (areOtherMachines(a, b))
        comparison.notes.push_back(
            fmt::format("machines differ: {}; {}", machineOf(a), machineOf(b)));
    if (a.occlusion != b.occlusion)
        comparison.notes.push_back(
            fmt::format("{} was drawn with --occlusion {}, {} with {}; what is hidden is not left "
                        "out alike",
                        a.name, a.occlusion, b.name, b.occlusion));
    const bool countsRepeat = a.occlusion == "off" && b.occlusion == "off";
    for (const WrittenRun& run : a.runs)
        for (const WrittenRun& other : b.runs)
            if (isSameKind(run, other)) {
                const bool areFramesTheSame = areOfTheSameFrames(run, a.frames, other, b.frames);
                comparison.runs.push_back(
                    {run, other,
                     figuresOf(run, other, countsRepeat ? 0 : kShareByOcclusion,
                               areFramesTheSame)});
                if (run.errorP99 && other.errorP99 && !areFramesTheSame)
                    comparison.notes.push_back(fmt::format(
                        "{}: errors were measured of {} frames in {}, of {} in {}; those of other "
                        "frames are others",
                        nameOf(run), judgedOf(run, a.frames), a.name, judgedOf(other, b.frames),
                        b.name));
                if (run.framesInFlight != other.framesInFlight)
                    comparison.notes.push_back(fmt::format(
                        "{}: {} has {} frames in flight, {} {}; the times of frames "
                        "are not those of one way to draw",
                        nameOf(run), a.name, run.framesInFlight, b.name, other.framesInFlight));
            }
    if (comparison.runs.empty())
        return absl::InvalidArgumentError(
            fmt::format("{} and {} have no run in common; measure the same --tau and --renderers",
                        a.name, b.name));
    noteRunsOfOneOnly(a, b, comparison.notes);
    noteRunsOfOneOnly(b, a, comparison.notes);
    comparison.a = std::move(a);
    comparison.b = std::move(b);
    return comparison;
}

int countBeyondNoise(const Comparison& comparison) {
    int count = 0;
    for (const RunComparison& run : comparison.runs)
        count += static_cast<int>(std::ranges::count_if(run.figures, [](const Figure& figure) {
            return figure.verdict == Verdict::Less || figure.verdict == Verdict::More;
        }));
    return count;
}

}  // namespace eyrie::cli::bench
