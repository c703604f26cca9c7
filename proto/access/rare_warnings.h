// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace eyrie::access {

/// Who is warned of to the log, each address once a minute: else strangers could fill it. Used by
/// one thread at a time.
class RareWarnings {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::chrono::seconds kInterval{60};
    static constexpr std::size_t kMaxAddresses = 1024;  ///< beyond, nobody new is warned of

    bool isDue(const std::string& address, Clock::time_point now) {
        std::erase_if(last_, [now](const auto& told) { return now - told.second >= kInterval; });
        return last_.size() < kMaxAddresses && last_.emplace(address, now).second;
    }

private:
    std::map<std::string, Clock::time_point> last_;
};

}  // namespace eyrie::access
