// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/load_balance.h"

#include <algorithm>
#include <numeric>

#include "fabric/range.h"

namespace eyrie::coordinator {
namespace {

constexpr double kStep = 0.5;         ///< share of the way to where the cuts should be
constexpr double kAlike = 1.05;       ///< longest over mean time that is left alone
constexpr double kLeastShare = 0.05;  ///< of an equal part: what a part keeps, however slow
constexpr double kLeastMilliseconds = 0.5;

/// Where the sum of `times`, each spread evenly between two of `edges`, reaches `wanted`.
double positionOf(double wanted, std::span<const double> times, std::span<const double> edges) {
    std::size_t part = 0;
    while (part + 1 < times.size() && wanted > times[part]) wanted -= times[part++];
    return edges[part] + (edges[part + 1] - edges[part]) * std::min(wanted / times[part], 1.0);
}

}  // namespace

const std::vector<double>& LoadBalance::cuts(int channels) {
    if (static_cast<int>(cuts_.size()) + 1 != channels)
        cuts_ = fabric::equalCuts(channels);
    return cuts_;
}

void LoadBalance::record(std::span<const double> milliseconds) {
    const std::size_t parts = milliseconds.size();
    if (parts != cuts_.size() + 1 || parts < 2)
        return;
    std::vector<double> times(milliseconds.begin(), milliseconds.end());
    for (double& time : times) time = std::max(time, kLeastMilliseconds);
    const double mean =
        std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(parts);
    if (*std::max_element(times.begin(), times.end()) <= kAlike * mean)
        return;
    std::vector<double> edges = {0};
    edges.insert(edges.end(), cuts_.begin(), cuts_.end());
    edges.push_back(1);
    const double least = kLeastShare / static_cast<double>(parts);
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
        const double target = positionOf(mean * static_cast<double>(i + 1), times, edges);
        const double moved = cuts_[i] + kStep * (target - cuts_[i]);
        const double before = i == 0 ? 0 : cuts_[i - 1];
        cuts_[i] =
            std::clamp(moved, before + least, 1 - least * static_cast<double>(cuts_.size() - i));
    }
}

}  // namespace eyrie::coordinator
