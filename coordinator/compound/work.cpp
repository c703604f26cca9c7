// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/work.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "coordinator/compound/jitter.h"
#include "coordinator/compound/queues.h"
#include "coordinator/compound/seen.h"
#include "coordinator/config/pixels.h"

namespace eyrie::compound {
namespace {

using config::ResolvedCompound;
using fabric::PixelViewport;
using fabric::Regridding;

bool has(const config::Eyes& eyes, Eye eye) {
    switch (eye) {
        case Eye::Left:
            return eyes.left;
        case Eye::Right:
            return eyes.right;
        case Eye::Cyclop:
            break;
    }
    return eyes.cyclop;
}

PixelViewport moved(const PixelViewport& area, const PixelViewport& by) {
    return {area.x + by.x, area.y + by.y, area.width, area.height};
}

/// In pixels of the view, which those of the destination are a part of.
Lattice latticeOf(const ResolvedCompound& compound, const config::Destination& destination) {
    Lattice lattice{compound.regriddings, compound.subpixel};
    if (!lattice.regriddings.empty())
        lattice.regriddings.front().of =
            moved(lattice.regriddings.front().of, destination.partOfPanorama);
    return lattice;
}

PixelViewport areaOf(const Lattice& lattice, const config::Destination& destination) {
    if (lattice.regriddings.empty())
        return destination.partOfPanorama;
    return {0, 0, lattice.regriddings.back().width, lattice.regriddings.back().height};
}

std::optional<Regridding> zoomOf(const std::optional<fabric::Vec2>& wanted,
                                 const PixelViewport& part) {
    const fabric::Vec2 zoom = wanted.value_or(fabric::Vec2(1, 1));
    if (zoom == fabric::Vec2(1, 1))
        return std::nullopt;
    const auto scaled = [](std::int32_t pixels, double by) {
        return static_cast<std::int32_t>(
            std::clamp(pixels * by + .5, 1.0, static_cast<double>(fabric::kMaxViewPixels)));
    };
    return Regridding{Regridding::Kind::Zoom, part, scaled(part.width, zoom.x),
                      scaled(part.height, zoom.y)};
}

std::optional<Placing> placingOf(const config::Frame& frame, const PixelViewport& whole) {
    if (frame.viewport == config::Viewport{} && !frame.zoom)
        return std::nullopt;
    return Placing{whole, config::part(whole, frame.viewport), frame.zoom};
}

/// One tree of compounds in one pass.
class TreeWalk {
public:
    TreeWalk(const config::Configuration& configuration,
             const config::ResolvedConfiguration& resolved, const PlanRequest& request,
             const Pass& pass, WorkList& list)
        : configuration_(configuration),
          resolved_(resolved),
          request_(request),
          pass_(pass),
          list_(list) {}

    /// From the root at `first`; returns where the next tree begins.
    std::size_t walk(std::size_t first) {
        findQueues(first);
        const std::size_t next = visit(first);
        for (const Waiting& waiting : waiting_) match(waiting);
        return next;
    }

private:
    /// A compound on the way down from the root.
    struct Level {
        std::optional<config::ChannelIndex> channel;
        std::optional<std::size_t> framebuffer;  ///< where it has a destination
        std::vector<Input> given;                ///< frames of children without a name
        std::size_t firstWork = 0;               ///< of what it and its children do
    };

    /// What one output frame makes: of those of one name, the first as they are written.
    struct Named {
        const config::ResolvedFrame* frame = nullptr;
        std::vector<std::size_t> frames;
    };

    struct Waiting {
        std::size_t work;
        std::size_t compound;
    };

    std::size_t visit(std::size_t index) {
        const ResolvedCompound& own = resolved_.compounds[index];
        std::size_t next = index + 1;
        if (!isActive(own)) {
            while (isBelow(next, own)) ++next;
            return next;
        }
        const bool isLeaf = !isBelow(next, own);
        levels_.push_back({own.channel, framebufferOf(own), {}, list_.works.size()});
        begin(index, isLeaf);
        while (isBelow(next, own)) next = visit(next);
        end(index);
        return next;
    }

    /// Those of the tree at `first`, and what each compound has of them.
    void findQueues(std::size_t first) {
        std::vector<QueueMaker> makers;
        std::vector<QueueTaker> takers;
        for (std::size_t i = first; i == first || isBelow(i, resolved_.compounds[first]);) {
            const std::size_t index = i++;
            const ResolvedCompound& own = resolved_.compounds[index];
            if (!isActive(own)) {
                while (isBelow(i, own)) ++i;
                continue;
            }
            if (own.compound == nullptr || !own.destination || !own.channel)
                continue;
            const Lattice lattice = latticeOf(own, resolved_.destinations[*own.destination]);
            for (const config::Tiles& each : own.compound->outputTiles)
                makers.push_back(
                    {&each, *own.destination, lattice, areaOnFramebuffer(own), own.range});
            if (own.tasks.draw && !isBelow(i, own))
                for (const config::Tiles& each : own.compound->inputTiles)
                    takers.push_back({index, each.name, *own.channel, *own.destination, lattice});
        }
        shares_ = queueShares(makers, takers, list_);
    }

    const QueueShare* shareOf(std::size_t compound) const {
        const auto found = shares_.find(compound);
        return found == shares_.end() ? nullptr : &found->second;
    }

    bool isBelow(std::size_t index, const ResolvedCompound& parent) const {
        return index < resolved_.compounds.size() &&
               resolved_.compounds[index].depth > parent.depth;
    }

    bool isActive(const ResolvedCompound& own) const {
        if (own.destination && !resolved_.destinations[*own.destination].isShown)
            return false;
        const auto period = static_cast<std::uint64_t>(own.period);
        return has(own.eyes, pass_.compounds) &&
               request_.frameNumber % period == static_cast<std::uint64_t>(own.phase);
    }

    std::optional<std::size_t> framebufferOf(const ResolvedCompound& own) {
        if (!own.destination || !own.channel)
            return std::nullopt;
        const config::Destination& destination = resolved_.destinations[*own.destination];
        WorkingBuffer wanted{*own.destination, pass_, latticeOf(own, destination), {}};
        wanted.framebuffer = {*own.channel, false, pass_.sight,
                              areaOf(wanted.lattice, destination)};
        wanted.framebuffer.isDestination =
            *own.channel == destination.channel && wanted.lattice == Lattice{};
        return list_.find(wanted);
    }

    PixelViewport areaOnFramebuffer(const ResolvedCompound& own) const {
        return own.regriddings.empty()
                   ? moved(own.area, resolved_.destinations[*own.destination].partOfPanorama)
                   : own.area;
    }

    void begin(std::size_t index, bool isLeaf) {
        const ResolvedCompound& own = resolved_.compounds[index];
        const std::optional<std::size_t> framebuffer = levels_.back().framebuffer;
        if (!framebuffer)
            return;
        if (own.tasks.readback)
            for (const config::ResolvedFrame& frame : own.outputFrames)
                named_.try_emplace(frame.name, Named{&frame, {}});
        if (own.tasks.clear && (isClearAsked(own) || !isBegunAbove(*framebuffer)))
            add(Work::Kind::Clear, index, *framebuffer, areaOnFramebuffer(own));
        if (own.tasks.draw && isLeaf)
            addDraw(index, *framebuffer);
    }

    static bool isClearAsked(const ResolvedCompound& own) {
        return own.compound != nullptr && own.compound->tasks.has_value();
    }

    /// Whether a compound above draws there too: clearing again would lose what its other children
    /// have drawn (as it does in Equalizer, whose 4-window.DB.2D.lb.eqc shows half of its model).
    bool isBegunAbove(std::size_t framebuffer) const {
        return std::ranges::any_of(
            levels_.begin(), std::prev(levels_.end()),
            [&](const Level& each) { return each.framebuffer == framebuffer; });
    }

    void addDraw(std::size_t index, std::size_t framebuffer) {
        const ResolvedCompound& own = resolved_.compounds[index];
        const config::Destination& destination = resolved_.destinations[*own.destination];
        const Surroundings surroundings = surroundingsOf(destination, own.wall);
        const absl::StatusOr<std::optional<fabric::Sight>> sight =
            seen(configuration_, request_, destination, surroundings, pass_.sight,
                 focusRatio(configuration_, request_.display, resolved_, destination));
        if (!sight.ok()) {
            list_.blind.try_emplace({*own.destination, pass_.compounds, pass_.sight},
                                    Blind{sight.status(), own.place()});
            return;
        }
        fabric::ChannelTask task;
        task.frameNumber = request_.frameNumber;
        task.viewWidth = surroundings.whole.width;
        task.viewHeight = surroundings.whole.height;
        task.pixelViewport = areaOnFramebuffer(own);
        task.range = own.range;
        task.sight = *sight;
        const Lattice& lattice = list_.framebuffers[framebuffer].lattice;
        if (lattice != Lattice{})
            task.raster = rasterAfter(surroundings.whole, lattice.regriddings,
                                      jitter(lattice.subpixel.index, lattice.subpixel.count));
        if (!isDrawable(own, task.viewWidth, task.viewHeight) ||
            (task.raster && !isDrawable(own, task.raster->width, task.raster->height)) ||
            !isWithinView(own, task))
            return;
        const QueueShare* const share = shareOf(index);
        if (share == nullptr)
            return addTask({*own.channel, index, task, framebuffer});
        for (const equalizer::Tile& tile : share->tiles) {
            task.pixelViewport = tile.pixelViewport;
            task.range = tile.range;
            addTask({*own.channel, index, task, framebuffer, share->queue});
        }
    }

    void addTask(const PlannedDraw& draw) {
        add(Work::Kind::Draw, draw.compound, draw.framebuffer, draw.task.pixelViewport).draw =
            list_.draws.size();
        list_.draws.push_back(draw);
    }

    /// Where every nth pixel is drawn at a zoom beyond n the first are outside the view.
    bool isWithinView(const ResolvedCompound& own, const fabric::ChannelTask& task) {
        if (!task.raster)
            return true;
        const absl::Status status = fabric::validate(*task.raster, task.viewWidth, task.viewHeight);
        if (!status.ok())
            list_.refusals.impossible.error(
                own.place(),
                fmt::format(
                    "what the compound's pixel, subpixel and zoom together make of its view "
                    "reaches beyond that: {}; zoom less, or where they are put together",
                    std::string(status.message())));
        return status.ok();
    }

    bool isDrawable(const ResolvedCompound& own, std::int32_t width, std::int32_t height) {
        if (width >= 1 && height >= 1 && width <= fabric::kMaxViewPixels &&
            height <= fabric::kMaxViewPixels)
            return true;
        const config::Destination& destination = resolved_.destinations[*own.destination];
        list_.refusals.tooLarge.error(
            own.place(),
            fmt::format("the picture that channel \"{}\" is a part of is {}x{} pixels; renderers "
                        "draw up to {} a side: ask for a smaller one",
                        destination.name, width, height, fabric::kMaxViewPixels));
        return false;
    }

    void end(std::size_t index) {
        const ResolvedCompound& own = resolved_.compounds[index];
        const Level level = std::move(levels_.back());
        levels_.pop_back();
        if (!level.framebuffer)
            return;
        const PixelViewport area = areaOnFramebuffer(own);
        if (own.tasks.assemble || !level.given.empty()) {
            add(Work::Kind::Assemble, index, *level.framebuffer, area).inputs = level.given;
            if (own.tasks.assemble)
                waiting_.push_back({list_.works.size() - 1, index});
        }
        if (own.tasks.readback)
            for (const config::ResolvedFrame& frame : own.outputFrames)
                addFrames(index, frame, *level.framebuffer, area);
        const bool isWithinAnother = std::ranges::any_of(
            levels_, [](const Level& above) { return above.framebuffer.has_value(); });
        if (own.outputFrames.empty() || !isWithinAnother)
            give(index, level, area);
    }

    /// One or, of one that takes tiles, one for each: others' tiles are between them.
    void addFrames(std::size_t index, const config::ResolvedFrame& frame, std::size_t framebuffer,
                   const PixelViewport& area) {
        const QueueShare* const share = shareOf(index);
        if (share == nullptr)
            return addFrame(index, frame, framebuffer, area, area);
        if (share->isOfRange && !share->tiles.empty())
            return addFrame(index, frame, framebuffer, share->area, share->area);
        for (const equalizer::Tile& tile : share->tiles)
            addFrame(index, frame, framebuffer, share->area, tile.pixelViewport);
    }

    void addFrame(std::size_t index, const config::ResolvedFrame& frame, std::size_t framebuffer,
                  const PixelViewport& area, const PixelViewport& drawn) {
        Named& named = named_.at(frame.name);
        const PixelViewport part =
            fabric::intersection(drawn, config::part(area, frame.frame->viewport));
        if (part.isEmpty() || named.frame != &frame)
            return;
        named.frames.push_back(list_.frames.size());
        const bool hasDepth =
            frame.frame->buffers.value_or(resolved_.compounds[index].buffers).depth;
        addReadBack(
            {framebuffer, part, zoomOf(frame.frame->zoom, part), hasDepth, index, frame.frame});
    }

    void addReadBack(const OutputFrame& frame) {
        add(Work::Kind::ReadBack, frame.compound, frame.framebuffer, frame.part).frame =
            list_.frames.size();
        list_.frames.push_back(frame);
    }

    /// What a compound makes in other pixels on the channel of one that it is part of, or of the
    /// destination, is brought into that one's, as if there were a frame.
    void give(std::size_t index, const Level& done, const PixelViewport& area) {
        const ResolvedCompound& own = resolved_.compounds[index];
        const std::size_t framebuffer = *done.framebuffer;
        if (area.isEmpty() || !isUsedSince(done.firstWork, framebuffer))
            return;
        const std::size_t frame = list_.frames.size();
        for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
            if (!level->framebuffer || level->channel != own.channel)
                continue;
            if (*level->framebuffer == framebuffer)
                return;
            addReadBack({framebuffer, area, std::nullopt, own.buffers.depth, index});
            level->given.push_back({frame});
            return;
        }
        const config::Destination& destination = resolved_.destinations[*own.destination];
        if (!(*own.channel == destination.channel))
            return;
        const std::size_t picture = list_.pictureOf(resolved_, *own.destination, pass_);
        if (picture == framebuffer)
            return;
        addReadBack({framebuffer, area, std::nullopt, own.buffers.depth, index});
        add(Work::Kind::Assemble, index, picture, destination.partOfPanorama).inputs = {
            Input{frame}};
    }

    bool isUsedSince(std::size_t work, std::size_t framebuffer) const {
        return std::any_of(
            list_.works.begin() + static_cast<std::ptrdiff_t>(work), list_.works.end(),
            [&](const Work& each) {
                return each.framebuffer == framebuffer &&
                       (each.kind == Work::Kind::Draw || each.kind == Work::Kind::Assemble);
            });
    }

    Work& add(Work::Kind kind, std::size_t compound, std::size_t framebuffer,
              const PixelViewport& part) {
        list_.works.push_back({kind, framebuffer, part, compound, 0, 0, {}});
        return list_.works.back();
    }

    void match(const Waiting& waiting) {
        for (const config::ResolvedFrame& frame :
             resolved_.compounds[waiting.compound].inputFrames) {
            const auto named = named_.find(frame.name);
            if (named == named_.end())
                continue;
            Work& work = list_.works[waiting.work];
            for (const std::size_t each : named->second.frames) {
                const bool withDepth = !frame.frame->buffers || frame.frame->buffers->depth;
                work.inputs.push_back(
                    {each, placingOf(*frame.frame, work.part), frame.frame, withDepth});
            }
        }
    }

    const config::Configuration& configuration_;
    const config::ResolvedConfiguration& resolved_;
    const PlanRequest& request_;
    const Pass pass_;
    WorkList& list_;
    std::vector<Level> levels_;
    std::unordered_map<std::string_view, Named> named_;
    std::vector<Waiting> waiting_;
    std::map<std::size_t, QueueShare> shares_;  ///< by compound
};

}  // namespace

const Blind* WorkList::blindOf(std::size_t framebuffer) const {
    const WorkingBuffer& shown = framebuffers[framebuffer];
    const auto found = blind.find({shown.destination, shown.pass.compounds, shown.pass.sight});
    return found == blind.end() ? nullptr : &found->second;
}

const fabric::ChannelTask* WorkList::drawOf(std::size_t framebuffer) const {
    const WorkingBuffer& shown = framebuffers[framebuffer];
    const auto found = std::ranges::find_if(draws, [&](const PlannedDraw& draw) {
        const WorkingBuffer& drawn = framebuffers[draw.framebuffer];
        return drawn.destination == shown.destination && drawn.pass == shown.pass;
    });
    return found == draws.end() ? nullptr : &found->task;
}

std::size_t WorkList::find(const WorkingBuffer& wanted) {
    const config::ChannelIndex& channel = wanted.framebuffer.channel;
    std::vector<std::size_t>& own =
        found_[{wanted.destination, wanted.pass.compounds, wanted.pass.sight, channel.node,
                channel.pipe, channel.window, channel.channel}];
    for (const std::size_t i : own)
        if (framebuffers[i].lattice == wanted.lattice)
            return i;
    own.push_back(framebuffers.size());
    framebuffers.push_back(wanted);
    return own.back();
}

std::size_t WorkList::pictureOf(const config::ResolvedConfiguration& resolved,
                                std::size_t destination, const Pass& pass) {
    const config::Destination& shown = resolved.destinations[destination];
    return find({destination, pass, {}, {shown.channel, true, pass.sight, shown.partOfPanorama}});
}

void addWork(const config::Configuration& configuration,
             const config::ResolvedConfiguration& resolved, const PlanRequest& request,
             const Pass& pass, WorkList& list) {
    for (std::size_t next = 0; next < resolved.compounds.size();)
        next = TreeWalk(configuration, resolved, request, pass, list).walk(next);
}

}  // namespace eyrie::compound
