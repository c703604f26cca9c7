// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <queue>

#include <fmt/format.h>

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

/// Works in rings, each of which waits for the one after it, the last for the first. Of works that
/// wait, each is in one ring at most, and where any are left there is one.
class Rings {
public:
    explicit Rings(const Dependencies& dependencies) : awaited_(dependencies.open.size(), kNone) {
        for (std::size_t i = 0; i < awaited_.size(); ++i)
            if (dependencies.open[i] > 0)
                for (const std::size_t after : dependencies.next[i])
                    if (dependencies.open[after] > 0)
                        awaited_[after] = i;
    }

    std::vector<std::vector<std::size_t>> find() const {
        std::vector<std::vector<std::size_t>> rings;
        std::vector<std::size_t> walk(awaited_.size(), kNone);  // on which each was come by
        for (std::size_t start = 0; start < awaited_.size(); ++start) {
            std::size_t at = start;
            for (; awaited_[at] != kNone && walk[at] == kNone; at = awaited_[at]) walk[at] = start;
            if (awaited_[at] != kNone && walk[at] == start)
                rings.push_back(from(at));
        }
        return rings;
    }

private:
    static constexpr std::size_t kNone = ~std::size_t{0};

    std::vector<std::size_t> from(std::size_t work) const {
        std::vector<std::size_t> ring{work};
        for (std::size_t each = awaited_[work]; each != work; each = awaited_[each])
            ring.push_back(each);
        return ring;
    }

    std::vector<std::size_t> awaited_;  ///< of each work that waits, one of those that it waits for
};

/// Those that take or make frames in a ring, as written.
std::vector<std::size_t> compoundsOf(const std::vector<std::size_t>& ring, const WorkList& list) {
    std::vector<std::size_t> compounds;
    for (const std::size_t each : ring) {
        const Work& work = list.works[each];
        if (work.kind == Work::Kind::Assemble || work.kind == Work::Kind::ReadBack)
            compounds.push_back(work.compound);
    }
    std::ranges::sort(compounds);
    compounds.erase(std::unique(compounds.begin(), compounds.end()), compounds.end());
    return compounds;
}

/// The first few after the first.
std::string others(const std::vector<std::size_t>& compounds,
                   const config::ResolvedConfiguration& resolved) {
    constexpr std::size_t kMostNamed = 8;
    std::string text;
    for (std::size_t i = 1; i < std::min(compounds.size(), kMostNamed); ++i) {
        const config::ResolvedCompound& each = resolved.compounds[compounds[i]];
        const std::string place = describe(each.place());
        if (each.compound != nullptr && !each.compound->name.empty())
            text += fmt::format(", \"{}\"", each.compound->name);
        else if (!place.empty())
            text += ", one";
        text += place.empty() ? "" : fmt::format(" at {}", place);
    }
    if (compounds.size() > kMostNamed)
        text += fmt::format(" and {} more", compounds.size() - kMostNamed);
    return text;
}

void refuse(const std::vector<std::size_t>& ring, const config::ResolvedConfiguration& resolved,
            WorkList& list) {
    const std::vector<std::size_t> compounds = compoundsOf(ring, list);
    list.refusals.impossible.error(
        resolved.compounds[compounds.front()].place(),
        compounds.size() == 1
            ? "the compound takes a frame that it makes itself, once it has taken it"
            : fmt::format("compounds wait for each other's frames: this one{}; one of two that "
                          "exchange frames has to read back before it assembles, in a compound of "
                          "its own",
                          others(compounds, resolved)));
}

}  // namespace

std::vector<Work> inOrder(const config::ResolvedConfiguration& resolved, WorkList& list) {
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
        for (const std::vector<std::size_t>& ring : Rings(dependencies).find())
            refuse(ring, resolved, list);
    return ordered;
}

}  // namespace eyrie::compound
