// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/patience.h"

#include <algorithm>
#include <vector>

namespace eyrie::coordinator {

std::chrono::milliseconds Patience::limit() const {
    if (recent_.empty())
        return options_.first;
    std::vector<std::chrono::milliseconds> sorted(recent_.begin(), recent_.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return std::max(options_.least, *middle * options_.timesMedian);
}

void Patience::record(std::chrono::milliseconds taken) {
    recent_.push_back(taken);
    if (recent_.size() > kRemembered)
        recent_.pop_front();
}

}  // namespace eyrie::coordinator
