// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <absl/status/status.h>

#include "cli/bench/play.h"

/// What a bench leaves: summary.json, frames.csv and index.html, which shows both.
namespace eyrie::cli::bench {

/// A flight played at one tau, or at one frame time.
struct BenchRun {
    double tauPixels = 0;
    Played played;
    double budgetMilliseconds = 0;  ///< 0: tau was kept
};

struct BenchFacts {
    std::string scene;
    std::string flight;
    int width = 0;
    int height = 0;
    int frames = 0;
    int repeats = 0;
    int renderers = 0;     ///< 0: in one process
    std::string compound;  ///< "2D" or "DB"
};

/// {"machine": {...}, "bench": {...}, "runs": [...]} in the terms of docs/benchmarks.md.
std::string summaryJson(const BenchFacts& facts, const std::vector<BenchRun>& runs);

/// A line a frame, the first passes' included.
std::string framesCsv(const std::vector<BenchRun>& runs);

/// A page that needs no other file and no network.
std::string reportPage(const BenchFacts& facts, const std::vector<BenchRun>& runs);

/// A line a tau, for a terminal.
std::string table(const std::vector<BenchRun>& runs);

/// Writes all three into `folder`, which is made where there is none. Errors: those of
/// fabric::writeError.
absl::Status writeReport(const BenchFacts& facts, const std::vector<BenchRun>& runs,
                         const std::string& folder);

}  // namespace eyrie::cli::bench
