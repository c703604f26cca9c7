// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/lost_depth.h"

#include <algorithm>
#include <vector>

namespace eyrie::config {
namespace {

bool dividesItsData(const Compound& compound) {
    const auto areChunks = [](const Tiles& each) { return each.chunk.has_value(); };
    return std::ranges::any_of(compound.equalizers, dividesData) ||
           std::ranges::any_of(compound.outputTiles, areChunks);
}

}  // namespace

bool dividesData(const Equalizer& equalizer) {
    return equalizer.kind == EqualizerKind::Tile ? equalizer.tileChunk.has_value()
                                                 : equalizer.mode == SplitMode::Db;
}

std::vector<LostDepth> lostDepth(std::span<const ResolvedCompound> tree) {
    std::vector<LostDepth> lost;
    std::vector<bool> isDivided;  // by the compounds above and at each level
    for (const ResolvedCompound& each : tree) {
        isDivided.resize(static_cast<std::size_t>(each.depth));
        const bool isPart =
            each.range != fabric::Range{} || std::ranges::find(isDivided, true) != isDivided.end();
        isDivided.push_back(dividesItsData(*each.compound));
        if (!isPart || !each.tasks.readback)
            continue;
        for (const ResolvedFrame& frame : each.outputFrames)
            if (frame.isMatched && !frame.frame->buffers.value_or(each.buffers).depth)
                lost.push_back({&each, &frame});
    }
    return lost;
}

void warnOfLostDepth(std::span<const ResolvedCompound> tree, Findings& findings) {
    for (const LostDepth& each : lostDepth(tree))
        findings.warning(each.frame->frame->place,
                         "the outputframe has a part of the data and no DEPTH, so it covers what "
                         "is nearer; buffer [ COLOR DEPTH ] compares them");
}

}  // namespace eyrie::config
