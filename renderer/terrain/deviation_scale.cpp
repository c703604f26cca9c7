// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/deviation_scale.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace eyrie::terrain {

DeviationScale::DeviationScale(std::vector<double> thresholds, double highestMetres)
    : thresholds_(std::move(thresholds)), floatThresholds_(thresholds_.begin(), thresholds_.end()) {
    assert(thresholds_.size() <= kMaxThresholds);
    constexpr double kFloatRounding = 1.0 / (1 << 20);
    constexpr int kEighths = 1 << kEighthBits;
    greatest_.fill(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < thresholds_.size(); ++k) {
        last_[k] = k == 0 ? 0 : thresholds_[k - 1];
        const double step = thresholds_[k] - last_[k];
        eighths_[k] = step > 0 ? kEighths / step : 0;
        for (std::size_t e = 0; e < kEighths; ++e) {
            const double reach = last_[k] + step * static_cast<double>(e + 1) / kEighths;
            greatest_[k << kEighthBits | e] =
                reach + kFloatRounding * (thresholds_[k] + highestMetres);
        }
    }
    std::copy(last_.begin(), last_.end(), floatLast_.begin());
    std::copy(eighths_.begin(), eighths_.end(), floatEighths_.begin());
}

}  // namespace eyrie::terrain
