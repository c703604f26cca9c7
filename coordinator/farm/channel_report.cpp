// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/channel_report.h"

#include <algorithm>
#include <utility>

#include "eyrie/v1/render_service.pb.h"

namespace eyrie::coordinator {
namespace {

using observe::Clock;
using std::chrono::nanoseconds;

nanoseconds ofMilliseconds(double milliseconds) {
    return std::chrono::duration_cast<nanoseconds>(
        std::chrono::duration<double, std::milli>(std::clamp(milliseconds, 0.0, 1e9)));
}

/// In the order that ChannelTimes promises.
bool isInOrder(const v1::ChannelTimes& times) {
    return 0 <= times.received() && times.received() <= times.begun() &&
           times.begun() <= times.drawn() && times.drawn() <= times.sent();
}

}  // namespace

ReportedRenderer::ReportedRenderer(const std::string& address, observe::SharedTelemetry telemetry)
    : address_(address), name_(observe::rendererName(address)), telemetry_(std::move(telemetry)) {}

std::optional<observe::ClockMap::Offset> ReportedRenderer::note(const observe::Exchange& exchange) {
    const std::lock_guard lock(mutex_);
    return clock_.note(exchange);
}

void ReportedRenderer::holds(const v1::RendererMemory& memory) const {
    telemetry_->metrics.rendererHolds(address_, memory.device_bytes(), memory.host_bytes());
}

ChannelReport::ChannelReport(ReportedRenderer& renderer, std::uint64_t frame)
    : renderer_(renderer), frame_(frame), asked_(Clock::now()) {}

void ChannelReport::headerCame(const v1::ChannelHeader& header) {
    header_ = Clock::now();
    if (renderer_.telemetry() == nullptr)
        return;
    observe::Metrics& metrics = renderer_.telemetry()->metrics;
    metrics.pictureCame(header.is_in_memory());
    if (header.has_memory())
        renderer_.holds(header.memory());
    const v1::ChannelTimes& times = header.times();
    if (!header.has_times() || !isInOrder(times))
        return;
    const auto& stages = header.statistics().milliseconds();
    const There there{nanoseconds(times.received()),    nanoseconds(times.begun()),
                      nanoseconds(times.drawn()),       nanoseconds(times.sent()),
                      ofMilliseconds(stages.cull()),    ofMilliseconds(stages.draw()),
                      ofMilliseconds(stages.readback())};
    if (const auto offset = renderer_.note({asked_, there.received, there.sent, *header_}))
        tellThere(there, *offset);
}

/// The stages come one after the other from when drawing begins; what a stage does later counts as
/// if it came with the rest of it.
void ChannelReport::tellThere(const There& there, const observe::ClockMap::Offset& offset) {
    const auto tell = [&](const char* name, nanoseconds begin, nanoseconds end) {
        renderer_.telemetry()->traces.add({renderer_.name(), "channels", name, frame_,
                                           offset.here(begin), offset.here(std::max(begin, end)),
                                           offset.bound});
    };
    tell("channel", there.received, there.sent);
    tell("queue", there.received, there.begun);
    tell("render", there.begun, there.drawn);
    nanoseconds at = there.begun;
    for (const auto& [name, time] : {std::pair("cull", there.cull), std::pair("draw", there.draw),
                                     std::pair("readback", there.readback)}) {
        const nanoseconds end = std::min(at + time, there.drawn);
        tell(name, at, end);
        at = end;
    }
}

void ChannelReport::ended(const absl::Status& status) {
    const observe::SharedTelemetry& telemetry = renderer_.telemetry();
    if (telemetry == nullptr)
        return;
    const Clock::time_point now = Clock::now();
    const std::string thread = "asks " + renderer_.name();
    observe::Span call{"coordinator", thread, "channel", frame_, asked_, now};
    if (!status.ok())
        call.note = absl::StatusCodeToString(status.code());
    telemetry->traces.add(std::move(call));
    if (header_) {
        telemetry->metrics.took(observe::Stage::Receive, now - *header_);
        telemetry->traces.add({"coordinator", thread, "receive", frame_, *header_, now});
    }
    telemetry->metrics.bytes(observe::Peer::Renderer, observe::Direction::In, bytes_);
}

void ProgramReport::pictureCame() const {
    if (renderer_.telemetry() != nullptr)
        renderer_.telemetry()->metrics.pictureCame(false);
}

void ProgramReport::statisticsCame(const v1::ProgramStatistics& statistics) const {
    if (renderer_.telemetry() != nullptr && statistics.has_memory())
        renderer_.holds(statistics.memory());
}

void ProgramReport::ended() const {
    if (renderer_.telemetry() != nullptr)
        renderer_.telemetry()->metrics.bytes(observe::Peer::Renderer, observe::Direction::In,
                                             bytes_);
}

}  // namespace eyrie::coordinator
