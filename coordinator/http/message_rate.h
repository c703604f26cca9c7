// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace eyrie::http {

/// How fast one viewer's messages are taken: `perSecond` of them, and as many at once after a
/// second of silence. Who sends more waits; nobody is cut off for it.
class MessageRate {
public:
    using Clock = std::chrono::steady_clock;

    explicit MessageRate(int perSecond) : perSecond_(perSecond) {}

    /// Counts a message that came at `now`, and says how long to wait before reading the next.
    Clock::duration take(Clock::time_point now) {
        const auto interval = std::chrono::duration_cast<Clock::duration>(std::chrono::seconds(1)) /
                              std::max(1, perSecond_);
        due_ = std::max(due_, now - std::chrono::seconds(1)) + interval;
        return std::max(due_ - now, Clock::duration::zero());
    }

private:
    const int perSecond_;
    Clock::time_point due_{};  ///< when as many would have come at an even pace
};

}  // namespace eyrie::http
