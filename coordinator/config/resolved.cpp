// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/resolved.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <unordered_map>

#include <fmt/format.h>

#include "coordinator/config/destinations.h"
#include "coordinator/config/idle_equalizers.h"
#include "coordinator/config/overlaps.h"
#include "coordinator/config/phases.h"
#include "coordinator/config/pixels.h"
#include "coordinator/config/queue_names.h"
#include "coordinator/config/sights.h"
#include "coordinator/config/tiny_zooms.h"
#include "coordinator/config/torn_pictures.h"
#include "coordinator/config/unseen.h"
#include "coordinator/config/unshown.h"

namespace eyrie::config {
namespace {

/// Every width-th of what `whole` has: of the columns x, x + w, x + 2w, … these of every rw-th.
PixelShare part(const PixelShare& whole, const PixelShare& share) {
    return {whole.x + whole.width * share.x, whole.y + whole.height * share.y,
            whole.width * share.width, whole.height * share.height};
}

SubPixelShare part(const SubPixelShare& whole, const SubPixelShare& share) {
    return {whole.index * share.count + share.index, whole.count * share.count};
}

Eyes both(const Eyes& a, const Eyes& b) {
    return {a.cyclop && b.cyclop, a.left && b.left, a.right && b.right};
}

fabric::Range part(const fabric::Range& whole, const fabric::Range& share) {
    const double size = whole.end - whole.begin;
    // The whole's own ends, however the sum is rounded: no data falls between two of its parts.
    return {share.begin <= 0 ? whole.begin : whole.begin + size * share.begin,
            share.end >= 1 ? whole.end : whole.begin + size * share.end};
}

/// The columns and rows of a share, side by side.
fabric::PixelViewport part(const fabric::PixelViewport& whole, const PixelShare& share) {
    const auto count = [](std::int32_t pixels, std::int64_t first, std::int64_t every) {
        return static_cast<std::int32_t>(
            std::max<std::int64_t>(0, (pixels - first + every - 1) / every));
    };
    return {whole.x, whole.y, count(whole.width, share.x, share.width),
            count(whole.height, share.y, share.height)};
}

/// Fractions are written with few digits: parts may add up to a little more than the whole.
fabric::PixelViewport partWithin(const fabric::PixelViewport& whole, const Viewport& fraction) {
    return fabric::intersection(whole, config::part(whole, fraction));
}

fabric::PixelViewport zoomed(const fabric::PixelViewport& whole, const fabric::Vec2& zoom) {
    const auto scaled = [](std::int32_t pixels, double by) {
        const double least = pixels > 0 ? 1 : 0;
        return static_cast<std::int32_t>(std::clamp(pixels * by + .5, least, 65536.0));
    };
    return {whole.x, whole.y, scaled(whole.width, zoom.x), scaled(whole.height, zoom.y)};
}

class Resolver {
public:
    Resolver(const Configuration& configuration, const Display& display, Findings& findings)
        : configuration_(configuration), findings_(findings) {
        resolved_.destinations = destinationsOf(configuration, display, findings);
        served_.resize(resolved_.destinations.size(), false);
        for (std::size_t i = 0; i < resolved_.destinations.size(); ++i)
            positions_.emplace(keyOf(resolved_.destinations[i].index), i);
    }

    ResolvedConfiguration run() {
        for (const Compound& root : configuration_.compounds) {
            const std::size_t first = resolved_.compounds.size();
            visit(root, nullptr);
            const auto tree = std::span(resolved_.compounds).subspan(first);
            if (isShown(tree))
                matchFrames(tree);
            warnOfUnshown(tree, findings_);
            warnOfQueueNames(tree, findings_);
            warnOfTornPictures(tree, findings_);
            warnOfTinyZooms(tree, findings_);
            warnOfIdleEqualizers(tree, findings_);
        }
        for (std::size_t i = 0; i < served_.size(); ++i)
            if (!served_[i])
                addImplicit(i);
        warnOfMissingPhases(resolved_, findings_);
        warnOfUnseen(configuration_, resolved_, findings_);
        noteOverlaps(configuration_, resolved_, findings_);
        return std::move(resolved_);
    }

private:
    using Inherited = ResolvedCompound;
    /// Names by which frames are called by default, from the root down.
    using Path = std::vector<const Compound*>;
    using Key = std::array<std::size_t, 4>;

    static Key keyOf(const DestinationIndex& index) {
        return {index.canvas, index.segment, index.layout, index.view};
    }

    void visit(const Compound& compound, const Inherited* parent) {
        path_.push_back(&compound);
        ResolvedCompound own = parent == nullptr ? atRoot() : *parent;
        own.compound = &compound;
        own.depth = static_cast<int>(path_.size()) - 1;
        own.outputFrames.clear();
        own.inputFrames.clear();
        own.sights.clear();
        takeChannel(compound, own);
        inherit(compound, own, parent != nullptr && parent->destination.has_value());
        Inherited passedOn = own;
        finish(compound, own);
        resolved_.compounds.push_back(own);
        for (const Compound& child : compound.children) visit(child, &passedOn);
        path_.pop_back();
        eyesSaid_.pop_back();
    }

    static ResolvedCompound atRoot() {
        ResolvedCompound root;
        root.eyes = {true, true, true};
        root.buffers = {true, false};
        return root;
    }

    void takeChannel(const Compound& compound, ResolvedCompound& own) {
        if (const auto* source = std::get_if<ChannelIndex>(&compound.channel)) {
            own.channel = *source;
            if (!own.destination && own.pixelViewport.isEmpty())
                own.pixelViewport = pixelsOf(configuration_, *source);
            return;
        }
        const auto* index = std::get_if<DestinationIndex>(&compound.channel);
        if (index == nullptr)
            return;
        const auto found = positions_.find(keyOf(*index));
        if (found == positions_.end())
            return findings_.error(compound.place,
                                   "the channel's view is not shown on its segment: no layout of "
                                   "the canvas has it, or they do not meet");
        own.channel = resolved_.destinations[found->second].channel;
        if (own.destination)
            return;  // within the picture of one destination another's channel is a helper
        takePicture(found->second, own);
        served_[*own.destination] = true;
    }

    /// All of a destination's picture, whatever compounds above it say.
    void takePicture(std::size_t destination, ResolvedCompound& own) const {
        const Destination& shown = resolved_.destinations[destination];
        own.destination = destination;
        own.channel = shown.channel;
        own.pixelViewport = shown.pixelViewport;
        own.regriddings.clear();
        own.area = {0, 0, shown.pixelViewport.width, shown.pixelViewport.height};
        own.viewport = {};
        own.pixel = {};
        own.zoom = {1, 1};
    }

    void inherit(const Compound& compound, ResolvedCompound& own, bool isPartOfPicture) {
        if (isPartOfPicture && own.pixelViewport.isEmpty()) {
            own.viewport = config::part(own.viewport, compound.viewport);
        } else {
            const fabric::PixelViewport whole = own.pixelViewport;
            own.pixelViewport = partWithin(whole, compound.viewport);
            own.area = partWithin(own.area, compound.viewport);
            own.viewport = config::part(own.viewport, own.pixelViewport.isEmpty()
                                                          ? compound.viewport
                                                          : fractionOf(own.pixelViewport, whole));
        }
        own.range = part(own.range, compound.range);
        takeShares(compound, own);
        if (compound.zoom != fabric::Vec2(1, 1))
            zoom(compound.zoom, own);
        own.period = compound.period.value_or(own.period);
        own.phase = compound.phase.value_or(own.phase);
        own.buffers = compound.buffers.value_or(own.buffers);
        if (compound.eyes)
            own.eyes = isPartOfPicture ? both(own.eyes, *compound.eyes) : *compound.eyes;
        sayEyes(compound, isPartOfPicture);
        if (own.destination && !isPartOfPicture)
            own.eyes = both(own.eyes, resolved_.destinations[*own.destination].eyes);
        takeWall(compound, own, isPartOfPicture);
        if (!own.destination)
            warnOfSharesAbove(compound);
        if (own.phase >= own.period)
            findings_.error(compound.place, fmt::format("phase {} of a period of {} frames: it "
                                                        "must be less",
                                                        own.phase, own.period));
    }

    /// Of what compounds say alone: which of it there is depends on the view's mode.
    void sayEyes(const Compound& compound, bool isPartOfPicture) {
        Eyes eyes = eyesSaid_.empty() ? atRoot().eyes : eyesSaid_.back();
        const bool hadEyes = !eyes.isEmpty();
        if (compound.eyes)
            eyes = isPartOfPicture ? both(eyes, *compound.eyes) : *compound.eyes;
        if (isPartOfPicture && hadEyes && eyes.isEmpty())
            findings_.warning(compound.place,
                              "none of the compound's eyes are among those of the compound above "
                              "it: it does nothing");
        eyesSaid_.push_back(eyes);
    }

    /// Within a destination's picture a compound may see another wall; the destination itself shows
    /// its view's or segment's.
    void takeWall(const Compound& compound, ResolvedCompound& own, bool isPartOfPicture) {
        const std::optional<Wall> wall = wallOf(compound.surface);
        if (wall && isPartOfPicture)
            own.wall = wall;
        else if (wall && namesDestination(compound))
            findings_.warning(compound.place,
                              "the compound's wall has no effect: views and segments have theirs");
    }

    /// Of a compound outside every picture with compounds in one below it.
    void warnOfSharesAbove(const Compound& compound) {
        if (!std::ranges::any_of(compound.children, namesDestination))
            return;
        const auto warn = [&](bool isSaid, std::string_view what) {
            if (isSaid)
                findings_.warning(compound.place,
                                  fmt::format("the compound's {} has no effect: it stands above "
                                              "compounds of views' pictures, not within one",
                                              what));
        };
        warn(compound.viewport != Viewport{}, "viewport");
        warn(compound.pixel != PixelShare{}, "pixel");
        warn(compound.zoom != fabric::Vec2(1, 1), "zoom");
    }

    void takeShares(const Compound& compound, ResolvedCompound& own) {
        constexpr std::int64_t kMost = 16384;  // columns, rows and samples; pictures have no more
        const PixelShare pixel = part(own.pixel, compound.pixel);
        const SubPixelShare subpixel = part(own.subpixel, compound.subpixel);
        if (pixel.width > kMost || pixel.height > kMost || subpixel.count > kMost)
            return findings_.error(
                compound.place,
                fmt::format("more than {} shares of pixels within each other", kMost));
        if (compound.pixel != PixelShare{}) {
            own.regriddings.push_back(fabric::everyNth(own.area, static_cast<int>(compound.pixel.x),
                                                       static_cast<int>(compound.pixel.width),
                                                       static_cast<int>(compound.pixel.y),
                                                       static_cast<int>(compound.pixel.height)));
            own.area = madeBy(own.regriddings.back());
        }
        own.pixelViewport = part(own.pixelViewport, compound.pixel);
        own.pixel = pixel;
        own.subpixel = subpixel;
    }

    static fabric::PixelViewport madeBy(const fabric::Regridding& regridding) {
        return {0, 0, regridding.width, regridding.height};
    }

    /// As exactly as whole pixels allow.
    static void zoom(const fabric::Vec2& by, ResolvedCompound& own) {
        const fabric::PixelViewport before = own.pixelViewport;
        own.pixelViewport = zoomed(before, by);
        if (!own.area.isEmpty() && !own.pixelViewport.isEmpty()) {
            own.regriddings.push_back({fabric::Regridding::Kind::Zoom, own.area,
                                       own.pixelViewport.width, own.pixelViewport.height});
            own.area = madeBy(own.regriddings.back());
        }
        if (before.isEmpty())
            own.zoom *= by;
        else
            own.zoom *= fabric::Vec2(static_cast<double>(own.pixelViewport.width) / before.width,
                                     static_cast<double>(own.pixelViewport.height) / before.height);
    }

    void finish(const Compound& compound, ResolvedCompound& own) {
        for (const Frame& frame : compound.outputFrames)
            own.outputFrames.push_back({nameOf(frame), false, &frame});
        for (const Frame& frame : compound.inputFrames)
            own.inputFrames.push_back({nameOf(frame), false, &frame});
        own.tasks = tasksOf(compound, own);
        warnOfUnusedFrames(compound);
        if (compound.tasks && compound.tasks->draw && !compound.children.empty())
            findings_.note(compound.place,
                           "'DRAW' has no effect here: where a compound has children, they draw");
        if (own.tasks.draw)
            addSights(configuration_, resolved_.destinations, own, findings_);
    }

    /// By default, as in Equalizer, that of the compound, else of the channel that does its tasks,
    /// else those of the compounds above it.
    std::string nameOf(const Frame& frame) const {
        if (!frame.name.empty())
            return frame.name;
        for (auto compound = path_.rbegin(); compound != path_.rend(); ++compound) {
            if (!(*compound)->name.empty())
                return "frame." + (*compound)->name;
            if (const std::string* const name = inheritedChannelName(compound);
                name != nullptr && !name->empty())
                return "frame." + *name;
        }
        return "frame";
    }

    /// Of the compound's channel or, where it names none, that of the nearest above it.
    const std::string* inheritedChannelName(Path::const_reverse_iterator compound) const {
        const auto named = std::find_if(compound, path_.rend(), [](const Compound* each) {
            return !std::holds_alternative<std::monostate>(each->channel);
        });
        return named == path_.rend() ? nullptr : channelName(**named);
    }

    const std::string* channelName(const Compound& compound) const {
        if (const auto* source = std::get_if<ChannelIndex>(&compound.channel))
            return &configuration_.nodes[source->node]
                        .pipes[source->pipe]
                        .windows[source->window]
                        .channels[source->channel]
                        .name;
        if (const auto* index = std::get_if<DestinationIndex>(&compound.channel)) {
            const auto found = positions_.find(keyOf(*index));
            return found == positions_.end() ? nullptr
                                             : &resolved_.destinations[found->second].name;
        }
        return nullptr;
    }

    /// Leaves alone draw. What is not said: they do; what begins is cleared, once a channel; what
    /// comes in is assembled, what goes out read back.
    Tasks tasksOf(const Compound& compound, const ResolvedCompound& own) const {
        const bool isLeaf = compound.children.empty();
        Tasks tasks = compound.tasks.value_or(
            Tasks{!isLeaf || !isChannelOfAncestor(own), isLeaf, true, true});
        tasks.draw = tasks.draw && isLeaf;
        tasks.assemble = tasks.assemble && !compound.inputFrames.empty();
        tasks.readback = tasks.readback && !compound.outputFrames.empty();
        if (!own.channel || own.pixelViewport.isEmpty() || own.range.isEmpty() ||
            own.eyes.isEmpty())
            return {};
        return tasks;
    }

    /// Frames whose tasks somebody left out.
    void warnOfUnusedFrames(const Compound& compound) {
        const auto warn = [this](const std::vector<Frame>& frames, const char* what) {
            for (const Frame& frame : frames) findings_.warning(frame.place, what);
        };
        if (compound.tasks && !compound.tasks->assemble)
            warn(compound.inputFrames,
                 "the compound's task has no ASSEMBLE: the inputframe has no effect");
        if (compound.tasks && !compound.tasks->readback)
            warn(compound.outputFrames,
                 "the compound's task has no READBACK: the outputframe stays empty");
    }

    bool isChannelOfAncestor(const ResolvedCompound& own) const {
        for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
            const Compound& ancestor = *path_[i];
            const auto* source = std::get_if<ChannelIndex>(&ancestor.channel);
            if (source != nullptr && *source == own.channel)
                return true;
            const auto* index = std::get_if<DestinationIndex>(&ancestor.channel);
            if (index != nullptr && own.destination &&
                resolved_.destinations[*own.destination].channel == own.channel)
                return true;
        }
        return false;
    }

    /// Names count within one tree; of several output frames with one name at one time, the first
    /// that is read back. Those of compounds outside every picture count for nothing.
    void matchFrames(std::span<ResolvedCompound> tree) {
        for (ResolvedCompound& compound : tree)
            for (ResolvedFrame& frame : compound.outputFrames) addOutput(compound, frame);
        for (ResolvedCompound& compound : tree)
            for (ResolvedFrame& frame : compound.inputFrames) takeOutputs(compound, frame);
        for (const Output& output : inOrder_)
            if (uncompared_.contains(output.frame->name))
                output.frame->isMatched = true;
            else if (!output.frame->isMatched)
                findings_.warning(
                    output.frame->frame->place,
                    fmt::format("nobody takes the outputframe \"{}\"", output.frame->name));
        outputs_.clear();
        inOrder_.clear();
        uncompared_.clear();
    }

    void takeOutputs(const ResolvedCompound& compound, ResolvedFrame& frame) {
        if (!compound.destination)
            return warnOfOutside(frame, "the inputframe has no effect");
        const std::vector<Output>& named = outputs_[frame.name];
        if (!named.empty() && !isCompared(named.size(), frame)) {
            frame.isMatched = true;
            uncompared_.insert(frame.name);
            return;
        }
        for (const Output& output : named)
            if (mayMeet(*output.compound, compound))
                frame.isMatched = output.frame->isMatched = true;
        if (!frame.isMatched)
            findings_.warning(
                frame.frame->place,
                named.empty()
                    ? fmt::format("no outputframe of this compound tree is named \"{}\"",
                                  frame.name)
                    : fmt::format("the outputframe \"{}\" is never drawn for an eye and in a frame "
                                  "in which it is taken here",
                                  frame.name));
    }

    void warnOfOutside(const ResolvedFrame& frame, std::string_view what) {
        findings_.warning(frame.frame->place,
                          fmt::format("{}: its compound is no part of a view's picture, as with "
                                      "channel ( segment 0 view 0 )",
                                      what));
    }

    void addOutput(const ResolvedCompound& compound, ResolvedFrame& frame) {
        if (!compound.destination)
            return warnOfOutside(frame, "the outputframe stays empty");
        std::vector<Output>& others = outputs_[frame.name];
        const bool isTaken = isCompared(others.size(), frame) &&
                             std::ranges::any_of(others, [&](const Output& other) {
                                 return other.compound->tasks.readback &&
                                        meet(*other.compound, compound) &&
                                        !areInTurn(*other.compound, compound);
                             });
        if (isTaken)
            findings_.warning(frame.frame->place,
                              fmt::format("another outputframe is named \"{}\" already; this one "
                                          "has no effect",
                                          frame.name));
        else
            others.push_back(inOrder_.emplace_back(Output{&compound, &frame}));
    }

    /// Whether a frame is still compared with so many others, of which there may be very many.
    bool isCompared(std::size_t others, const ResolvedFrame& frame) {
        const bool isFirst = compared_ <= kMostCompared;
        compared_ += others;
        if (compared_ > kMostCompared && isFirst)
            findings_.note(frame.frame->place,
                           fmt::format("frames of one name are compared with each other in up to "
                                       "{} pairs: from \"{}\" here on nobody looks whether they "
                                       "are drawn and taken in the same frames",
                                       kMostCompared, frame.name));
        return compared_ <= kMostCompared;
    }

    /// Whether they meet; of compounds that the view has no eyes for in its mode, in another mode.
    bool mayMeet(const ResolvedCompound& a, const ResolvedCompound& b) const {
        return !areInTurn(a, b) && (meet(a, b) || a.eyes.isEmpty() || b.eyes.isEmpty());
    }

    /// Of two layouts of one canvas, which shows one at a time.
    bool areInTurn(const ResolvedCompound& a, const ResolvedCompound& b) const {
        const DestinationIndex& first = resolved_.destinations[*a.destination].index;
        const DestinationIndex& second = resolved_.destinations[*b.destination].index;
        return first.canvas == second.canvas && first.layout != second.layout;
    }

    /// The plain picture of a view that no compound makes.
    void addImplicit(std::size_t destination) {
        const Destination& shown = resolved_.destinations[destination];
        ResolvedCompound plain = atRoot();
        takePicture(destination, plain);
        plain.eyes = shown.eyes;
        if (!plain.eyes.isEmpty() && !plain.pixelViewport.isEmpty())
            plain.tasks = {true, true, false, false};
        if (plain.tasks.draw)
            addSights(configuration_, resolved_.destinations, plain, findings_);
        resolved_.compounds.push_back(std::move(plain));
    }

    const Configuration& configuration_;
    Findings& findings_;
    ResolvedConfiguration resolved_;
    struct Output {
        const ResolvedCompound* compound;
        ResolvedFrame* frame;
    };

    std::map<Key, std::size_t> positions_;  ///< of destinations
    std::vector<bool> served_;              ///< destinations that a compound makes
    std::unordered_map<std::string, std::vector<Output>> outputs_;  ///< of the tree, by name
    std::vector<Output> inOrder_;                                   ///< the same
    static constexpr std::size_t kMostCompared = 1'000'000;         ///< pairs of frames
    std::set<std::string> uncompared_;  ///< names that are taken, of one tree
    std::size_t compared_ = 0;
    Path path_;
    std::vector<Eyes> eyesSaid_;  ///< by the compounds of the path, each within those above it
};

}  // namespace

bool meet(const ResolvedCompound& a, const ResolvedCompound& b) {
    const std::int64_t common = std::gcd(a.period, b.period);
    return a.phase % common == b.phase % common && !both(a.eyes, b.eyes).isEmpty();
}

ResolvedConfiguration resolve(const Configuration& configuration, Findings& findings) {
    return resolve(configuration, Display{}, findings);
}

ResolvedConfiguration resolve(const Configuration& configuration, const Display& display,
                              Findings& findings) {
    return Resolver(configuration, display, findings).run();
}

}  // namespace eyrie::config
