// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/link_estimate.h"

#include <algorithm>
#include <tuple>
#include <vector>

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kSamples = 5;
/// What a short round trip leaves of this is given to a browser's threads, and so much at least.
constexpr milliseconds kDelayToGive{25};
constexpr milliseconds kLeastForThreads{4};
constexpr seconds kRoundTripsKept{10};
/// Clocks and threads are no better than this.
constexpr milliseconds kShortest{1};
/// So long after it was to be expected something is overdue, and no mere hiccup.
constexpr milliseconds kOverdue{100};

double perSecond(std::size_t bytes, Clock::duration time) {
    return static_cast<double>(bytes) /
           std::chrono::duration<double>(std::max<Clock::duration>(time, kShortest)).count();
}

}  // namespace

void LinkEstimate::sent(std::uint64_t frameNumber, std::uint64_t end, std::size_t bytes,
                        Clock::time_point now) {
    underWay_.push_back({frameNumber, end, bytes, now});
    bytesUnderWay_ += bytes;
}

void LinkEstimate::arrived(std::uint64_t frameNumber, std::uint64_t end, Clock::time_point at) {
    const auto isIn = [&](const Sent& one) {
        return std::tie(one.frameNumber, one.end) <= std::tie(frameNumber, end);
    };
    if (underWay_.empty() || !isIn(underWay_.front()) || frameNumber > underWay_.back().frameNumber)
        return;
    const Sent oldest = underWay_.front();
    std::size_t bytes = 0;
    Clock::time_point lastSent;
    for (; !underWay_.empty() && isIn(underWay_.front()); underWay_.pop_front()) {
        bytes += underWay_.front().bytes;
        lastSent = underWay_.front().at;
    }
    bytesUnderWay_ -= bytes;
    at = std::max(at, lastSent);  // a browser that lies gains nothing
    shortestLoop_ = std::min(shortestLoop_, at - oldest.at);
    learn(bytes, oldest, at);
    lastArrival_ = at;
}

void LinkEstimate::learn(std::size_t bytes, const Sent& oldest, Clock::time_point at) {
    if (lastArrival_.has_value() && *lastArrival_ > soonest(oldest) + forThreads())
        return sample(perSecond(bytes, at - *lastArrival_));
    const Clock::duration taken = at - soonest(oldest);
    const double atLeast = perSecond(bytes, taken);
    const double atMost = perSecond(bytes, taken - forThreads());
    if (samples_.empty() || estimate() > atMost)
        sample(atMost);
    else if (estimate() < atLeast)
        sample(atLeast);
}

void LinkEstimate::sample(double bytesPerSecond) {
    samples_.push_back(bytesPerSecond);
    if (samples_.size() > kSamples)
        samples_.pop_front();
}

Clock::duration LinkEstimate::forThreads() const {
    return std::max<Clock::duration>(kDelayToGive - shortestRoundTrip(), kLeastForThreads);
}

double LinkEstimate::estimate() const {
    std::vector<double> sorted(samples_.begin(), samples_.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void LinkEstimate::roundTrip(Clock::duration time, Clock::time_point now) {
    roundTrips_.push_back({now, time});
    while (roundTrips_.front().at + kRoundTripsKept < now) roundTrips_.pop_front();
}

Clock::duration LinkEstimate::shortestRoundTrip() const {
    if (roundTrips_.empty())
        return shortestLoop_ == Clock::duration::max() ? Clock::duration::zero() : shortestLoop_;
    return std::min_element(roundTrips_.begin(), roundTrips_.end(),
                            [](const RoundTrip& a, const RoundTrip& b) { return a.time < b.time; })
        ->time;
}

std::optional<double> LinkEstimate::bytesPerSecond(Clock::time_point now) const {
    if (samples_.empty())
        return std::nullopt;
    if (underWay_.empty())
        return estimate();
    const Clock::time_point free =
        std::max(soonest(underWay_.front()), lastArrival_.value_or(Clock::time_point()));
    const Clock::duration taken = now - free;
    return taken > kOverdue ? std::min(estimate(), perSecond(underWay_.front().bytes, taken))
                            : estimate();
}

std::optional<Clock::time_point> LinkEstimate::waitingSince() const {
    if (underWay_.empty())
        return std::nullopt;
    return std::max(underWay_.front().at, lastArrival_.value_or(Clock::time_point()));
}

}  // namespace eyrie::stream
