// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace eyrie::coordinator {

/// When a renderer is asked once more to open a scene whose data could not be had, or took too
/// long: after a pause that doubles from failure to failure.
class OpenRetry {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kFirstPause{1};
    static constexpr std::chrono::seconds kLongestPause{30};

    void noteFailure(Clock::time_point now) {
        at_ = now + pause_;
        pause_ = std::min(2 * pause_, kLongestPause);
    }

    /// True once after each failure, when its pause is over.
    bool takeTurn(Clock::time_point now) {
        if (!at_ || now < *at_)
            return false;
        at_.reset();
        return true;
    }

private:
    std::optional<Clock::time_point> at_;
    std::chrono::seconds pause_ = kFirstPause;
};

}  // namespace eyrie::coordinator
