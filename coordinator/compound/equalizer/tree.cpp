// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/tree.h"

#include <algorithm>
#include <numeric>

namespace eyrie::equalizer {
namespace {

/// As in Load: nothing takes less.
constexpr double kLeastMilliseconds = .5;
constexpr double kRounding = 1e-9;  ///< of where parts that meet end and begin

/// Where an area was cut, and what either side took.
struct Taken {
    double low;
    double cut;
    double high;
    double before;
    double after;
};

/// How far into the area, of its length, `share` of the load lies before, if that was even on
/// either side.
double evenly(const Taken& taken, double share) {
    const auto& [low, cut, high, before, after] = taken;
    const double wanted = share * (before + after);
    const double place = wanted <= before ? low + (cut - low) * wanted / before
                                          : cut + (high - cut) * (wanted - before) / after;
    return (place - low) / (high - low);
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
        return wish.area.begin(wish.axis) + shareBefore(wish) * wish.area.length(wish.axis);
    };
    children_.give(turn, mode_, whole->width, whole->height,
                   tree_.split(whole->width, whole->height, whole->rules, resources_, place));
    costs_.clear();
}

/// How far into the area the cut should be. Others may have been planned since the frame that is
/// answered: what its sides took belongs to where they were in it.
double Tree::shareBefore(const SplitTree::Wish& wish) const {
    if (!wish.before || costs_.empty())
        return wish.share;
    const Area left = around(wish.firstLeaf, wish.middleLeaf);
    const Area right = around(wish.middleLeaf, wish.endLeaf);
    const Taken taken{left.begin(wish.axis), left.end(wish.axis), right.end(wish.axis),
                      sum(wish.firstLeaf, wish.middleLeaf, costs_),
                      sum(wish.middleLeaf, wish.endLeaf, costs_)};
    if (left.isEmpty() || right.isEmpty() ||
        taken.cut > right.begin(wish.axis) + kRounding)  // cut otherwise
        return (*wish.before - wish.area.begin(wish.axis)) / wish.area.length(wish.axis);
    return evenly(taken, wish.share);
}

/// All parts of these children that are not empty; empty where all are.
Area Tree::around(std::size_t first, std::size_t end) const {
    Area all{1, 1, 0, 0};
    for (std::size_t i = first; i < end; ++i)
        if (const Area& part = parts_[i]; !part.isEmpty())
            all = {std::min(all.x, part.x), std::min(all.y, part.y), std::max(all.xEnd, part.xEnd),
                   std::max(all.yEnd, part.yEnd)};
    return all;
}

double Tree::sum(std::size_t first, std::size_t end, const std::vector<double>& values) const {
    return std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(first),
                           values.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
}

void Tree::switchOff(Turn& turn) { children_.giveAsWritten(turn, mode_); }

void Tree::record(const PlannedFrame& frame, const FrameTimes& times) {
    const auto costs = children_.costs(frame, times);
    if (!costs || costs->size() != resources_.size())
        return;
    costs_ = *costs;
    parts_.clear();
    for (std::size_t i = 0; i < children_.size(); ++i)
        parts_.push_back(children_.part(i, frame, mode_));
    double longest = 0;
    for (std::size_t i = 0; i < costs_.size(); ++i) {
        if (resources_[i] > 0)
            longest = std::max(longest, costs_[i] / resources_[i]);
        costs_[i] = std::max(costs_[i], kLeastMilliseconds);
    }
    imbalance_ = longest * sum(0, resources_.size(), resources_) / sum(0, costs_.size(), costs_);
}

Report Tree::report() const { return {.imbalance = imbalance_}; }

}  // namespace eyrie::equalizer
