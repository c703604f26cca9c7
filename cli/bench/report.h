// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "cli/bench/runs.h"

/// What a bench leaves: summary.json, frames.csv, errors.csv where a reference was asked for, and
/// index.html, which shows them.
namespace eyrie::cli::bench {

struct BenchFacts {
    std::string scene;
    std::string flight;
    int width = 0;
    int height = 0;
    int frames = 0;
    int repeats = 0;
    std::string command;             ///< that does it again
    std::string occlusion = "auto";  ///< as it was asked for
    std::string seen = {};           ///< which screen, in options' words; empty: the one there is
    std::uint64_t flightHash = 0;    ///< NamedFlight::hash
    std::uint64_t sceneHash = 0;     ///< of the data's contents, and of where they stand
    std::uint64_t configurationHash = 0;  ///< cli::configurationHash
};

struct Report {
    BenchFacts facts;
    std::vector<BenchRun> runs;
    std::vector<UniformLevel> uniform = {};  ///< of the same flight, where it was measured
};

/// {"machine": {...}, "bench": {...}, "runs": [...]} in the terms of docs/benchmarks.md.
std::string summaryJson(const Report& report);

/// A line a frame, the first passes' included.
std::string framesCsv(const std::vector<BenchRun>& runs);

/// A page that needs no other file and no network.
std::string reportPage(const Report& report);

/// A line a run, for a terminal.
std::string table(const std::vector<BenchRun>& runs);

/// Whether writeReport() into `folder` would do, and replace nothing but an earlier report;
/// measuring takes long. Errors: as checkFolder(); InvalidArgument (a file of that name is
/// another's).
absl::Status checkReportFolder(const std::string& folder);

/// Writes all three, and errors.csv where something was measured, into `folder`, which is made
/// where there is none; an errors.csv of an earlier report goes. Where there is no room for all of
/// them, what was there stays. Errors: those of fabric::writeError.
absl::Status writeReport(const Report& report, const std::string& folder);

}  // namespace eyrie::cli::bench
