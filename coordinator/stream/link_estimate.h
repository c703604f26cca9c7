// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "coordinator/stream/pacer.h"

namespace eyrie::stream {

/// How many bytes a second the link to one browser carries, told from when what was sent is
/// acknowledged: what a send call says tells only how much memory the system has.
///
/// What was sent so early that it must have waited behind what came before it had the link from
/// when that had arrived: so many bytes in that time are one sample. What did not wait had the link
/// from a bare round trip after it was sent, but a browser's threads may have taken 4 ms (25, on
/// loopback) of that time, so that it tells two bounds, and is a sample only where the estimate is
/// beyond one of them. Otherwise a busy machine would make the rate look low, so frames smaller,
/// and the rate lower still. The estimate is the median of the last five samples, less while what
/// is under way is overdue. As in BBR (N. Cardwell et al., 2016), what the sender limits says
/// little of the link. Not thread-safe.
class LinkEstimate {
public:
    static constexpr std::uint64_t kWhole = std::numeric_limits<std::uint64_t>::max();

    /// `bytes` of frame `frameNumber`, which end at `end` of its picture, or kWhole for the last.
    /// Both ascend.
    void sent(std::uint64_t frameNumber, std::uint64_t end, std::size_t bytes,
              Clock::time_point now);

    /// Everything up to there had arrived by `at`, as told by a message that came back. What was
    /// not sent changes nothing.
    void arrived(std::uint64_t frameNumber, std::uint64_t end, Clock::time_point at);

    /// How long a message without weight took there and back; the shortest of the last ten seconds
    /// counts, since others waited behind pictures.
    void roundTrip(Clock::duration time, Clock::time_point now);

    /// Absent before the first sample.
    std::optional<double> bytesPerSecond(Clock::time_point now) const;
    Clock::duration shortestRoundTrip() const;

    std::size_t bytesUnderWay() const { return bytesUnderWay_; }
    /// When the oldest of what is under way was sent or, if that is later, something last arrived:
    /// a link that has become slow is none that is gone.
    std::optional<Clock::time_point> waitingSince() const;

private:
    struct Sent {
        std::uint64_t frameNumber = 0;
        std::uint64_t end = 0;
        std::size_t bytes = 0;
        Clock::time_point at;
    };
    struct RoundTrip {
        Clock::time_point at;
        Clock::duration time;
    };

    Clock::time_point soonest(const Sent& oldest) const { return oldest.at + shortestRoundTrip(); }
    Clock::duration forThreads() const;
    double estimate() const;
    void learn(std::size_t bytes, const Sent& oldest, Clock::time_point at);
    void sample(double bytesPerSecond);

    std::deque<Sent> underWay_;
    std::size_t bytesUnderWay_ = 0;
    std::optional<Clock::time_point> lastArrival_;
    std::deque<RoundTrip> roundTrips_;
    Clock::duration shortestLoop_ = Clock::duration::max();  ///< in place of round trips
    std::deque<double> samples_;                             ///< bytes a second
};

}  // namespace eyrie::stream
