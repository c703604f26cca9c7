// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/framerate.h"

#include <algorithm>
#include <numeric>

namespace eyrie::equalizer {
namespace {

constexpr double kToSpare = 1.05;
constexpr std::int64_t kLongestPeriod = 1024;

}  // namespace

Framerate::Framerate(std::size_t position, const Work& work)
    : position_(position), work_(work), children_(work.drawingChildren(position)) {}

void Framerate::apply(Turn& turn, const config::Equalizer&, bool isFrozen) {
    isAtWork_ = false;
    isFrozen_ = isFrozen;
    std::int64_t period = 1;
    for (const std::size_t child : children_)
        if (const auto* const compound = turn.resolved(child)) {
            period = std::clamp(compound->period, period, kLongestPeriod);
            isAtWork_ = isAtWork_ || (compound->destination && turn.isAskedFor(*compound));
        }
    period_ = static_cast<std::size_t>(period);
}

void Framerate::record(const PlannedFrame& frame, const FrameTimes& times) {
    if (isFrozen_)
        return;
    const double longest = work_.longest(position_, frame, times);
    if (!(longest > 0))
        return;
    times_.push_back(longest);
    while (times_.size() > period_) times_.pop_front();
    if (position_ < times.compounds.size())
        assembly_ = known(times.compounds[position_].assemble).value_or(0);
    const auto count = static_cast<double>(times_.size());
    const double mean = std::accumulate(times_.begin(), times_.end(), 0.0) / count;
    interval_ = kToSpare * std::max(mean / static_cast<double>(period_), assembly_);
}

Report Framerate::report() const {
    return {.framesPerSecond = isAtWork_ && interval_ > 0 ? 1000 / interval_ : 0};
}

}  // namespace eyrie::equalizer
