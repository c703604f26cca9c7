// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/course.h"

#include <algorithm>
#include <cmath>

namespace eyrie::equalizer {
namespace {

/// Two frames are under way between a frame and the first that is planned by its times; what is
/// believed of these only by and by makes it three. Four are no better for two children and worse
/// for four.
constexpr double kFramesAhead = 3;
/// Less is left alone: cuts are to come to rest.
constexpr double kLeast = .004;

}  // namespace

double Course::ahead(double place) {
    if (last_) {
        steps_[next_] = place - *last_;
        next_ = (next_ + 1) % kFrames;
    }
    last_ = place;
    const auto [lowest, highest] = std::ranges::minmax(steps_);
    const double slowest = lowest > 0 ? lowest : std::min(highest, 0.0);
    const double way = kFramesAhead * slowest;
    return std::abs(way) < kLeast ? 0 : way;
}

}  // namespace eyrie::equalizer
