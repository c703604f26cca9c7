// SPDX-License-Identifier: Apache-2.0
#include "cli/restart_policy.h"

#include <algorithm>

namespace eyrie::cli {

RestartPolicy::Clock::time_point RestartPolicy::ended(Clock::time_point now) {
    constexpr std::chrono::minutes kMinute{1};
    while (!recent_.empty() && recent_.front() <= now - kMinute) recent_.pop_front();
    const auto doublings = std::min<std::size_t>(recent_.size(), 16);
    recent_.push_back(now);
    if (recent_.size() > static_cast<std::size_t>(kMaxPerMinute))
        return recent_[recent_.size() - kMaxPerMinute - 1] + kMinute;
    return now + std::min(kLongestPause, kFirstPause * (1 << doublings));
}

}  // namespace eyrie::cli
