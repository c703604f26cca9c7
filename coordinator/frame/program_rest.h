// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

namespace eyrie::coordinator {

/// How long programs are left alone after one has failed: twice as long after each failure in a
/// row, since what lasts would have every other frame wait for it. Not thread-safe.
class ProgramRest {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::chrono::seconds kFirst{2};
    static constexpr std::chrono::seconds kLongest{60};

    void failed(Clock::time_point now) {
        if (!isOver(now))
            return;  // it was begun before the rest
        length_ = std::clamp<std::chrono::seconds>(2 * length_, kFirst, kLongest);
        until_ = now + length_;
    }
    void succeeded() { length_ = {}; }
    bool isOver(Clock::time_point now) const { return now >= until_; }

private:
    std::chrono::seconds length_{0};
    Clock::time_point until_{};
};

}  // namespace eyrie::coordinator
