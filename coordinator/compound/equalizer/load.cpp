// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/load.h"

#include <algorithm>
#include <numeric>

#include "coordinator/config/pixels.h"

namespace eyrie::equalizer {
namespace {

using config::SplitMode;

constexpr double kAlike = 1.05;  ///< longest over mean time that is left alone
/// A part that takes less counts as taking so long: less is nothing to balance.
constexpr double kLeastMilliseconds = .5;
/// Of its resources, what a destination is left with however long it assembles.
constexpr double kLeastOfDestination = .05;

LoadModel modelFor(SplitMode mode, std::size_t children) {
    switch (mode) {
        case SplitMode::Vertical:
            return {512, 1, children};
        case SplitMode::Horizontal:
            return {1, 512, children};
        case SplitMode::Db:
            return {1024, 1, children};
        case SplitMode::TwoD:
            break;
    }
    return {96, 96, children};
}

Area areaOf(const config::Viewport& v) { return {v.x, v.y, v.x + v.width, v.y + v.height}; }

}  // namespace

Load::Load(const config::Compound& written, std::size_t position, const Work& work)
    : position_(position),
      work_(work),
      children_(written, position, work),
      model_(modelFor(mode_, children_.size())),
      tree_(children_.size()),
      destination_(children_.size()) {}

void Load::setMode(SplitMode mode) {
    if (mode == mode_)
        return;
    mode_ = mode;
    model_ = modelFor(mode, children_.size());
    tree_ = SplitTree(children_.size());
    costs_.clear();
}

void Load::apply(Turn& turn, const config::Equalizer& settings, bool isFrozen) {
    setMode(settings.mode);
    const config::ResolvedCompound* const compound = turn.resolved(position_);
    if (compound == nullptr || children_.size() == 0)
        return;
    destination_ = 0;
    while (destination_ < children_.size() &&
           (turn.resolved(children_[destination_]) == nullptr ||
            turn.resolved(children_[destination_])->channel != compound->channel))
        ++destination_;
    auto whole = wholeOf(*compound, settings);
    if (!whole)
        return;
    whole->rules.isFrozen = isFrozen;
    whole->rules.isSettled = !costs_.empty() && imbalance() <= kAlike;
    whole->rules.followsCourse = true;
    resources_ = resources(turn, settings);
    std::vector<double> shares = resources_;
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] /= model_.slowness(i);
    charge(shares, destination_);
    const auto place = [&](const SplitTree::Wish& wish) {
        const double extent = wish.axis == Axis::X ? whole->width : whole->height;
        const double middle = wish.area.begin(wish.axis) + wish.area.length(wish.axis) / 2;
        return extent * model_.map().cut(shareOf(wish.area, *whole), wish.axis, wish.share,
                                         wish.before.value_or(middle) / extent);
    };
    children_.give(turn, mode_, whole->width, whole->height,
                   tree_.split(whole->width, whole->height, whole->rules, shares, place));
}

/// Without the destination where enough others draw.
std::vector<double> Load::resources(const Turn& turn, const config::Equalizer& settings) const {
    std::vector<double> resources = children_.resources(turn);
    if (!settings.assembleOnlyLimit || destination_ == resources.size())
        return resources;
    double others = 0;
    for (std::size_t i = 0; i < resources.size(); ++i)
        others += i != destination_ && resources[i] > 0 ? 1 : 0;
    if (others > 0 && others >= *settings.assembleOnlyLimit)
        resources[destination_] = 0;
    return resources;
}

/// All are done at one time when the destination draws for as much less as it assembles.
void Load::charge(std::vector<double>& resources, std::size_t destination) const {
    if (costs_.empty() || !(assembly_ > 0) || destination == resources.size() ||
        !(resources[destination] > 0))
        return;
    double work = 0;
    for (std::size_t i = 0; i < costs_.size(); ++i) work += costs_[i] / model_.slowness(i);
    const double all = std::accumulate(resources.begin(), resources.end(), 0.0);
    const double done = (work + assembly_ * resources[destination]) / all;
    if (done > 0)
        resources[destination] *= std::max(kLeastOfDestination, 1 - assembly_ / done);
}

void Load::switchOff(Turn& turn) { children_.giveAsWritten(turn, mode_); }

void Load::record(const PlannedFrame& frame, const FrameTimes& times) {
    const auto costs = children_.costs(frame, times);
    if (!costs || costs->size() != resources_.size())
        return;
    std::vector<LoadModel::Measured> measured;
    for (std::size_t i = 0; i < costs->size(); ++i) {
        LoadModel::Measured part{
            i, children_.part(i, frame, mode_), {}, std::max((*costs)[i], kLeastMilliseconds)};
        if (part.part.isEmpty())
            continue;
        part.region = part.part;
        if (mode_ != SplitMode::Db)
            part.region = areaOf(config::part(frame.parts[children_[i]].viewport,
                                              work_.covered(children_[i], frame, times)));
        measured.push_back(part);
    }
    costs_ = *costs;
    assembly_ = position_ < times.compounds.size()
                    ? known(times.compounds[position_].assemble).value_or(0)
                    : 0;
    model_.record(measured, imbalance() <= kAlike);
}

double Load::imbalance() const {
    double longest = 0;
    double sum = 0;
    double all = 0;
    for (std::size_t i = 0; i < costs_.size(); ++i) {
        if (!(resources_[i] > 0))
            continue;
        const double taken = std::max(costs_[i] / resources_[i], kLeastMilliseconds) +
                             (i == destination_ ? assembly_ : 0);
        longest = std::max(longest, taken);
        sum += taken * resources_[i];
        all += resources_[i];
    }
    return sum > 0 ? longest * all / sum : 0;
}

Report Load::report() const { return {.imbalance = imbalance()}; }

}  // namespace eyrie::equalizer
