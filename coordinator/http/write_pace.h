// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace eyrie::http {

/// How fast an answer has to be taken. However long it is, it may go on for as long as it flows;
/// who takes nothing for a while, or on the whole less than a slow modem would, is cut off: an
/// answer holds memory, and a connection.
class WritePace {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::int64_t kSlowestBytesPerSecond = 16 * 1024;

    /// `patience`: how long nothing may be taken, and how far the whole may be behind.
    WritePace(Clock::time_point begin, std::chrono::milliseconds patience)
        : begin_(begin), patience_(patience) {}

    /// That many more bytes have been taken.
    void took(std::size_t bytes) { taken_ += static_cast<std::int64_t>(bytes); }

    /// When the next of them must have been.
    Clock::time_point deadline(Clock::time_point now) const {
        const std::chrono::milliseconds due{taken_ * 1000 / kSlowestBytesPerSecond};
        return std::min(now, begin_ + due) + patience_;
    }

private:
    Clock::time_point begin_;
    std::chrono::milliseconds patience_;
    std::int64_t taken_ = 0;
};

}  // namespace eyrie::http
