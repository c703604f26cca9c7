// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/observe/telemetry.h"

namespace eyrie::observe {

/// Times a stage of the coordinator's own work, from its construction to its end, for the metrics
/// and the trace.
class StageTimer {
public:
    /// `telemetry` outlives the timer; null: nothing is told. `thread` as in Span.
    StageTimer(Telemetry* telemetry, Stage stage, std::string thread = "frames",
               std::uint64_t frame = 0)
        : telemetry_(telemetry), stage_(stage), thread_(std::move(thread)), frame_(frame) {}
    ~StageTimer() { stop(); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

    /// Of which frame it was, where that is known only later.
    void setFrame(std::uint64_t frame) { frame_ = frame; }
    /// Ends it before its time; nothing is told twice.
    void stop();

private:
    Telemetry* telemetry_;
    const Stage stage_;
    const std::string thread_;
    std::uint64_t frame_;
    const Clock::time_point begin_ = Clock::now();
};

}  // namespace eyrie::observe
