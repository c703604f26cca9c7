// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

namespace eyrie::service {

/// How long a renderer that the coordinator has given up waits before it registers again. Not at
/// all after a registration that held for a while: it was taken for dead. One that is given up
/// again soon may be out of order: it waits from the second time on, twice as long each time.
class RejoinPause {
public:
    static constexpr std::chrono::seconds kHeld{10};
    static constexpr std::chrono::milliseconds kFirst{500};
    static constexpr std::chrono::milliseconds kLongest{30'000};

    /// Before the next registration, after one that `lasted` so long.
    std::chrono::milliseconds after(std::chrono::steady_clock::duration lasted) {
        if (lasted >= kHeld)
            next_ = {};
        return std::exchange(next_, std::clamp(2 * next_, kFirst, kLongest));
    }

private:
    std::chrono::milliseconds next_{0};
};

}  // namespace eyrie::service
