// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace eyrie::access {

/// Who, or what, is warned of to the log, each once a minute: else strangers could fill it. Any
/// thread may ask.
class RareWarnings {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::chrono::seconds kInterval{60};
    static constexpr std::size_t kMost = 1024;  ///< beyond, nobody new is warned of

    /// `whom`: an address, or another name.
    bool isDue(const std::string& whom, Clock::time_point now) {
        const std::lock_guard lock(mutex_);
        std::erase_if(last_, [now](const auto& told) { return now - told.second >= kInterval; });
        return last_.size() < kMost && last_.emplace(whom, now).second;
    }

private:
    std::mutex mutex_;  ///< guards what follows
    std::map<std::string, Clock::time_point> last_;
};

}  // namespace eyrie::access
