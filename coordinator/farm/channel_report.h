// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include <absl/status/status.h>

#include "coordinator/observe/clock_map.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::v1 {
class ChannelHeader;
class ProgramStatistics;
class RendererMemory;
}  // namespace eyrie::v1

namespace eyrie::coordinator {

/// Whom the channels of one renderer are told to, and its clock. Thread-safe.
class ReportedRenderer {
public:
    /// The renderer at `address`. Without telemetry nothing is told.
    ReportedRenderer(const std::string& address, observe::SharedTelemetry telemetry);

    const std::string& name() const { return name_; }
    const observe::SharedTelemetry& telemetry() const { return telemetry_; }
    std::optional<observe::ClockMap::Offset> note(const observe::Exchange& exchange);
    /// Precondition: there is telemetry.
    void holds(const v1::RendererMemory& memory) const;

private:
    const std::string address_;
    const std::string name_;  ///< in traces
    const observe::SharedTelemetry telemetry_;
    std::mutex mutex_;  ///< guards clock_
    observe::ClockMap clock_;
};

/// Tells of one channel that a renderer draws: where its time goes, there and on the way, on this
/// process's clock, and what the renderer holds.
class ChannelReport {
public:
    /// The call is about to be made. `renderer` outlives this.
    ChannelReport(ReportedRenderer& renderer, std::uint64_t frame);

    void headerCame(const v1::ChannelHeader& header);
    void chunkCame(std::size_t bytes) { bytes_ += bytes; }
    /// The call has ended.
    void ended(const absl::Status& status);

private:
    /// Of the renderer's own clock; what it says of itself counts only where it fits the call.
    struct There {
        std::chrono::nanoseconds received{};
        std::chrono::nanoseconds begun{};
        std::chrono::nanoseconds drawn{};
        std::chrono::nanoseconds sent{};
        std::chrono::nanoseconds cull{};
        std::chrono::nanoseconds draw{};
        std::chrono::nanoseconds readback{};
    };

    void tellThere(const There& there, const observe::ClockMap::Offset& offset);

    ReportedRenderer& renderer_;
    const std::uint64_t frame_;
    const observe::Clock::time_point asked_;
    std::optional<observe::Clock::time_point> header_;
    std::size_t bytes_ = 0;
};

/// Tells of one program that a renderer carries out: what comes of it, and what the renderer holds.
class ProgramReport {
public:
    /// `renderer` outlives this.
    explicit ProgramReport(const ReportedRenderer& renderer) : renderer_(renderer) {}

    void pictureCame() const;
    void chunkCame(std::size_t bytes) { bytes_ += bytes; }
    void statisticsCame(const v1::ProgramStatistics& statistics) const;
    /// The call has ended.
    void ended() const;

private:
    const ReportedRenderer& renderer_;
    std::size_t bytes_ = 0;
};

}  // namespace eyrie::coordinator
