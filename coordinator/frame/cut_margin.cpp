// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/cut_margin.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eyrie::coordinator {
namespace {

constexpr double kStep = 0.15;
constexpr double kSmall = 0.25;  ///< of a budget

}  // namespace

double CutMargin::factor() const { return std::exp(logarithm_); }

void CutMargin::record(double foreseenMilliseconds, double milliseconds,
                       double budgetMilliseconds) {
    const double small = kSmall * budgetMilliseconds;
    const bool isLonger =
        milliseconds + small > std::exp(logarithm_) * (foreseenMilliseconds + small);
    logarithm_ += kStep * (isLonger ? kQuantile : kQuantile - 1);
    logarithm_ = std::clamp(logarithm_, 0.0, std::numbers::ln2);
}

}  // namespace eyrie::coordinator
