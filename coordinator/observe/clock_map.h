// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace eyrie::observe {

/// A call to another process as both ends' steady clocks saw it: here it was sent and its answer
/// came; there, in between, it arrived and was answered.
struct Exchange {
    std::chrono::steady_clock::time_point sent;
    std::chrono::nanoseconds received{};  ///< of the other clock, as answered
    std::chrono::nanoseconds answered{};
    std::chrono::steady_clock::time_point came;
};

/// What another process's steady clock says, put into this one's.
///
/// A call arrives after it was sent and is answered before the answer comes, so each exchange says
/// between what bounds the difference of the clocks lies; what all of them allow is known to within
/// half of what is left. (Marzullo, "Maintaining the Time in a Distributed System", 1984: here with
/// one source.) Clocks run at rates that differ by kDrift at most, by which the bounds widen as
/// they age. Exchanges that contradict earlier ones, as after a machine was suspended, begin anew.
///
/// Not thread-safe.
class ClockMap {
public:
    /// Of two quartz clocks, generously: 2e-4 is 0.2 ms a second.
    static constexpr double kDrift = 2e-4;

    /// Here minus there, and how far that may be off.
    struct Offset {
        std::chrono::nanoseconds offset{};
        std::chrono::nanoseconds bound{};

        std::chrono::steady_clock::time_point here(std::chrono::nanoseconds there) const {
            return std::chrono::steady_clock::time_point(
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(there + offset));
        }
    };

    /// Takes an exchange into account and says what the offset is at its time: such that it was
    /// received after it was sent and answered before the answer came. Nothing for an exchange
    /// that no two clocks can have seen.
    std::optional<Offset> note(const Exchange& exchange);

private:
    struct Bounds {
        std::int64_t low;  ///< nanoseconds
        std::int64_t high;
        std::chrono::steady_clock::time_point at;
    };
    std::optional<Bounds> bounds_;
};

}  // namespace eyrie::observe
