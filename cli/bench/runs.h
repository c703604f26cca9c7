// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/bench/flights.h"
#include "cli/bench/frame_error.h"
#include "cli/bench/play.h"
#include "cli/picture_source.h"
#include "cli/progress_bar.h"

/// A bench is runs: the same flight at each error, drawn by each number of processes.
namespace eyrie::cli::bench {

/// A flight played once over.
struct BenchRun {
    std::string label;  ///< what was asked for, as a person says it: "1 px"
    double tauPixels = 0;
    int renderers = 0;  ///< processes that drew; 0: the bench's own
    std::string
        compound;  ///< how they share the frame: --compound or a configuration; empty for one
    Played played;
    std::optional<MeasuredErrors> measured = {};  ///< where a reference was asked for
    double budgetMilliseconds = 0;                ///< a frame time to hold; 0: tau was kept
    std::string flightNote = {};                  ///< what had to be assumed of it, or empty
    std::string sizeNote = {};                    ///< coordinator::noteOfSize of the scene
    std::uint64_t sceneHash = 0;                  ///< BenchFacts::sceneHash
};

/// Who drew a run, as a person says it: "one process", "1 renderer", "2 renderers, DB".
std::string drawnBy(int renderers, const std::string& compound);

/// Of all frames of a run.
struct Asked {
    double tauPixels = 1;
    double budgetMilliseconds = 0;  ///< a frame time to hold, for which tau may rise; 0: none
};

struct RunPlan {
    std::string scene;
    NamedFlight flight;
    std::vector<Asked> asked;
    std::vector<int> renderers{0};
    PlayOptions play;  ///< tau, budget and what is kept are each run's own
    PictureSourceOptions pictures;
    bool progressJson = false;  ///< tell progress as JSON, quiet or not
    /// PlayOptions::keeps of runs that hold a frame time.
    std::vector<int> keeps = {};
};

/// How progress of what is done for these runs is shown.
ProgressBar::Style progressStyle(const RunPlan& plan);

/// Plays all runs, one after another, each with renderers of its own that have loaded nothing yet:
/// what a run says does not depend on those before it. Shows progress on standard error. Errors:
/// those of PictureSource::open, NamedFlight::over and play, these with the flight's name.
absl::StatusOr<std::vector<BenchRun>> playRuns(const RunPlan& plan, const std::stop_token& stop);

}  // namespace eyrie::cli::bench
