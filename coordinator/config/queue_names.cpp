// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/queue_names.h"

#include <string_view>
#include <unordered_set>

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
}

}  // namespace eyrie::config
