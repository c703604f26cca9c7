// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/balancer.h"

#include <algorithm>

#include "coordinator/compound/equalizer/dfr.h"
#include "coordinator/compound/equalizer/framerate.h"
#include "coordinator/compound/equalizer/load.h"
#include "coordinator/compound/equalizer/monitor.h"
#include "coordinator/compound/equalizer/tiles.h"
#include "coordinator/compound/equalizer/tree.h"
#include "coordinator/compound/equalizer/view.h"

namespace eyrie::equalizer {

double Turn::resources(std::size_t position) const {
    double sum = 0;
    std::vector<config::ChannelIndex> counted;
    for (std::size_t p = position; p < work.at(position).end; ++p) {
        const config::ResolvedCompound* const compound = resolved(p);
        if (!work.at(p).drawsItself || !(usage[p] > 0) || compound == nullptr ||
            !compound->channel || std::ranges::find(counted, *compound->channel) != counted.end())
            continue;
        counted.push_back(*compound->channel);
        sum += usage[p];
    }
    return sum;
}

bool Turn::isAskedFor(const config::ResolvedCompound& compound) const {
    const std::vector<std::size_t>& canvases = facts.canvases;
    if (!compound.destination)
        return canvases.empty();
    const config::Destination& shown = facts.resolved.destinations[*compound.destination];
    return shown.isShown &&
           (canvases.empty() || std::ranges::find(canvases, shown.index.canvas) != canvases.end());
}

std::unique_ptr<Balancer> makeBalancer(const config::Equalizer& equalizer,
                                       const config::Compound& written, std::size_t position,
                                       const Work& work) {
    using Kind = config::EqualizerKind;
    switch (equalizer.kind) {
        case Kind::Load:
            break;
        case Kind::Tree:
            return std::make_unique<Tree>(written, position, work);
        case Kind::Dfr:
            return std::make_unique<Dfr>(written, position, work);
        case Kind::Tile:
            return std::make_unique<Tiles>(written, position, work);
        case Kind::View:
            return std::make_unique<View>(position, work);
        case Kind::Monitor:
            return std::make_unique<Monitor>(position);
        case Kind::Framerate:
            return std::make_unique<Framerate>(position, work);
    }
    return std::make_unique<Load>(written, position, work);
}

}  // namespace eyrie::equalizer
