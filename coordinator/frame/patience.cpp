// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/patience.h"

#include <algorithm>
#include <vector>

namespace eyrie::coordinator {

std::optional<std::chrono::milliseconds> Patience::limit(std::uint64_t kind) const {
    const auto recent = std::find_if(kinds_.begin(), kinds_.end(),
                                     [&](const Recent& one) { return one.kind == kind; });
    if (recent == kinds_.end())
        return std::nullopt;
    std::vector<std::chrono::milliseconds> sorted(recent->times.begin(), recent->times.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return std::max(options_.least, *middle * options_.timesMedian);
}

void Patience::record(std::uint64_t kind, std::chrono::milliseconds given,
                      std::chrono::milliseconds taken) {
    const auto known = std::find_if(kinds_.begin(), kinds_.end(),
                                    [&](const Recent& one) { return one.kind == kind; });
    if (known != kinds_.end())
        kinds_.splice(kinds_.begin(), kinds_, known);
    else
        kinds_.push_front({kind, {}});
    if (kinds_.size() > kKinds)
        kinds_.pop_back();
    std::deque<std::chrono::milliseconds>& times = kinds_.front().times;
    times.push_back(std::min(given, taken));
    if (times.size() > kRemembered)
        times.pop_front();
}

}  // namespace eyrie::coordinator
