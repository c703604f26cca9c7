// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "cli/bench/play.h"

namespace eyrie::cli::bench {

/// The value below which a share `q` (0 to 1) of `values` lies, by nearest rank; NaN of none.
double quantile(std::vector<double> values, double q);

struct Percentiles {
    double p50 = 0;
    double p95 = 0;
    double p99 = 0;
    double max = 0;
};

Percentiles percentiles(const std::vector<double>& values);

/// What is said of a flight played at one tau. Milliseconds.
struct RunSummary {
    Percentiles frame;                 ///< of the measured passes
    Percentiles firstPass;             ///< of the pass that loads
    fabric::StageMilliseconds stages;  ///< medians; fabric::limitingStage names the longest
    double fpsMedian = 0;
    double trianglesMean = 0;
    std::uint64_t pagesLoaded = 0;
    std::uint64_t bytesLoaded = 0;   ///< as stored
    double tauAchievedMax = 0;       ///< the error promised for every frame, pixels
    std::uint64_t framesBeyond = 0;  ///< that promise more than was asked, and say so
    Percentiles tauAchieved;         ///< of the measured passes, pixels
    /// Share of the frames, from the end of the first second of drawing on, that took no longer
    /// than 1.2 times the frame time to hold; NaN where there was none.
    double withinBudget = 0;
};

RunSummary summarize(const Played& played);

}  // namespace eyrie::cli::bench
