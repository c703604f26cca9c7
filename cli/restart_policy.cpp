// SPDX-License-Identifier: Apache-2.0
#include "cli/restart_policy.h"

#include <algorithm>

namespace eyrie::cli {

RestartPolicy::Clock::time_point RestartPolicy::ended(Clock::time_point started,
                                                      Clock::time_point now) {
    constexpr std::chrono::minutes kMinute{1};
    if (now - started >= kWorked)
        worked_ = now;
    while (!starts_.empty() && starts_.front() <= now - kMinute) starts_.pop_front();
    const auto failures =
        std::count_if(starts_.begin(), starts_.end(),
                      [this](Clock::time_point start) { return start > worked_; });
    Clock::time_point next = now + std::min(kLongestPause, kFirstPause * (1 << failures));
    if (starts_.size() >= kMaxPerMinute)
        next = std::max(next, starts_[starts_.size() - kMaxPerMinute] + kMinute);
    starts_.push_back(next);
    return next;
}

}  // namespace eyrie::cli
