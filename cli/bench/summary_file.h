// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/bench/run_summary.h"

/// A report that was written before, read back.
namespace eyrie::cli::bench {

/// Of a run, what can be laid beside another's. Bounds may be infinite.
struct WrittenRun {
    std::string label;
    double tauPixels = 0;
    int renderers = 0;
    std::string compound;
    int framesInFlight = 1;
    Percentiles frame;
    std::vector<PassSummary> passes;
    /// Whether these have errors, triangles and points: reports of before have 0 for them.
    bool passesTellDrawn = true;
    double firstPassMedian = 0;
    double trianglesMean = 0;
    double pointsMean = 0;
    double tauAchievedMax = 0;
    double budgetMilliseconds = 0;  ///< the frame time that was to be held; 0: none
    Percentiles tauAchieved;        ///< where there was one
    double framesBeyond = 0;
    double bytesLoaded = 0;
    double peakResidentBytes = 0;
    std::optional<double> errorP99;  ///< pixels, where they were measured
    std::optional<double> errorMax;
    std::optional<int> framesJudged;  ///< for these; none where a report is from before it was told
};

struct WrittenReport {
    std::string name;  ///< as it was asked for
    std::string scene;
    std::string flight;
    int width = 0;
    int height = 0;
    int frames = 0;
    std::string processor;
    int cores = 0;
    std::string device;
    std::string driver;
    std::string command;
    std::string occlusion;
    std::optional<std::string> seen;  ///< BenchFacts'; nothing in reports of before it was told
    std::string flightHash;           ///< likewise, empty
    std::string sceneHash;            ///< likewise
    std::string configurationHash;    ///< likewise
    std::vector<WrittenRun> runs;
};

/// Whether a file is there and of a report, this build's or another's.
bool isSummary(const std::string& file);

/// `path` is a report's folder or its summary.json. Errors: those of readText; InvalidArgument,
/// naming file and field, where it is no summary, lacks a figure or has one that cannot be.
absl::StatusOr<WrittenReport> readReport(const std::string& path);

}  // namespace eyrie::cli::bench
