// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <absl/status/status.h>

#include "coordinator/observe/clock_map.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::v1 {
class ChannelHeader;
}

namespace eyrie::coordinator {

/// Tells of the channels that one renderer draws: where their time goes, there and on the way, on
/// this process's clock, and what the renderer holds. For one thread at a time.
class ChannelReport {
public:
    /// Of the renderer at `address`. Without telemetry it tells nothing.
    ChannelReport(const std::string& address, observe::SharedTelemetry telemetry);

    /// The call is about to be made.
    void asked(std::uint64_t frame);
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

    const std::string name_;
    const observe::SharedTelemetry telemetry_;
    observe::ClockMap clock_;
    std::uint64_t frame_ = 0;
    observe::Clock::time_point asked_;
    std::optional<observe::Clock::time_point> header_;
    std::size_t bytes_ = 0;
};

}  // namespace eyrie::coordinator
