// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/clock_map.h"

#include <algorithm>

namespace eyrie::observe {
namespace {

/// A century: what a clock of a process can say, and differences of two such numbers fit.
constexpr std::int64_t kLongest = 100LL * 366 * 24 * 3600 * 1'000'000'000;

std::int64_t nanoseconds(std::chrono::steady_clock::time_point time) {
    return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

bool isBelievable(const Exchange& exchange) {
    return exchange.received.count() >= 0 && exchange.answered >= exchange.received &&
           exchange.answered.count() <= kLongest && exchange.came >= exchange.sent;
}

}  // namespace

std::optional<ClockMap::Offset> ClockMap::note(const Exchange& exchange) {
    if (!isBelievable(exchange))
        return std::nullopt;
    Bounds now{nanoseconds(exchange.sent) - exchange.received.count(),
               nanoseconds(exchange.came) - exchange.answered.count(), exchange.came};
    if (now.low > now.high)
        return std::nullopt;  // it took longer there than the whole call here
    if (bounds_) {
        const auto age = std::max<std::chrono::nanoseconds>(exchange.came - bounds_->at,
                                                            std::chrono::seconds(0));
        const auto drift = static_cast<std::int64_t>(kDrift * static_cast<double>(age.count()));
        const std::int64_t low = std::max(now.low, bounds_->low - drift);
        const std::int64_t high = std::min(now.high, bounds_->high + drift);
        if (low <= high) {
            now.low = low;
            now.high = high;
        }
    }
    bounds_ = now;
    const std::int64_t half = (now.high - now.low) / 2;
    return Offset{std::chrono::nanoseconds(now.low + half),
                  std::chrono::nanoseconds(now.high - now.low - half)};
}

}  // namespace eyrie::observe
