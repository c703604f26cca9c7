// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "cli/bench/flight_judge.h"
#include "cli/bench/reference_sources.h"
#include "cli/bench/runs.h"

/// `eyrie bench --reference`: holding what was drawn against the full-resolution source.
namespace eyrie::cli::bench {

struct ReferenceOptions {
    bool isAsked = false;
    std::vector<std::string> sources;  ///< where the imports' records are not right
    std::string memory;                ///< empty: kShareOfMemory of what is free
    int frames = JudgedFrames{}.judged;
};

inline constexpr double kShareOfMemory = 0.7;

void addReferenceOptions(CLI::App& command, ReferenceOptions& options);

/// A scene, and the sources that were found for it.
struct ReferencePlan {
    fabric::Scene scene;
    std::vector<FoundSource> sources;
    page::SourceOptions remote;
    JudgedFrames frames;      ///< of each run
    std::vector<int> judged;  ///< these: RunPlan::keeps
};

/// Finds the sources, before flights are played for minutes. Errors: those of loadScene and
/// findSources; InvalidArgument: --reference-memory.
absl::StatusOr<ReferencePlan> planReference(const RunPlan& plan, const ReferenceOptions& options,
                                            const std::stop_token& stop);

/// Reads the sources, draws some of the frames of each run again or, where a frame time was held,
/// takes the pictures that the run has kept of them; fills in what is measured of them, and gives
/// the uniform levels to compare with. After all runs were played: the sources take memory. Shows
/// progress on standard error. Errors: those of readSources, PictureSource::open and
/// FlightJudge::judge; FailedPrecondition where no frame shows anything to compare.
absl::StatusOr<std::vector<UniformLevel>> measureRuns(const ReferencePlan& reference,
                                                      const RunPlan& plan,
                                                      std::vector<BenchRun>& runs,
                                                      const std::stop_token& stop);

/// Internal, naming the worst frame of the first such run, where a frame is farther off than it
/// promised: its bound is wrong, or its drawing.
absl::Status checkPromises(const std::vector<BenchRun>& runs);

}  // namespace eyrie::cli::bench
