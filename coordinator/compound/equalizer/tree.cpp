// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace eyrie::equalizer {
namespace {

/// As in Load: nothing takes less.
constexpr double kLeastMilliseconds = .5;

/// Where the load on either side of `cut`, each even, is cut so that `share` of it lies before.
double evenly(const SplitTree::Wish& wish, double cut, double before, double after) {
    const double low = wish.area.begin(wish.axis);
    const double high = wish.area.end(wish.axis);
    const double wanted = wish.share * (before + after);
    if (wanted <= before)
        return low + (cut - low) * wanted / before;
    return cut + (high - cut) * (wanted - before) / after;
}

}  // namespace

Tree::Tree(const config::Compound& written, std::size_t position, const Work& work)
    : position_(position), children_(written, position, work), tree_(children_.size()) {}

void Tree::apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) {
    if (settings.mode != mode_) {
        mode_ = settings.mode;
        tree_ = SplitTree(children_.size());
        costs_.clear();
    }
    const config::ResolvedCompound* const compound = turn.resolved(position_);
    auto whole =
        compound == nullptr || children_.size() == 0 ? std::nullopt : wholeOf(*compound, settings);
    if (!whole)
        return;
    if (whole->rules.axes == CutAxes::Longer)
        whole->rules.axes = CutAxes::Alternating;
    whole->rules.isFrozen = isFrozen || costs_.empty();
    resources_ = children_.resources(turn);
    const auto place = [&](const SplitTree::Wish& wish) {
        const double low = wish.area.begin(wish.axis);
        if (!wish.before || costs_.empty())
            return low + wish.share * wish.area.length(wish.axis);
        return evenly(wish, std::clamp(*wish.before, low, wish.area.end(wish.axis)),
                      sum(wish.firstLeaf, wish.middleLeaf, costs_),
                      sum(wish.middleLeaf, wish.endLeaf, costs_));
    };
    std::vector<Area> parts =
        tree_.split(whole->width, whole->height, whole->rules, resources_, place);
    if (parts != parts_ || turn.facts.frameNumber < since_)
        since_ = turn.facts.frameNumber;
    parts_ = std::move(parts);
    children_.give(turn, mode_, whole->width, whole->height, parts_);
    costs_.clear();
}

double Tree::sum(std::size_t first, std::size_t end, const std::vector<double>& values) const {
    return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                           values.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
}

void Tree::switchOff(Turn& turn) { children_.giveAsWritten(turn, mode_); }

void Tree::record(const PlannedFrame& frame, const FrameTimes& times) {
    auto costs = children_.costs(frame, times);
    if (!costs || costs->size() != resources_.size())
        return;
    double longest = 0;
    for (std::size_t i = 0; i < costs->size(); ++i) {
        if (resources_[i] > 0)
            longest = std::max(longest, (*costs)[i] / resources_[i]);
        (*costs)[i] = std::max((*costs)[i], kLeastMilliseconds);
    }
    imbalance_ = longest * sum(0, resources_.size(), resources_) / sum(0, costs->size(), *costs);
    if (frame.number >= since_)
        costs_ = *costs;
}

Report Tree::report() const { return {.imbalance = imbalance_}; }

}  // namespace eyrie::equalizer
