// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/upgrade.h"

#include <algorithm>
#include <map>
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

    /// Groups say what surface those in them have that do not.
    void add(Compound& compound, const Surface& above = {}) {
        const Surface& surface = isSaid(compound.surface) ? compound.surface : above;
        if (isBare(compound))
            return addAlone(compound, surface);
        if (!std::holds_alternative<std::monostate>(compound.channel))
            return;
        std::vector<Compound*> parts;
        for (Compound& child : compound.children)
            if (isBare(child))
                parts.push_back(&child);
            else
                add(child, surface);
        if (!parts.empty())
            addTogether(compound, surface, parts);
    }

private:
    static bool isSaid(const Surface& surface) {
        return !std::holds_alternative<std::monostate>(surface);
    }

    /// Trees of one channel and wall, such as each eye's, make one picture.
    void addAlone(Compound& compound, const Surface& surface) {
        const ChannelIndex channel = std::get<ChannelIndex>(compound.channel);
        std::size_t canvas = 0;
        const auto isIts = [&](const Canvas& made) {
            return made.segments.size() == 1 && made.segments[0].channel == channel &&
                   viewOf(made).surface == surface;
        };
        while (canvas < configuration_.canvases.size() && !isIts(configuration_.canvases[canvas]))
            ++canvas;
        if (canvas == configuration_.canvases.size())
            viewOf(addCanvas(compound)).surface = surface;
        Compound alone = compound;
        alone.viewport = {};
        alone.surface = {};
        showOn(canvas, segmentOf(configuration_.canvases[canvas], alone), compound);
    }

    /// The parts of a group share its wall: each is a segment with its own share of it.
    void addTogether(Compound& group, const Surface& surface, const std::vector<Compound*>& parts) {
        const std::size_t canvas = configuration_.canvases.size();
        Canvas& made = addCanvas(group);
        made.surface = surface;
        for (Compound* part : parts) showOn(canvas, segmentOf(made, *part), *part);
        group.surface = {};
    }

    /// That which there is already, if there is such.
    static std::size_t segmentOf(Canvas& canvas, const Compound& tree) {
        Segment segment;
        segment.channel = std::get<ChannelIndex>(tree.channel);
        segment.viewport = tree.viewport;
        segment.surface = tree.surface;
        segment.place = tree.place;
        const auto found = std::ranges::find_if(canvas.segments, [&](const Segment& other) {
            return other.channel == segment.channel && other.viewport == segment.viewport &&
                   other.surface == segment.surface;
        });
        if (found == canvas.segments.end()) {
            canvas.segments.push_back(segment);
            return canvas.segments.size() - 1;
        }
        return static_cast<std::size_t>(found - canvas.segments.begin());
    }

    void showOn(std::size_t canvas, std::size_t segment, Compound& compound) {
        const Canvas& made = configuration_.canvases[canvas];
        viewOf(made).isStereo = viewOf(made).isStereo || showsBothEyes(compound);
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

/// A compound's eyes, or those of the nearest group above it that says any.
struct SaidEyes {
    std::optional<Eyes> eyes;
    Compound* by = nullptr;
};

/// Has views and segments show the eyes that compounds alone say.
class EyesTeller {
public:
    explicit EyesTeller(Configuration& configuration) : configuration_(configuration) {}

    void tell(Compound& compound, const SaidEyes& above = {}) {
        const SaidEyes said = compound.eyes ? SaidEyes{compound.eyes, &compound} : above;
        if (const auto* shown = std::get_if<DestinationIndex>(&compound.channel))
            return show(*shown, said);
        if (std::holds_alternative<std::monostate>(compound.channel))
            for (Compound& child : compound.children) tell(child, said);
    }

    /// Segments show the eyes of all of their trees, and the one between them; those that say
    /// theirs keep them.
    void tellSegments() {
        for (const auto& [index, eyes] : ofSegments_) {
            Eyes& own = configuration_.canvases[index.first].segments[index.second].eyes;
            if (own == Segment{}.eyes)
                own = {true, eyes.left, eyes.right};
        }
    }

private:
    void show(const DestinationIndex& index, const SaidEyes& said) {
        if (areTwo(said.eyes)) {
            configuration_.layouts[index.layout].views[index.view].isStereo = true;
            said.by->eyes->cyclop = true;
        }
        const Eyes eyes = said.eyes.value_or(Segment{}.eyes);
        Eyes& ofSegment = ofSegments_[{index.canvas, index.segment}];
        ofSegment.left = ofSegment.left || eyes.left;
        ofSegment.right = ofSegment.right || eyes.right;
    }

    Configuration& configuration_;
    std::map<std::pair<std::size_t, std::size_t>, Eyes> ofSegments_;  ///< by canvas and segment
};

void addObserver(Configuration& configuration) {
    configuration.observers.emplace_back();
    for (Layout& layout : configuration.layouts)
        for (View& view : layout.views) view.observer = 0;
}

}  // namespace

void upgrade(Configuration& configuration) {
    const bool hadNoCanvas = configuration.canvases.empty();
    if (hadNoCanvas) {
        DestinationAdder adder(configuration);
        for (Compound& root : configuration.compounds) adder.add(root);
    }
    if (hadNoCanvas || configuration.version.empty() || configuration.version == "1.0") {
        EyesTeller teller(configuration);
        for (Compound& root : configuration.compounds) teller.tell(root);
        teller.tellSegments();
    }
    if (configuration.observers.empty())
        addObserver(configuration);
}

}  // namespace eyrie::config
