// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <queue>

#include "coordinator/compound/work.h"

// Of works that wait for nothing the first comes first. After A. B. Kahn, "Topological sorting of
// large networks" (1962).

namespace eyrie::compound {
namespace {

struct Dependencies {
    std::vector<std::size_t> open;               ///< of each work, how many it waits for
    std::vector<std::vector<std::size_t>> next;  ///< of each work, those that wait for it

    explicit Dependencies(const WorkList& list)
        : open(list.works.size(), 0), next(list.works.size()) {
        std::vector<std::optional<std::size_t>> last(list.framebuffers.size());
        std::vector<std::size_t> maker(list.frames.size(), 0);
        for (std::size_t i = 0; i < list.works.size(); ++i) {
            const Work& work = list.works[i];
            std::optional<std::size_t>& before = last[work.framebuffer];
            if (before)
                add(*before, i);
            before = i;
            if (work.kind == Work::Kind::ReadBack)
                maker[work.frame] = i;
        }
        for (std::size_t i = 0; i < list.works.size(); ++i)
            for (const Input& input : list.works[i].inputs) add(maker[input.frame], i);
    }

private:
    void add(std::size_t before, std::size_t after) {
        next[before].push_back(after);
        ++open[after];
    }
};

}  // namespace

absl::StatusOr<std::vector<Work>> inOrder(const WorkList& list) {
    Dependencies dependencies(list);
    std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> ready;
    for (std::size_t i = 0; i < list.works.size(); ++i)
        if (dependencies.open[i] == 0)
            ready.push(i);
    std::vector<Work> ordered;
    while (!ready.empty()) {
        const std::size_t each = ready.top();
        ready.pop();
        ordered.push_back(list.works[each]);
        for (const std::size_t after : dependencies.next[each])
            if (--dependencies.open[after] == 0)
                ready.push(after);
    }
    if (ordered.size() < list.works.size())
        return absl::InvalidArgumentError(
            "compounds wait for each other's frames: one of two that exchange frames has to read "
            "back before it assembles, in a compound of its own");
    return ordered;
}

}  // namespace eyrie::compound
