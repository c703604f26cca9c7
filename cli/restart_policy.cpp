// SPDX-License-Identifier: Apache-2.0
#include "cli/restart_policy.h"

#include <algorithm>

namespace eyrie::cli {

RestartPolicy::Clock::time_point RestartPolicy::ended(Clock::time_point now) {
    constexpr std::chrono::minutes kMinute{1};
    while (!starts_.empty() && starts_.front() <= now - kMinute) starts_.pop_front();
    Clock::time_point next = now + std::min(kLongestPause, kFirstPause * (1 << starts_.size()));
    if (starts_.size() >= kMaxPerMinute)
        next = std::max(next, starts_[starts_.size() - kMaxPerMinute] + kMinute);
    starts_.push_back(next);
    return next;
}

}  // namespace eyrie::cli
