// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "cli/bench/flight_judge.h"
#include "cli/bench/reference_sources.h"
#include "cli/picture_source.h"

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
};

/// Finds the sources, before a flight is played for minutes. Errors: those of loadScene and
/// findSources; InvalidArgument: --reference-memory, or an option that needs --reference.
absl::StatusOr<ReferencePlan> planReference(const std::string& scene,
                                            const PictureSourceOptions& pictures,
                                            const ReferenceOptions& options,
                                            const std::stop_token& stop);

/// Reads the sources. Errors: those of readSources.
absl::StatusOr<FlightJudge> judgeFor(const ReferencePlan& plan, const fabric::Flight& flight,
                                     const JudgedFrames& frames);

/// Internal, naming the worst frame of all, where one is farther off than it promised: the bound
/// is wrong, or the drawing.
absl::Status checkPromise(double tauPixels, const MeasuredErrors& measured);

}  // namespace eyrie::cli::bench
