// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/queue_names.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

using Names = std::unordered_set<std::string_view>;

Names namesOf(std::span<const ResolvedCompound> tree, std::vector<Tiles> Compound::*tiles) {
    Names names;
    for (const ResolvedCompound& each : tree)
        for (const Tiles& queue : each.compound->*tiles) names.insert(queue.name);
    return names;
}

/// Whether who takes tiles of their name takes the first one's.
bool areForTheSame(const ResolvedCompound& first, const ResolvedCompound& second) {
    return first.destination == second.destination && first.regriddings == second.regriddings &&
           first.subpixel == second.subpixel && meet(first, second);
}

/// As Equalizer, which leaves out the second, too.
void warnOfSecondQueues(std::span<const ResolvedCompound> tree, Findings& findings) {
    std::unordered_map<std::string_view, std::vector<const ResolvedCompound*>> makers;
    for (const ResolvedCompound& each : tree)
        for (const Tiles& tiles : each.compound->outputTiles) {
            std::vector<const ResolvedCompound*>& others = makers[tiles.name];
            const bool isTaken = std::ranges::any_of(
                others, [&](const ResolvedCompound* other) { return areForTheSame(*other, each); });
            if (isTaken)
                findings.warning(tiles.place, fmt::format("other outputtiles are named \"{}\" "
                                                          "already; these have no effect",
                                                          tiles.name));
            else
                others.push_back(&each);
        }
}

}  // namespace

void warnOfQueueNames(std::span<const ResolvedCompound> tree, Findings& findings) {
    const Names made = namesOf(tree, &Compound::outputTiles);
    const Names taken = namesOf(tree, &Compound::inputTiles);
    for (const ResolvedCompound& each : tree) {
        for (const Tiles& queue : each.compound->inputTiles)
            if (!made.contains(queue.name))
                findings.warning(queue.place,
                                 fmt::format("no outputtiles of this compound tree are named "
                                             "\"{}\": the compound draws all of its part",
                                             queue.name));
        for (const Tiles& queue : each.compound->outputTiles)
            if (!taken.contains(queue.name))
                findings.warning(queue.place,
                                 fmt::format("nobody takes the outputtiles \"{}\"", queue.name));
    }
    warnOfSecondQueues(tree, findings);
}

}  // namespace eyrie::config
