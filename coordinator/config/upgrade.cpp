// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/upgrade.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace eyrie::config {
namespace {

/// Either eye, and not the one between them, which views have that are not stereo.
bool areTwo(const std::optional<Eyes>& eyes) {
    return eyes && (eyes->left || eyes->right) && !eyes->cyclop;
}

bool showsBothEyes(const Compound& compound) {
    return areTwo(compound.eyes) || std::ranges::any_of(compound.children, showsBothEyes);
}

/// Whether it draws into a channel that no view names.
bool isBare(const Compound& compound) {
    return std::holds_alternative<ChannelIndex>(compound.channel) && !namesDestination(compound);
}

class DestinationAdder {
public:
    explicit DestinationAdder(Configuration& configuration) : configuration_(configuration) {}

    /// What groups say for those in them that do not.
    struct Said {
        Surface surface;
        std::optional<Eyes> eyes;
    };

    void add(Compound& compound, const Said& above = {}) {
        const Said said{isSaid(compound.surface) ? compound.surface : above.surface,
                        compound.eyes ? compound.eyes : above.eyes};
        if (isBare(compound))
            return addAlone(compound, said);
        if (!std::holds_alternative<std::monostate>(compound.channel))
            return;
        std::vector<Compound*> parts;
        for (Compound& child : compound.children)
            if (isBare(child))
                parts.push_back(&child);
            else
                add(child, said);
        if (!parts.empty())
            addTogether(compound, said, parts);
    }

private:
    static bool isSaid(const Surface& surface) {
        return !std::holds_alternative<std::monostate>(surface);
    }

    /// Trees of one channel and wall, such as each eye's, make one picture.
    void addAlone(Compound& compound, const Said& said) {
        const ChannelIndex channel = std::get<ChannelIndex>(compound.channel);
        std::size_t canvas = 0;
        const auto isIts = [&](const Canvas& made) {
            return made.segments.size() == 1 && made.segments[0].channel == channel &&
                   viewOf(made).surface == said.surface;
        };
        while (canvas < configuration_.canvases.size() && !isIts(configuration_.canvases[canvas]))
            ++canvas;
        if (canvas == configuration_.canvases.size())
            viewOf(addCanvas(compound)).surface = said.surface;
        Compound alone = compound;
        alone.viewport = {};
        alone.surface = {};
        const std::size_t segment = segmentOf(configuration_.canvases[canvas], alone, said.eyes);
        showOn(canvas, segment, compound, said.eyes);
    }

    /// The parts of a group share its wall: each is a segment with its own share of it.
    void addTogether(Compound& group, const Said& said, const std::vector<Compound*>& parts) {
        const std::size_t canvas = configuration_.canvases.size();
        Canvas& made = addCanvas(group);
        made.surface = said.surface;
        for (Compound* part : parts) {
            const std::optional<Eyes> eyes = part->eyes ? part->eyes : said.eyes;
            showOn(canvas, segmentOf(made, *part, eyes), *part, eyes);
        }
        group.surface = {};
    }

    /// That which there is already, if there is such. It shows the eyes of all of its trees, and
    /// the one between them.
    static std::size_t segmentOf(Canvas& canvas, const Compound& tree,
                                 const std::optional<Eyes>& eyes) {
        Segment segment;
        segment.channel = std::get<ChannelIndex>(tree.channel);
        segment.viewport = tree.viewport;
        segment.surface = tree.surface;
        segment.place = tree.place;
        if (eyes)
            segment.eyes = {true, eyes->left, eyes->right};
        const auto found = std::ranges::find_if(canvas.segments, [&](const Segment& other) {
            return other.channel == segment.channel && other.viewport == segment.viewport &&
                   other.surface == segment.surface;
        });
        if (found == canvas.segments.end()) {
            canvas.segments.push_back(segment);
            return canvas.segments.size() - 1;
        }
        found->eyes.left = found->eyes.left || segment.eyes.left;
        found->eyes.right = found->eyes.right || segment.eyes.right;
        return static_cast<std::size_t>(found - canvas.segments.begin());
    }

    void showOn(std::size_t canvas, std::size_t segment, Compound& compound,
                const std::optional<Eyes>& eyes) {
        const Canvas& made = configuration_.canvases[canvas];
        viewOf(made).isStereo = viewOf(made).isStereo || areTwo(eyes) || showsBothEyes(compound);
        compound.viewport = {};
        compound.surface = {};
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
};

void addObserver(Configuration& configuration) {
    configuration.observers.emplace_back();
    for (Layout& layout : configuration.layouts)
        for (View& view : layout.views) view.observer = 0;
}

}  // namespace

void upgrade(Configuration& configuration) {
    if (configuration.canvases.empty()) {
        DestinationAdder adder(configuration);
        for (Compound& root : configuration.compounds) adder.add(root);
    }
    if (configuration.observers.empty())
        addObserver(configuration);
}

}  // namespace eyrie::config
