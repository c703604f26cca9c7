// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/frame/call_timeouts.h"
#include "coordinator/frame/composed_frame.h"
#include "coordinator/frame/crew.h"
#include "coordinator/frame/patience.h"
#include "coordinator/frame/planned_frame.h"
#include "coordinator/frame/program_rest.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::coordinator {

/// Draws frames by programs: renderers put together among themselves what the coordinator need not
/// see. All functions may be called from any thread.
class ProgramDrawing {
public:
    using Clock = std::chrono::steady_clock;

    struct Options {
        PatienceOptions patience;
        CallTimeouts callTimeouts;                     ///< of what is drawn beside the programs
        std::function<void()> freed;                   ///< Dispatch::Plan::freed
        observe::SharedTelemetry telemetry = nullptr;  ///< is told how long it takes
    };

    /// `crew` outlives it.
    ProgramDrawing(const Options& options, Crew& crew);

    /// Whether a frame that has programs is to be drawn so: renderers may be dying when one has
    /// just failed, and all have to reach those whom they send pictures.
    bool mayDraw(const PlannedFrame& frame);

    /// Precondition: `frame` has programs. Whatever it fails with, the frame can be drawn without.
    /// `handedOut` is called when the renderers have been given them.
    absl::StatusOr<DrawnFrame> draw(const PlannedFrame& frame,
                                    const std::function<void()>& handedOut);

    /// A frame whose programs were not done in time was drawn by the coordinator in `taken`. Of the
    /// programs nothing is known: they may never have come to an end.
    void drawnWithout(std::uint64_t kind, std::chrono::milliseconds taken);

    /// How long frames of `kind` may take, where that is known: what renderers did among themselves
    /// took as long as what they do for the coordinator will.
    std::chrono::milliseconds patienceWith(std::uint64_t kind) const;

private:
    bool allReachEachOther(const PlannedFrame& frame);
    std::vector<std::string> addressesOf(const PlannedFrame& frame) const;
    absl::StatusOr<DrawnFrame> tryToDraw(const PlannedFrame& frame,
                                         const std::function<void()>& handedOut);
    std::uint64_t sessionOf(std::uint64_t revision);

    const Options options_;
    Crew& crew_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::uint64_t revision_ = 0;
    std::uint64_t session_ = 0;  ///< of the scene of that revision: other coordinators have others
    Patience patience_;
    ProgramRest rest_;
    std::set<std::string> told_;  ///< addresses that others do not reach, of which the log has
};

}  // namespace eyrie::coordinator
