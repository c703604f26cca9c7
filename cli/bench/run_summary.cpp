// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/run_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

double taken(const PlayedFrame& frame) { return frame.milliseconds; }

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
    summary.frame = percentiles(column(played, false, taken));
    summary.firstPass = percentiles(column(played, true, taken));
    summary.fpsMedian = 1000 / summary.frame.p50;
    summary.tauAchieved = percentiles(
        column(played, false, [](const PlayedFrame& f) { return f.statistics.tauAchievedPixels; }));
    summary.withinBudget = shareWithinBudget(played);
    fabric::StageMilliseconds& stages = summary.stages;
    stages.cull = median(played, [](auto& f) { return f.statistics.milliseconds.cull; });
    stages.draw = median(played, [](auto& f) { return f.statistics.milliseconds.draw; });
    stages.readback = median(played, [](auto& f) { return f.statistics.milliseconds.readback; });
    stages.encode = median(played, [](auto& f) { return f.statistics.milliseconds.encode; });
    stages.total = summary.frame.p50;
    stages.vertices = median(played.stages, &fabric::StageMilliseconds::vertices);
    stages.fill = median(played.stages, &fabric::StageMilliseconds::fill);
    for (const PlayedFrame& frame : played.frames) {
        const fabric::FrameStatistics& statistics = frame.statistics;
        summary.pagesLoaded += statistics.pagesLoaded;
        summary.bytesLoaded += statistics.bytesLoaded;
        summary.tauAchievedMax = std::max(summary.tauAchievedMax, statistics.tauAchievedPixels);
        summary.framesBeyond += statistics.tauAchievedPixels > statistics.tauAskedPixels ? 1 : 0;
        summary.trianglesMean +=
            static_cast<double>(statistics.triangles) / static_cast<double>(played.frames.size());
    }
    return summary;
}

}  // namespace eyrie::cli::bench
