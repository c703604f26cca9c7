// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/monitor.h"

#include <algorithm>
#include <cmath>

#include "coordinator/config/pixels.h"

namespace eyrie::equalizer {
namespace {

constexpr double kLeastZoom = 1e-3;
constexpr double kMostZoom = 16;

/// Where on its layout a compound's picture lies; nothing where it has no destination.
std::optional<config::Viewport> placeOf(const Turn& turn, std::size_t position) {
    const config::ResolvedCompound* const compound = turn.resolved(position);
    if (compound == nullptr || !compound->destination || compound->pixelViewport.isEmpty())
        return std::nullopt;
    const config::Destination& destination =
        turn.facts.resolved.destinations[*compound->destination];
    const config::Segment& segment =
        turn.configuration.canvases[destination.index.canvas].segments[destination.index.segment];
    const config::Viewport place =
        config::part(config::part(segment.viewport, destination.viewport), compound->viewport);
    return place.width > 0 && place.height > 0 ? std::optional(place) : std::nullopt;
}

bool showsTheSame(const Turn& turn, std::size_t a, std::size_t b) {
    const config::DestinationIndex& first =
        turn.facts.resolved.destinations[*turn.resolved(a)->destination].index;
    const config::DestinationIndex& second =
        turn.facts.resolved.destinations[*turn.resolved(b)->destination].index;
    return first.layout == second.layout && first.view == second.view;
}

}  // namespace

void Monitor::apply(Turn& turn, const config::Equalizer&, bool isFrozen) {
    if (!isFrozen)
        frames_ = framesOf(turn);
    turn.monitored.insert(turn.monitored.end(), frames_.begin(), frames_.end());
}

std::vector<MonitoredFrame> Monitor::framesOf(const Turn& turn) const {
    std::vector<MonitoredFrame> found;
    const auto own = placeOf(turn, position_);
    if (!own)
        return found;
    const config::ResolvedCompound& monitor = *turn.resolved(position_);
    for (std::size_t i = 0; i < monitor.inputFrames.size(); ++i)
        for (const Source& source : sourcesOf(turn, monitor.inputFrames[i].name)) {
            const auto place = placeOf(turn, source.position);
            if (!place || !showsTheSame(turn, position_, source.position))
                continue;
            const fabric::PixelViewport& to = monitor.pixelViewport;
            const fabric::PixelViewport& from = turn.resolved(source.position)->pixelViewport;
            const auto zoom = [](double pixels, double share) {
                return std::clamp(pixels / share, kLeastZoom, kMostZoom);
            };
            found.push_back(
                {source.position, source.frame, position_, i,
                 fabric::Vec2(zoom(to.width / own->width, from.width / place->width),
                              zoom(to.height / own->height, from.height / place->height))});
        }
    return found;
}

std::vector<Monitor::Source> Monitor::sourcesOf(const Turn& turn, const std::string& name) const {
    std::size_t root = position_;
    while (root > 0 && turn.resolved(root)->depth > 0) --root;
    std::vector<Source> sources;
    for (std::size_t p = root; p < turn.work.at(root).end; ++p) {
        const config::ResolvedCompound* const compound = turn.resolved(p);
        if (compound == nullptr || p == position_ || !meet(*compound, *turn.resolved(position_)))
            continue;
        for (std::size_t i = 0; i < compound->outputFrames.size(); ++i)
            if (compound->outputFrames[i].name == name)
                sources.push_back({p, i});
    }
    return sources;
}

}  // namespace eyrie::equalizer
