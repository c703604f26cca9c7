// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/pipe_renderers.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <unordered_map>

namespace eyrie::coordinator {
namespace {

using Renderers = std::vector<config::RendererFacts>;
using Positions = std::vector<std::size_t>;  // of renderers

bool isFor(const config::RendererFacts& renderer, const config::Node& node) {
    return !renderer.host.empty() && (renderer.host == node.name || renderer.host == node.host);
}

/// Who may do the pipes of each node; the last entry is of nodes that are not known.
std::vector<Positions> candidatesOf(const Renderers& renderers,
                                    std::span<const config::Node> nodes) {
    std::vector<Positions> candidates(nodes.size() + 1);
    Positions anybody(renderers.size());
    std::iota(anybody.begin(), anybody.end(), 0);
    Positions free;
    for (const std::size_t i : anybody) {
        bool isFree = true;
        for (std::size_t node = 0; node < nodes.size(); ++node)
            if (isFor(renderers[i], nodes[node])) {
                candidates[node].push_back(i);
                isFree = false;
            }
        if (isFree)
            free.push_back(i);
    }
    for (Positions& each : candidates)
        if (each.empty())
            each = free.empty() ? anybody : free;
    return candidates;
}

/// How pipes are shared out at the moment.
class Shares {
public:
    Shares(const Renderers& renderers, std::span<const config::Node> nodes)
        : renderers_(renderers),
          candidates_(candidatesOf(renderers, nodes)),
          counts_(renderers.size(), 0) {
        for (std::size_t i = 0; i < renderers.size(); ++i) positions_.emplace(renderers[i].id, i);
    }

    bool mayDo(const std::string& id, const Pipe& pipe) const {
        const auto position = positions_.find(id);
        return position != positions_.end() &&
               std::ranges::binary_search(candidates(pipe), position->second);
    }

    void add(const std::string& id) { ++counts_[positions_.at(id)]; }
    void remove(const std::string& id) { --counts_[positions_.at(id)]; }

    /// Of those that may do the pipe, the one with the fewest.
    const std::string& fewest(const Pipe& pipe) const { return renderers_[fewestOf(pipe)].id; }
    /// Whether that has two less than `id`.
    bool isUneven(const std::string& id, const Pipe& pipe) const {
        return counts_[fewestOf(pipe)] + 2 <= counts_[positions_.at(id)];
    }

private:
    const Positions& candidates(const Pipe& pipe) const {
        return candidates_[std::min(pipe.node, candidates_.size() - 1)];
    }
    std::size_t fewestOf(const Pipe& pipe) const {
        return *std::ranges::min_element(candidates(pipe), {},
                                         [this](std::size_t i) { return counts_[i]; });
    }

    const Renderers& renderers_;
    const std::vector<Positions> candidates_;
    std::vector<std::size_t> counts_;
    std::unordered_map<std::string, std::size_t> positions_;
};

}  // namespace

RendererOfPipe PipeRenderers::place(const std::vector<Pipe>& pipes, const Renderers& renderers,
                                    std::span<const config::Node> nodes) {
    Shares shares(renderers, nodes);
    std::erase_if(pairs_,
                  [&](const Pair& pair) { return !shares.mayDo(pair.renderer, pair.pipe); });
    const std::set<Pipe> wanted(pipes.begin(), pipes.end());
    std::set<Pipe> placed;
    for (const Pair& pair : pairs_) {
        placed.insert(pair.pipe);
        if (wanted.contains(pair.pipe))
            shares.add(pair.renderer);
    }
    for (const Pipe& pipe : pipes)
        if (!placed.contains(pipe)) {
            pairs_.push_back({pipe, shares.fewest(pipe)});
            shares.add(pairs_.back().renderer);
        }
    const auto isTooMuch = [&](const Pair& pair) {
        return wanted.contains(pair.pipe) && shares.isUneven(pair.renderer, pair.pipe);
    };
    for (;;) {
        const auto lent = std::find_if(pairs_.rbegin(), pairs_.rend(), isTooMuch);
        if (lent == pairs_.rend())
            break;
        shares.remove(lent->renderer);
        lent->renderer = shares.fewest(lent->pipe);
        shares.add(lent->renderer);
        std::rotate(lent.base() - 1, lent.base(), pairs_.end());
    }
    RendererOfPipe rendererOf;
    for (const Pair& pair : pairs_)
        if (wanted.contains(pair.pipe))
            rendererOf.emplace(pair.pipe, pair.renderer);
    return rendererOf;
}

}  // namespace eyrie::coordinator
