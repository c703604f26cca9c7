// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

namespace eyrie::cli {

/// When to start a process again that has ended: after a pause that doubles from failure to
/// failure, and not more than kMaxPerMinute times a minute, so that one which cannot work does not
/// keep the machine busy. One that lived for kWorked has worked: its end is a first one. Time comes
/// in as a parameter.
class RestartPolicy {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kMaxPerMinute = 6;
    static constexpr std::chrono::milliseconds kFirstPause{250};
    static constexpr std::chrono::milliseconds kLongestPause{10'000};
    static constexpr std::chrono::milliseconds kWorked{10'000};

    /// The process, which started at `started`, ended now. Returns when it may start again.
    Clock::time_point ended(Clock::time_point started, Clock::time_point now);

private:
    std::deque<Clock::time_point> starts_;  ///< granted within the last minute, or to come
    /// When one that had worked ended.
    Clock::time_point worked_ = Clock::time_point::min();
};

}  // namespace eyrie::cli
