// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/pipe_renderers.h"

#include <algorithm>
#include <set>
#include <unordered_map>

namespace eyrie::coordinator {

RendererOfPipe PipeRenderers::place(const std::vector<Pipe>& pipes,
                                    const std::vector<std::string>& renderers) {
    std::unordered_map<std::string, std::size_t> positions;
    for (std::size_t i = 0; i < renderers.size(); ++i) positions.emplace(renderers[i], i);
    std::erase_if(pairs_, [&](const Pair& pair) { return !positions.contains(pair.renderer); });

    const std::set<Pipe> wanted(pipes.begin(), pipes.end());
    std::set<Pipe> placed;
    std::vector<std::size_t> counts(renderers.size(), 0);
    for (const Pair& pair : pairs_) {
        placed.insert(pair.pipe);
        if (wanted.contains(pair.pipe))
            ++counts[positions.at(pair.renderer)];
    }
    for (const Pipe& pipe : pipes) {
        if (placed.contains(pipe))
            continue;
        const auto fewest = std::ranges::min_element(counts);
        ++*fewest;
        pairs_.push_back({pipe, renderers[static_cast<std::size_t>(fewest - counts.begin())]});
    }

    for (;;) {
        const auto [fewest, most] = std::ranges::minmax_element(counts);
        if (*most - *fewest < 2)
            break;
        const std::string& lender = renderers[static_cast<std::size_t>(most - counts.begin())];
        const auto lent = std::find_if(pairs_.rbegin(), pairs_.rend(), [&](const Pair& pair) {
            return pair.renderer == lender && wanted.contains(pair.pipe);
        });
        lent->renderer = renderers[static_cast<std::size_t>(fewest - counts.begin())];
        std::rotate(lent.base() - 1, lent.base(), pairs_.end());
        --*most;
        ++*fewest;
    }

    RendererOfPipe rendererOf;
    for (const Pair& pair : pairs_)
        if (wanted.contains(pair.pipe))
            rendererOf.emplace(pair.pipe, pair.renderer);
    return rendererOf;
}

}  // namespace eyrie::coordinator
