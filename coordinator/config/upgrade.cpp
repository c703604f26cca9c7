// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/upgrade.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace eyrie::config {
namespace {

bool hasDestination(const Compound& compound) {
    return std::holds_alternative<DestinationIndex>(compound.channel) ||
           std::ranges::any_of(compound.children, hasDestination);
}

bool showsBothEyes(const Compound& compound) {
    return (compound.eyes && (compound.eyes->left || compound.eyes->right)) ||
           std::ranges::any_of(compound.children, showsBothEyes);
}

/// Whether it draws into a channel that no view names.
bool isBare(const Compound& compound) {
    return std::holds_alternative<ChannelIndex>(compound.channel) && !hasDestination(compound);
}

class DestinationAdder {
public:
    explicit DestinationAdder(Configuration& configuration)
        : configuration_(configuration), first_(configuration.canvases.size()) {}

    void add(Compound& compound) {
        if (isBare(compound))
            return addAlone(compound);
        if (!std::holds_alternative<std::monostate>(compound.channel))
            return;
        std::vector<Compound*> parts;
        for (Compound& child : compound.children)
            if (isBare(child))
                parts.push_back(&child);
            else
                add(child);
        if (!parts.empty())
            addTogether(compound, parts);
    }

private:
    /// Trees of one channel and wall, such as each eye's, make one picture.
    void addAlone(Compound& compound) {
        const ChannelIndex channel = std::get<ChannelIndex>(compound.channel);
        std::size_t canvas = first_;
        const auto isIts = [&](const Canvas& made) {
            return made.segments.size() == 1 && made.segments[0].channel == channel &&
                   viewOf(made).surface == compound.surface;
        };
        while (canvas < configuration_.canvases.size() && !isIts(configuration_.canvases[canvas]))
            ++canvas;
        if (canvas == configuration_.canvases.size()) {
            View& view = viewOf(addCanvas(compound));
            view.surface = compound.surface;
            segmentOf(configuration_.canvases[canvas], channel, {}, {}, compound.place);
        }
        showOn(canvas, 0, compound);
        compound.surface = {};
    }

    /// The parts of a group share its wall: each is a segment with its own share of it.
    void addTogether(const Compound& group, const std::vector<Compound*>& parts) {
        const std::size_t canvas = configuration_.canvases.size();
        Canvas& made = addCanvas(group);
        made.surface = group.surface;
        for (Compound* part : parts) {
            const std::size_t segment = segmentOf(made, std::get<ChannelIndex>(part->channel),
                                                  part->viewport, part->surface, part->place);
            showOn(canvas, segment, *part);
            part->surface = {};
        }
    }

    /// That which there is already, if there is such.
    static std::size_t segmentOf(Canvas& canvas, const ChannelIndex& channel,
                                 const Viewport& viewport, const Surface& surface,
                                 const Place& place) {
        const auto found = std::ranges::find_if(canvas.segments, [&](const Segment& segment) {
            return segment.channel == channel && segment.viewport == viewport &&
                   segment.surface == surface;
        });
        const auto index = static_cast<std::size_t>(found - canvas.segments.begin());
        if (found == canvas.segments.end()) {
            Segment segment;
            segment.channel = channel;
            segment.viewport = viewport;
            segment.surface = surface;
            segment.place = place;
            canvas.segments.push_back(segment);
        }
        return index;
    }

    void showOn(std::size_t canvas, std::size_t segment, Compound& compound) {
        const Canvas& made = configuration_.canvases[canvas];
        viewOf(made).isStereo = viewOf(made).isStereo || showsBothEyes(compound);
        compound.viewport = {};
        compound.channel = DestinationIndex{canvas, segment, *made.layouts[0], 0};
    }

    View& viewOf(const Canvas& made) { return configuration_.layouts[*made.layouts[0]].views[0]; }

    Canvas& addCanvas(const Compound& compound) {
        View view;
        view.place = compound.place;
        Canvas canvas;
        canvas.layouts.push_back(configuration_.layouts.size());
        canvas.place = compound.place;
        configuration_.layouts.push_back({"", {view}, compound.place});
        return configuration_.canvases.emplace_back(std::move(canvas));
    }

    Configuration& configuration_;
    std::size_t first_;  ///< of the canvases made here
};

void addObserver(Configuration& configuration) {
    configuration.observers.emplace_back();
    for (Layout& layout : configuration.layouts)
        for (View& view : layout.views) view.observer = 0;
}

}  // namespace

void upgrade(Configuration& configuration) {
    const bool isOld = configuration.version == "1.0" || configuration.version == "1.1";
    if (!isOld && !configuration.canvases.empty())
        return;
    DestinationAdder adder(configuration);
    for (Compound& root : configuration.compounds) adder.add(root);
    if (configuration.observers.empty() && (isOld || !configuration.canvases.empty()))
        addObserver(configuration);
}

}  // namespace eyrie::config
