// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/bench/frame_error.h"
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

/// Of one measured pass: how passes spread is the noise.
struct PassSummary {
    Percentiles frame;     ///< milliseconds, as RunSummary::frame
    double tauP95 = 0;     ///< error that 95 in 100 frames do not promise more than, pixels
    double triangles = 0;  ///< mean
    double points = 0;     ///< mean
};

/// What is said of a flight played at one tau. Milliseconds.
struct RunSummary {
    /// Of the measured passes together; with several frames in flight, which may come in bursts,
    /// p50 is of means over as many in turn.
    Percentiles frame;
    Percentiles latency;               ///< of these, from choosing the view to its picture
    std::vector<PassSummary> passes;   ///< of each measured pass
    Percentiles firstPass;             ///< of the pass that loads
    fabric::StageMilliseconds stages;  ///< medians; fabric::limitingStage names the longest
    /// Means over the measured passes, which add up where medians do not: draw's parts as the
    /// frames with measured stages share it, total the frame's latency.
    fabric::StageMilliseconds means;
    double fpsMedian = 0;
    double trianglesMean = 0;  ///< of the measured passes
    double pointsMean = 0;     ///< of these, drawn in place of triangles
    std::uint64_t pagesLoaded = 0;
    std::uint64_t bytesLoaded = 0;           ///< as stored
    std::uint64_t bytesLoadedFirstPass = 0;  ///< of these
    double tauAchievedMax = 0;               ///< the error promised for every frame, pixels
    std::uint64_t framesBeyond = 0;          ///< that promise more than was asked, and say so
    std::uint64_t framesEmpty = 0;           ///< that show nothing of the scene
    std::uint64_t framesSmaller = 0;         ///< drawn with fewer pixels than were asked for
    double stretchMax = 1;                   ///< of the smallest of them
    /// Of meshes, of the worst frame: fabric::FrameStatistics' of the same names.
    double normalErrorDegreesMax = 0;
    double normalErrorMeanDegreesMax = 0;
    Percentiles tauAchieved;  ///< of the measured passes, pixels
    /// Share of the frames, from the end of the first second of drawing on, that took no longer
    /// than 1.2 times the frame time to hold; NaN where there was none.
    double withinBudget = 0;
};

RunSummary summarize(const Played& played);

/// Of the frames of a flight that were held against the source and are not empty.
struct ErrorSummary {
    std::uint64_t judged = 0;   ///< frames, with those that are empty
    std::uint64_t frames = 0;   ///< of these, that are not
    double p50Pixels = 0;       ///< median of the frames' that show something of the source
    double p99Pixels = 0;       ///< of the worst frame
    double maxPixels = 0;       ///< of the worst frame
    double promisedPixels = 0;  ///< the most that one of them promises
    double roundedPixels = 0;   ///< the most that rasterisation rounds in one
    std::uint64_t holes = 0;
    std::uint64_t falseHits = 0;
    std::uint64_t misplaced = 0;
    double silhouettePixels = 0;  ///< of the worst frame
    double psnrDb = 0;            ///< of the worst frame
    double ssim = 1;              ///< of the worst frame
    double flip = 0;              ///< of the worst frame
    bool withinPromise = true;    ///< all frames do: keepsPromise
    double trianglesMean = 0;     ///< and points
};

/// Precondition: measured.frames is not empty.
ErrorSummary summarize(const MeasuredErrors& measured);

/// How many times as many triangles as `triangles` a level of uniform decimation has, in view or as
/// a whole (`count`), whose pictures are off by `p99Pixels`: between levels log-log; none beyond
/// their ends, where nothing was measured.
std::optional<double> efficiency(const std::vector<UniformLevel>& levels, double p99Pixels,
                                 double triangles,
                                 double UniformLevel::*count = &UniformLevel::triangles);

/// Why efficiency() of these is none, for people; empty where it is one.
std::string whyNoEfficiency(const std::vector<UniformLevel>& levels, double p99Pixels,
                            double triangles);

}  // namespace eyrie::cli::bench
