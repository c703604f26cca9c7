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
    const auto own = placeOf(turn, position_);
    if (!own || isFrozen)
        return;
    const config::ResolvedCompound& monitor = *turn.resolved(position_);
    const std::size_t frames =
        std::min(monitor.inputFrames.size(), turn.live[position_]->inputFrames.size());
    for (std::size_t i = 0; i < frames; ++i) {
        const auto source = sourceOf(turn, monitor.inputFrames[i].name);
        const auto place = source ? placeOf(turn, source->position) : std::nullopt;
        if (!place || !showsTheSame(turn, position_, source->position))
            continue;
        const fabric::PixelViewport& to = monitor.pixelViewport;
        const fabric::PixelViewport& from = turn.resolved(source->position)->pixelViewport;
        const auto zoom = [](double pixels, double share) {
            return std::clamp(pixels / share, kLeastZoom, kMostZoom);
        };
        turn.live[source->position]->outputFrames[source->frame].zoom =
            fabric::Vec2(zoom(to.width / own->width, from.width / place->width),
                         zoom(to.height / own->height, from.height / place->height));
        if (std::ranges::none_of(zoomed_, [&](const Source& each) {
                return each.position == source->position && each.frame == source->frame;
            }))
            zoomed_.push_back(*source);
    }
}

/// The first of that name in the monitor's tree.
std::optional<Monitor::Source> Monitor::sourceOf(const Turn& turn, const std::string& name) const {
    std::size_t root = position_;
    while (root > 0 && turn.resolved(root)->depth > 0) --root;
    for (std::size_t p = root; p < turn.work.at(root).end; ++p) {
        const config::ResolvedCompound* const compound = turn.resolved(p);
        if (compound == nullptr || p == position_)
            continue;
        const std::size_t frames =
            std::min(compound->outputFrames.size(), turn.live[p]->outputFrames.size());
        for (std::size_t i = 0; i < frames; ++i)
            if (compound->outputFrames[i].name == name)
                return Source{p, i, turn.live[p]->outputFrames[i].zoom};
    }
    return std::nullopt;
}

void Monitor::switchOff(Turn& turn) {
    for (const Source& source : zoomed_)
        turn.live[source.position]->outputFrames[source.frame].zoom = source.written;
    zoomed_.clear();
}

}  // namespace eyrie::equalizer
