// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace eyrie::stream {

using Clock = std::chrono::steady_clock;

/// Decides how many frames may be under way (rendered, encoded, sent or decoded, but not yet
/// acknowledged) to one browser: enough to keep the slowest stage busy, because every frame more is
/// only delay.
///
///   window = ceil(loop / stage - 1/4), from 2 to 4
///
/// `loop` is the shortest time lately from starting a frame to its acknowledgement, `stage` the
/// time of the slowest stage, link and browser included: the larger of the last render time and the
/// shortest time lately between two acknowledgements. A quarter of a frame's idling is accepted
/// before another frame is let in. On loopback this is 2; at 50 ms of round trip and 30 ms a frame
/// it is 4. Not thread-safe.
class Pacer {
public:
    /// `fixedWindow`, 1 or more, replaces the rule.
    explicit Pacer(std::optional<int> fixedWindow = std::nullopt) : fixedWindow_(fixedWindow) {}

    /// Frame numbers ascend. `measures` is false for frames that were not started at once, such as
    /// the still picture.
    void sent(std::uint64_t frameNumber, Clock::time_point started, bool measures);

    /// Acknowledges `frameNumber` and all before it; a number that was not sent changes nothing.
    void acknowledged(std::uint64_t frameNumber, Clock::time_point now);

    /// What is left of `frameNumber` will not be sent.
    void withdrawn(std::uint64_t frameNumber);

    void rendered(Clock::duration time) { renderTime_ = time; }

    int window() const;
    int unacknowledged() const { return static_cast<int>(inFlight_.size()); }

private:
    struct InFlight {
        std::uint64_t frameNumber = 0;
        Clock::time_point started;
        bool measures = true;
    };
    using Recent = std::deque<Clock::duration>;

    std::optional<int> fixedWindow_;
    std::deque<InFlight> inFlight_;
    Recent loops_;
    Recent spacings_;
    std::optional<Clock::time_point> lastAcknowledged_;
    Clock::duration renderTime_{0};
};

}  // namespace eyrie::stream
