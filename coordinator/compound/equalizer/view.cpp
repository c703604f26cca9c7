// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/view.h"

#include <algorithm>
#include <numeric>

namespace eyrie::equalizer {
namespace {

constexpr double kLeast = .1;       ///< of a pipe: less is not worth a task
constexpr std::size_t kServed = 2;  ///< segments by one pipe
constexpr double kNew = .5;         ///< what a frame's times weigh among those before

}  // namespace

/// What is left of the pipes while they are handed out.
struct View::Supply {
    struct Left {
        double share = 1;
        std::size_t served = 0;
    };
    std::map<Pipe, Left> pipes;

    void take(const Pipe& pipe, double& demand, Shares& shares) {
        const auto found = pipes.find(pipe);
        if (found == pipes.end())
            return;
        Left& left = found->second;
        const double taken = std::min(left.share, demand);
        const bool isHad = shares.contains(pipe);
        if (taken < kLeast || (!isHad && left.served == kServed))
            return;
        left.served += isHad ? 0 : 1;
        left.share -= taken;
        demand -= taken;
        shares[pipe] += taken;
    }
};

View::View(std::size_t position, const Work& work)
    : work_(work),
      children_(work.drawingChildren(position)),
      loads_(children_.size(), 0.0),
      shares_(children_.size()) {}

void View::apply(Turn& turn, const config::Equalizer&, bool isFrozen) {
    const double all = std::accumulate(loads_.begin(), loads_.end(), 0.0);
    if (!(all > 0))
        return;
    std::vector<Shares> shares = isFrozen ? shares_ : share(turn);
    use(turn, shares);
    shares_ = std::move(shares);
}

std::vector<View::Shares> View::share(const Turn& turn) const {
    Supply supply;
    std::vector<std::vector<Pipe>> usable(children_.size());  // its own first
    for (std::size_t i = 0; i < children_.size(); ++i) {
        const auto add = [&](std::size_t position) {
            const config::ResolvedCompound* const compound = turn.resolved(position);
            if (compound == nullptr || !compound->channel || !(turn.usage[position] > 0))
                return;
            const Pipe pipe{compound->channel->node, compound->channel->pipe};
            supply.pipes.try_emplace(pipe);
            usable[i].push_back(pipe);
        };
        const config::ResolvedCompound* const own = turn.resolved(children_[i]);
        for (const bool isOwn : {true, false})
            for (std::size_t p = children_[i]; p < work_.at(children_[i]).end; ++p) {
                const config::ResolvedCompound* const each = turn.resolved(p);
                if (work_.at(p).drawsItself && own != nullptr && each != nullptr &&
                    (each->channel == own->channel) == isOwn)
                    add(p);
            }
    }
    std::vector<double> demand = demands(static_cast<double>(supply.pipes.size()));
    std::vector<Shares> shares(children_.size());
    for (std::size_t i = 0; i < children_.size(); ++i)
        if (!usable[i].empty())
            supply.take(usable[i].front(), demand[i], shares[i]);
    for (std::size_t i = 0; i < children_.size(); ++i)
        for (const Pipe& pipe : usable[i])
            if (shares_[i].contains(pipe))
                supply.take(pipe, demand[i], shares[i]);
    for (std::size_t i = 0; i < children_.size(); ++i)
        for (const Pipe& pipe : usable[i]) supply.take(pipe, demand[i], shares[i]);
    return shares;
}

/// In pipes, by child; together no more than there are.
std::vector<double> View::demands(double pipes) const {
    const double all = std::accumulate(loads_.begin(), loads_.end(), 0.0);
    std::vector<double> demands;
    for (const double load : loads_) demands.push_back(std::max(kLeast, pipes * load / all));
    return demands;
}

/// A segment without any share keeps what it may use: somebody has to draw it.
void View::use(Turn& turn, const std::vector<Shares>& shares) const {
    for (std::size_t i = 0; i < children_.size(); ++i) {
        if (shares[i].empty())
            continue;
        for (std::size_t p = children_[i]; p < work_.at(children_[i]).end; ++p) {
            const config::ResolvedCompound* const compound = turn.resolved(p);
            if (!work_.at(p).drawsItself || compound == nullptr || !compound->channel)
                continue;
            const auto share = shares[i].find({compound->channel->node, compound->channel->pipe});
            turn.usage[p] *= share == shares[i].end() ? 0 : share->second;
        }
    }
}

void View::record(const PlannedFrame& frame, const FrameTimes& times) {
    std::vector<double> loads;
    for (const std::size_t child : children_) {
        const auto cost = work_.cost(child, frame, times);
        if (!cost)
            return;
        double load = *cost;
        for (std::size_t p = child; p < work_.at(child).end && p < times.compounds.size(); ++p)
            load += known(times.compounds[p].assemble).value_or(0);
        loads.push_back(load);
    }
    const bool isFirst = std::ranges::all_of(loads_, [](double load) { return load == 0; });
    for (std::size_t i = 0; i < loads.size(); ++i)
        loads_[i] += (isFirst ? 1 : kNew) * (loads[i] - loads_[i]);
}

Report View::report() const {
    double longest = 0;
    double load = 0;
    double pipes = 0;
    for (std::size_t i = 0; i < children_.size(); ++i) {
        double share = 0;
        for (const auto& [pipe, each] : shares_[i]) share += each;
        if (!(share > 0))
            continue;
        longest = std::max(longest, loads_[i] / share);
        load += loads_[i];
        pipes += share;
    }
    return {.imbalance = load > 0 ? longest * pipes / load : 0};
}

}  // namespace eyrie::equalizer
