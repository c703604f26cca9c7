// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/unseen.h"

#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "coordinator/config/pixels.h"

namespace eyrie::config {
namespace {

/// The compounds of one destination.
struct Makers {
    const ResolvedCompound* first = nullptr;
    Eyes made;
    bool isOnHead = false;  ///< some see a wall that moves with the head
};

Eyes either(const Eyes& a, const Eyes& b) {
    return {a.cyclop || b.cyclop, a.left || b.left, a.right || b.right};
}

Eyes both(const Eyes& a, const Eyes& b) {
    return {a.cyclop && b.cyclop, a.left && b.left, a.right && b.right};
}

Eyes without(const Eyes& a, const Eyes& b) {
    return {a.cyclop && !b.cyclop, a.left && !b.left, a.right && !b.right};
}

/// Those that read frames back which somebody takes, by the frames' names.
using Sources = std::unordered_map<std::string, std::vector<const ResolvedCompound*>>;

Sources sourcesOf(const ResolvedConfiguration& resolved) {
    Sources sources;
    for (const ResolvedCompound& each : resolved.compounds)
        for (const ResolvedFrame& output : each.outputFrames)
            if (output.isMatched && each.tasks.readback)
                sources[output.name].push_back(&each);
    return sources;
}

/// What a compound assembles of other destinations' frames. Of its own destination's there is what
/// draws it, and what no frame is for is told elsewhere.
Eyes assembled(const ResolvedCompound& taker, const Sources& sources) {
    Eyes eyes;
    for (const ResolvedFrame& input : taker.inputFrames) {
        if (!input.isMatched)
            return taker.eyes;
        const auto found = sources.find(input.name);
        if (found == sources.end())
            continue;
        for (const ResolvedCompound* const source : found->second)
            if (source->destination != taker.destination)
                eyes = either(eyes, both(taker.eyes, source->eyes));
    }
    return eyes;
}

std::vector<Makers> makersOf(const ResolvedConfiguration& resolved) {
    const Sources sources = sourcesOf(resolved);
    std::vector<Makers> makers(resolved.destinations.size());
    for (const ResolvedCompound& each : resolved.compounds) {
        if (!each.destination)
            continue;
        Makers& own = makers[*each.destination];
        if (own.first == nullptr)
            own.first = &each;
        if (each.tasks.draw) {
            own.made = either(own.made, each.eyes);
            const std::optional<Wall>& wall =
                each.wall ? each.wall : resolved.destinations[*each.destination].wall;
            own.isOnHead = own.isOnHead || (wall && wall->movesWithHead);
        }
        if (each.tasks.assemble)
            own.made = either(own.made, assembled(each, sources));
    }
    return makers;
}

/// A view on a canvas.
using Shown = std::tuple<std::size_t, std::size_t, std::size_t>;

Shown shownBy(const Destination& destination) {
    const DestinationIndex& index = destination.index;
    return {index.canvas, index.layout, index.view};
}

/// The destinations of each view, one for each segment that it is on.
std::map<Shown, std::vector<std::size_t>> segmentsOf(const ResolvedConfiguration& resolved) {
    std::map<Shown, std::vector<std::size_t>> segments;
    for (std::size_t i = 0; i < resolved.destinations.size(); ++i)
        segments[shownBy(resolved.destinations[i])].push_back(i);
    return segments;
}

/// Whether the segments lie over one another where the view is.
bool overlap(const Destination& a, const Destination& b, const Configuration& configuration) {
    const std::vector<Segment>& segments = configuration.canvases[a.index.canvas].segments;
    return overlap(
        intersection(segments[a.index.segment].viewport, segments[b.index.segment].viewport),
        configuration.layouts[a.index.layout].views[a.index.view].viewport);
}

std::string namesOf(const Eyes& eyes) {
    if (eyes.cyclop)
        return "CYCLOP";
    return fmt::format("{}{}{}", eyes.left ? "LEFT" : "", eyes.left && eyes.right ? " and " : "",
                       eyes.right ? "RIGHT" : "");
}

}  // namespace

void warnOfUnseen(const Configuration& configuration, const ResolvedConfiguration& resolved,
                  Findings& findings) {
    const std::vector<Makers> makers = makersOf(resolved);
    const std::map<Shown, std::vector<std::size_t>> segments = segmentsOf(resolved);
    for (std::size_t i = 0; i < makers.size(); ++i) {
        const Destination& shown = resolved.destinations[i];
        Eyes missing = without(shown.eyes, makers[i].made);
        if (makers[i].first == nullptr || missing.isEmpty() || shown.pixelViewport.isEmpty())
            continue;
        // One that makes nothing at all is not said to leave it to others.
        if (!makers[i].made.isEmpty())
            for (const std::size_t other : segments.at(shownBy(shown)))
                if (makers[i].isOnHead ||
                    overlap(shown, resolved.destinations[other], configuration))
                    missing = without(missing, makers[other].made);
        if (!missing.isEmpty())
            findings.warning(makers[i].first->place(),
                             fmt::format("no compound draws or assembles what the view shows, that "
                                         "of the eye {}: it is background",
                                         namesOf(missing)));
    }
}

}  // namespace eyrie::config
