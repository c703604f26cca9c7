// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/run_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace eyrie::cli::bench {
namespace {

using Select = double (*)(const PlayedFrame&);

std::vector<double> column(const Played& played, bool first, Select select) {
    std::vector<double> values;
    for (const PlayedFrame& frame : played.frames)
        if ((frame.pass == 0) == first)
            values.push_back(select(frame));
    return values;
}

double median(const Played& played, Select select) {
    return quantile(column(played, false, select), 0.5);
}

/// 0 of none.
double median(const std::vector<fabric::StageMilliseconds>& frames,
              double fabric::StageMilliseconds::*stage) {
    std::vector<double> values;
    for (const fabric::StageMilliseconds& frame : frames) values.push_back(frame.*stage);
    return values.empty() ? 0 : quantile(std::move(values), 0.5);
}

double mean(const Played& played, Select select) {
    const std::vector<double> values = column(played, false, select);
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

double taken(const PlayedFrame& frame) { return frame.milliseconds; }

double latency(const PlayedFrame& frame) { return frame.latencyMilliseconds; }

double triangles(const PlayedFrame& frame) {
    return static_cast<double>(frame.statistics.triangles);
}

double points(const PlayedFrame& frame) { return static_cast<double>(frame.statistics.points); }

fabric::StageMilliseconds meansOf(const Played& played) {
    fabric::StageMilliseconds means;
    means.cull = mean(played, [](auto& f) { return f.statistics.milliseconds.cull; });
    means.draw = mean(played, [](auto& f) { return f.statistics.milliseconds.draw; });
    means.readback = mean(played, [](auto& f) { return f.statistics.milliseconds.readback; });
    means.encode = mean(played, [](auto& f) { return f.statistics.milliseconds.encode; });
    means.total = mean(played, latency);
    double vertices = 0;
    double both = 0;
    for (const fabric::StageMilliseconds& stages : played.stages) {
        vertices += stages.vertices;
        both += stages.vertices + stages.fill;
    }
    means.vertices = both > 0 ? means.draw * vertices / both : 0;
    means.fill = both > 0 ? means.draw - means.vertices : 0;
    return means;
}

constexpr double kLearningMilliseconds = 1000;
constexpr double kBudgetSlack = 1.2;

double shareWithinBudget(const Played& played) {
    double elapsed = 0;
    double frames = 0;
    double within = 0;
    for (const PlayedFrame& frame : played.frames) {
        const bool isLearning = elapsed < kLearningMilliseconds;
        elapsed += frame.milliseconds;
        if (isLearning || !frame.statistics.budget)
            continue;
        ++frames;
        within +=
            frame.milliseconds <= kBudgetSlack * frame.statistics.budget->milliseconds ? 1 : 0;
    }
    return frames == 0 ? std::numeric_limits<double>::quiet_NaN() : within / frames;
}

double promised(const PlayedFrame& frame) { return frame.statistics.tauAchievedPixels; }

using Passes = std::vector<std::vector<PlayedFrame>>;

/// The measured ones, in their order, or the first alone.
Passes passesOf(const Played& played, bool first) {
    Passes passes;
    for (const PlayedFrame& frame : played.frames) {
        if ((frame.pass == 0) != first)
            continue;
        passes.resize(std::max(passes.size(), static_cast<std::size_t>(std::max(1, frame.pass))));
        passes.back().push_back(frame);
    }
    return passes;
}

/// The median. Several frames in flight may come in bursts, in which most follow each other at
/// once: of these, the median of the means over as many in turn as are in flight.
double medianTime(const Passes& passes, int framesInFlight) {
    const auto inTurn = static_cast<std::size_t>(std::max(1, framesInFlight));
    std::vector<double> means;
    for (const std::vector<PlayedFrame>& pass : passes) {
        const std::size_t many = std::min(inTurn, pass.size());
        for (std::size_t i = 0; i + many <= pass.size(); ++i) {
            double sum = 0;
            for (std::size_t k = i; k < i + many; ++k) sum += pass[k].milliseconds;
            means.push_back(sum / static_cast<double>(many));
        }
    }
    return quantile(std::move(means), 0.5);
}

PassSummary ofPass(const std::vector<PlayedFrame>& frames, int framesInFlight) {
    std::vector<double> milliseconds;
    std::vector<double> taus;
    PassSummary pass;
    const auto share = 1 / static_cast<double>(frames.size());
    for (const PlayedFrame& frame : frames) {
        milliseconds.push_back(frame.milliseconds);
        taus.push_back(promised(frame));
        pass.triangles += share * static_cast<double>(frame.statistics.triangles);
        pass.points += share * static_cast<double>(frame.statistics.points);
    }
    pass.frame = percentiles(milliseconds);
    pass.frame.p50 = medianTime({frames}, framesInFlight);
    pass.tauP95 = quantile(std::move(taus), 0.95);
    return pass;
}

std::vector<PassSummary> ofEachPass(const Passes& passes, int framesInFlight) {
    std::vector<PassSummary> result;
    for (const std::vector<PlayedFrame>& pass : passes)
        result.push_back(ofPass(pass, framesInFlight));
    return result;
}

/// Adds what a frame loaded and drew, and with what error.
void count(const PlayedFrame& frame, RunSummary& summary) {
    const fabric::FrameStatistics& statistics = frame.statistics;
    summary.pagesLoaded += statistics.pagesLoaded;
    summary.bytesLoaded += statistics.bytesLoaded;
    summary.bytesLoadedFirstPass += frame.pass == 0 ? statistics.bytesLoaded : 0;
    summary.tauAchievedMax = std::max(summary.tauAchievedMax, statistics.tauAchievedPixels);
    summary.normalErrorDegreesMax =
        std::max(summary.normalErrorDegreesMax, statistics.normalErrorDegrees);
    summary.normalErrorMeanDegreesMax =
        std::max(summary.normalErrorMeanDegreesMax, statistics.normalErrorMeanDegrees);
    summary.framesBeyond += isBeyondTau(frame) ? 1 : 0;
    summary.framesEmpty += frame.showsSomething ? 0 : 1;
    summary.framesSmaller += isSmaller(frame) ? 1 : 0;
    summary.stretchMax = std::max(summary.stretchMax, frame.stretch);
}

/// Of the line through both, logarithms on both axes. Precondition: the errors differ.
double trianglesBetween(const UniformLevel& a, const UniformLevel& b, double p99Pixels,
                        double UniformLevel::*count) {
    const double share = std::log(p99Pixels / a.p99Pixels) / std::log(b.p99Pixels / a.p99Pixels);
    return a.*count * std::pow(b.*count / (a.*count), share);
}

}  // namespace

double quantile(std::vector<double> values, double q) {
    if (values.empty())
        return std::numeric_limits<double>::quiet_NaN();
    const double rank = std::ceil(q * static_cast<double>(values.size()));
    const auto at = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

Percentiles percentiles(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.95), quantile(values, 0.99),
            quantile(values, 1)};
}

RunSummary summarize(const Played& played) {
    RunSummary summary;
    const Passes measured = passesOf(played, false);
    summary.frame = percentiles(column(played, false, taken));
    summary.frame.p50 = medianTime(measured, played.framesInFlight);
    summary.latency = percentiles(column(played, false, latency));
    summary.firstPass = percentiles(column(played, true, taken));
    summary.firstPass.p50 = medianTime(passesOf(played, true), played.framesInFlight);
    summary.fpsMedian = 1000 / summary.frame.p50;
    summary.tauAchieved = percentiles(column(played, false, promised));
    summary.withinBudget = shareWithinBudget(played);
    fabric::StageMilliseconds& stages = summary.stages;
    stages.cull = median(played, [](auto& f) { return f.statistics.milliseconds.cull; });
    stages.draw = median(played, [](auto& f) { return f.statistics.milliseconds.draw; });
    stages.readback = median(played, [](auto& f) { return f.statistics.milliseconds.readback; });
    stages.encode = median(played, [](auto& f) { return f.statistics.milliseconds.encode; });
    stages.total = summary.latency.p50;
    stages.vertices = median(played.stages, &fabric::StageMilliseconds::vertices);
    stages.fill = median(played.stages, &fabric::StageMilliseconds::fill);
    summary.means = meansOf(played);
    summary.passes = ofEachPass(measured, played.framesInFlight);
    summary.trianglesMean = mean(played, triangles);
    summary.pointsMean = mean(played, points);
    for (const PlayedFrame& frame : played.frames) count(frame, summary);
    return summary;
}

ErrorSummary summarize(const MeasuredErrors& measured) {
    ErrorSummary summary;
    summary.judged = measured.frames.size();
    summary.psnrDb = std::numeric_limits<double>::infinity();
    std::vector<double> medians;
    for (const FrameError& frame : measured.frames) {
        if (isEmpty(frame))
            continue;
        ++summary.frames;
        if (frame.compared > 0)
            medians.push_back(frame.p50Pixels);
        summary.p99Pixels = std::max(summary.p99Pixels, frame.p99Pixels);
        summary.maxPixels = std::max(summary.maxPixels, frame.maxPixels);
        summary.promisedPixels = std::max(summary.promisedPixels, frame.promisedPixels);
        summary.roundedPixels = std::max(summary.roundedPixels, kRasterPixels * frame.stretch);
        summary.holes += frame.holes;
        summary.falseHits += frame.falseHits;
        summary.misplaced += frame.misplaced;
        summary.silhouettePixels = std::max(summary.silhouettePixels, frame.silhouettePixels);
        summary.psnrDb = std::min(summary.psnrDb, frame.psnrDb);
        summary.ssim = std::min(summary.ssim, frame.ssim);
        summary.flip = std::max(summary.flip, frame.flip);
        summary.withinPromise = summary.withinPromise && keepsPromise(frame);
        summary.trianglesMean += static_cast<double>(frame.triangles);
    }
    summary.trianglesMean /= static_cast<double>(std::max<std::uint64_t>(summary.frames, 1));
    summary.p50Pixels = quantile(std::move(medians), 0.5);
    return summary;
}

std::optional<double> efficiency(const std::vector<UniformLevel>& levels, double p99Pixels,
                                 double triangles, double UniformLevel::*count) {
    for (std::size_t i = 1; i < levels.size() && triangles > 0; ++i) {
        const auto [fine, coarse] = std::minmax(
            levels[i - 1], levels[i], [](auto& a, auto& b) { return a.p99Pixels < b.p99Pixels; });
        if (fine.p99Pixels > 0 && fine.p99Pixels < coarse.p99Pixels &&
            p99Pixels >= fine.p99Pixels && p99Pixels <= coarse.p99Pixels)
            return trianglesBetween(fine, coarse, p99Pixels, count) / triangles;
    }
    return std::nullopt;
}

std::string whyNoEfficiency(const std::vector<UniformLevel>& levels, double p99Pixels,
                            double triangles) {
    if (efficiency(levels, p99Pixels, triangles))
        return "";
    if (levels.empty())
        return "no uniform level has an error";
    const auto byError = [](const UniformLevel& a, const UniformLevel& b) {
        return a.p99Pixels < b.p99Pixels;
    };
    const auto [finest, coarsest] = std::ranges::minmax_element(levels, byError);
    if (p99Pixels < finest->p99Pixels)
        return "finer than the finest uniform level";
    return p99Pixels > coarsest->p99Pixels ? "coarser than the coarsest uniform level"
                                           : "nothing was drawn";
}

}  // namespace eyrie::cli::bench
