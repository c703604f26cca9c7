// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/pacer.h"

#include <algorithm>
#include <cmath>

namespace eyrie::stream {
namespace {

constexpr std::size_t kRemembered = 32;
constexpr int kMinWindow = 2;
constexpr int kMaxWindow = 4;

void remember(std::deque<Clock::duration>& recent, Clock::duration value) {
    recent.push_back(value);
    if (recent.size() > kRemembered)
        recent.pop_front();
}

}  // namespace

void Pacer::sent(std::uint64_t frameNumber, Clock::time_point started, bool measures) {
    inFlight_.push_back({frameNumber, started, measures});
}

void Pacer::acknowledged(std::uint64_t frameNumber, Clock::time_point now) {
    if (inFlight_.empty() || frameNumber < inFlight_.front().frameNumber ||
        frameNumber > inFlight_.back().frameNumber)
        return;
    while (inFlight_.front().frameNumber < frameNumber) inFlight_.pop_front();
    if (inFlight_.front().frameNumber != frameNumber)
        return;  // it was withdrawn
    const InFlight frame = inFlight_.front();
    inFlight_.pop_front();
    // Only a frame that was under way beside the one before it tells the pace of the stages.
    const bool overlapped = lastAcknowledged_.has_value() && frame.started < *lastAcknowledged_;
    if (frame.measures) {
        remember(loops_, now - frame.started);
        if (overlapped)
            remember(spacings_, now - *lastAcknowledged_);
    }
    lastAcknowledged_ = now;
}

void Pacer::withdrawn(std::uint64_t frameNumber) {
    std::erase_if(inFlight_, [=](const InFlight& one) { return one.frameNumber == frameNumber; });
}

int Pacer::window() const {
    if (fixedWindow_.has_value())
        return *fixedWindow_;
    if (loops_.empty() || spacings_.empty())
        return kMinWindow;
    const Clock::duration loop = *std::min_element(loops_.begin(), loops_.end());
    const Clock::duration stage =
        std::max({renderTime_, *std::min_element(spacings_.begin(), spacings_.end()),
                  Clock::duration(std::chrono::milliseconds(1))});
    const double frames =
        std::chrono::duration<double>(loop) / std::chrono::duration<double>(stage);
    return static_cast<int>(
        std::clamp(std::ceil(frames - 0.25), double{kMinWindow}, double{kMaxWindow}));
}

}  // namespace eyrie::stream
