// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/upgrade.h"

#include <algorithm>
#include <utility>

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

class DestinationAdder {
public:
    explicit DestinationAdder(Configuration& configuration)
        : configuration_(configuration), first_(configuration.canvases.size()) {}

    /// Of the topmost compounds that have a channel.
    void add(Compound& compound) {
        if (std::holds_alternative<std::monostate>(compound.channel)) {
            for (Compound& child : compound.children) add(child);
        } else if (!hasDestination(compound)) {
            addFor(compound);
        }
    }

private:
    /// Trees of one channel and wall, such as each eye's, make one picture.
    void addFor(Compound& compound) {
        const ChannelIndex channel = std::get<ChannelIndex>(compound.channel);
        std::size_t canvas = first_;
        const auto isIts = [&](const Canvas& made) {
            return made.segments[0].channel == channel && viewOf(made).surface == compound.surface;
        };
        while (canvas < configuration_.canvases.size() && !isIts(configuration_.canvases[canvas]))
            ++canvas;
        if (canvas == configuration_.canvases.size())
            addCanvas(channel, compound);
        Canvas& made = configuration_.canvases[canvas];
        viewOf(made).isStereo = viewOf(made).isStereo || showsBothEyes(compound);
        compound.surface = {};
        compound.channel = DestinationIndex{canvas, 0, *made.layouts[0], 0};
    }

    View& viewOf(const Canvas& made) { return configuration_.layouts[*made.layouts[0]].views[0]; }

    void addCanvas(const ChannelIndex& channel, const Compound& compound) {
        View view;
        view.surface = compound.surface;
        view.place = compound.place;
        Segment segment;
        segment.channel = channel;
        segment.place = compound.place;
        Canvas canvas;
        canvas.layouts.push_back(configuration_.layouts.size());
        canvas.segments.push_back(segment);
        canvas.place = compound.place;
        configuration_.layouts.push_back({"", {view}, compound.place});
        configuration_.canvases.push_back(std::move(canvas));
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
    if (configuration.version != "1.0" && configuration.version != "1.1")
        return;
    DestinationAdder adder(configuration);
    for (Compound& root : configuration.compounds) adder.add(root);
    if (configuration.observers.empty())
        addObserver(configuration);
}

}  // namespace eyrie::config
