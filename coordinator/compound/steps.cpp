// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/steps.h"

#include <algorithm>
#include <map>
#include <span>

#include <fmt/format.h>

#include "coordinator/compound/contents.h"
#include "coordinator/compound/frame_mapping.h"

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;

class StepMaker {
public:
    StepMaker(const config::ResolvedConfiguration& resolved, WorkList& list)
        : resolved_(resolved),
          list_(list),
          contents_(list.framebuffers.size()),
          frames_(list.frames.size()) {}

    void add(const Work& work) {
        switch (work.kind) {
            case Work::Kind::Clear:
                clear(work);
                break;
            case Work::Kind::Draw:
                draw(work);
                break;
            case Work::Kind::ReadBack:
                readBack(work);
                break;
            case Work::Kind::Assemble:
                assemble(work);
                break;
        }
    }

    StepList take() { return {std::move(steps_), std::move(contents_), std::move(frames_)}; }

private:
    void clear(const Work& work) {
        Contents& contents = contents_[work.framebuffer];
        if (!contents.met({work.part, {}, {}}))
            return;  // framebuffers begin empty
        contents.clear(work.part);
        steps_.emplace_back(Clear{work.framebuffer, work.part});
    }

    void draw(const Work& work) {
        const fabric::ChannelTask& task = list_.draws[work.draw].task;
        const Content content{work.part, task.range, {}};
        const auto met = contents_[work.framebuffer].met(content);
        const Combine combine = combineWith(met, content, met && contains(task.range, *met), true);
        steps_.emplace_back(Draw{work.framebuffer, work.draw, combine});
        contents_[work.framebuffer].add(content);
    }

    void readBack(const Work& work) {
        const OutputFrame& frame = list_.frames[work.frame];
        frames_[work.frame] = contents_[work.framebuffer].within(work.part);
        steps_.emplace_back(ReadBack{work.framebuffer, work.frame, work.part, false, frame.zoom});
    }

    static bool contains(const fabric::Range& outer, const fabric::Range& inner) {
        return outer.begin <= inner.begin && outer.end >= inner.end;
    }

    /// How what covers `content` comes over what it meets. `isComplete`: nothing of that is nearer.
    /// At equal depth the lower data are seen; of two that begin alike both know which those are,
    /// unless one has less of them at a pixel, as what children have left there.
    static Combine combineWith(const std::optional<fabric::Range>& met, const Content& content,
                               bool isComplete, bool hasDepth) {
        if (!met)
            return Combine::Over;
        if (isComplete || !hasDepth)
            return Combine::Replace;
        return content.range.begin <= met->begin ? Combine::NearerOrEqual : Combine::Nearer;
    }

    void assemble(const Work& work) {
        std::map<std::int64_t, std::vector<Input>> samples;
        std::vector<Input> direct;
        const config::SubPixelShare& own = latticeOf(work.framebuffer).subpixel;
        for (const Input& input : work.inputs) {
            const config::SubPixelShare& other =
                latticeOf(list_.frames[input.frame].framebuffer).subpixel;
            if (other == own)
                direct.push_back(input);
            else
                samples[other.index].push_back(input);
        }
        assembleAll(direct, work, work.framebuffer);
        if (!samples.empty())
            average(work, samples);
    }

    /// Every sample is a picture by itself; the framebuffer gets their mean.
    void average(const Work& work, const std::map<std::int64_t, std::vector<Input>>& samples) {
        Average mean;
        mean.framebuffer = work.framebuffer;
        bool hasDepth = true;
        for (const auto& [index, inputs] : samples) {
            const std::size_t sample = list_.framebuffers.size();
            list_.framebuffers.push_back(list_.framebuffers[work.framebuffer]);
            list_.framebuffers.back().framebuffer.isDestination = false;
            contents_.emplace_back();
            assembleAll(inputs, work, sample);
            for (const Input& each : inputs) hasDepth = hasDepth && isByDepth(each);
            mean.samples.push_back(sample);
        }
        const Content content = meanOf(mean.samples);
        if (content.area.isEmpty())
            return;
        Contents& target = contents_[work.framebuffer];
        const auto met = target.met(content);
        const bool isComplete = met && content.isFull && contains(content.range, *met);
        mean.part = content.area;
        mean.combine = combineWith(met, content, isComplete, hasDepth);
        if (mean.combine == Combine::Replace)
            target.clear(content.area);
        target.add(content);
        steps_.emplace_back(std::move(mean));
    }

    /// Around all that is in the samples.
    Content meanOf(const std::vector<std::size_t>& samples) const {
        Contents all;
        Content content;
        for (const std::size_t sample : samples)
            for (const Content& each : contents_[sample].all()) {
                all.add(each);
                content.area = fabric::enclosing(content.area, each.area);
            }
        content.range = all.range().value_or(fabric::Range{});
        content.isFull = std::ranges::all_of(samples, [&](std::size_t sample) {
            return contents_[sample].cover(content.area, content.range);
        });
        return content;
    }

    bool isByDepth(const Input& input) const {
        return list_.frames[input.frame].hasDepth && input.withDepth;
    }

    const Lattice& latticeOf(std::size_t framebuffer) const {
        return list_.framebuffers[framebuffer].lattice;
    }

    /// An input frame, and where it comes.
    struct Incoming {
        std::size_t frame;
        FrameMapping mapping;
        Content content;
        bool isBelow;  ///< its data comes before what is there, whatever it meets
        bool hasDepth;
        std::optional<PixelViewport> within = {};  ///< as Assemble::within
    };

    void assembleAll(const std::vector<Input>& inputs, const Work& work, std::size_t framebuffer) {
        std::vector<Incoming> incoming;
        for (const Input& input : inputs) {
            const std::size_t index = input.frame;
            const OutputFrame& frame = list_.frames[index];
            std::optional<FrameMapping> mapping = mappingOf(resolved_, list_, input, framebuffer);
            if (!mapping) {
                refuse(input, work);
                continue;
            }
            Content content{intersection(mapping->covered(frame.part),
                                         list_.framebuffers[framebuffer].framebuffer.area),
                            frames_[index].range().value_or(fabric::Range{}), mapping->everyNth(),
                            isFull(index, framebuffer, *mapping)};
            std::optional<PixelViewport> within;
            if (input.placing) {
                within = input.placing->part;
                content.area = intersection(content.area, *within);
            }
            const auto met = contents_[framebuffer].met(content);
            const bool isBelow = met && content.range.begin < met->begin;
            incoming.push_back(
                {index, *std::move(mapping), content, isBelow, isByDepth(input), within});
        }
        sortByRange(incoming);
        for (const Incoming& each : incoming) assembleOne(each, framebuffer);
    }

    void refuse(const Input& input, const Work& work) {
        const config::ResolvedCompound& taker = resolved_.compounds[work.compound];
        list_.refusals.impossible.error(
            input.written != nullptr ? input.written->place : taker.place(),
            fmt::format("an input frame for the picture of channel \"{}\" has pixels that are not "
                        "among those of the compound that takes it; take it where its pixel, "
                        "subpixel or zoom is split",
                        resolved_.destinations[*taker.destination].name));
    }

    /// Whether a frame with other pixels fills what it is brought to.
    bool isFull(std::size_t index, std::size_t framebuffer, const FrameMapping& mapping) const {
        const OutputFrame& frame = list_.frames[index];
        const WorkingBuffer& source = list_.framebuffers[frame.framebuffer];
        const auto range = frames_[index].range();
        if (source.destination != list_.framebuffers[framebuffer].destination || !range ||
            !frames_[index].cover(frame.part, *range))
            return false;
        if (frame.zoom)  // of the part alone
            return mapping.regriddings.size() == 1;
        return frame.part == source.framebuffer.area;
    }

    /// Away from what is there, so that what is there always has a range without gaps: those below
    /// it downwards, those above it upwards. Those without depth overwrite the others, as written.
    static void sortByRange(std::vector<Incoming>& incoming) {
        const auto rank = [](const Incoming& each) {
            if (!each.hasDepth)
                return 2;
            return each.isBelow ? 0 : 1;
        };
        std::ranges::stable_sort(incoming, [&](const Incoming& a, const Incoming& b) {
            if (rank(a) != rank(b))
                return rank(a) < rank(b);
            const double first = a.content.range.begin;
            const double second = b.content.range.begin;
            return rank(a) == 0 ? first > second : rank(a) == 1 && first < second;
        });
    }

    void assembleOne(const Incoming& incoming, std::size_t framebuffer) {
        const auto& [index, mapping, content, isBelow, hasDepth, within] = incoming;
        const OutputFrame& frame = list_.frames[index];
        const Contents& source = frames_[index];
        Contents& target = contents_[framebuffer];
        const auto met = target.met(content);
        // What was moved shows other things than what it meets.
        const bool isComplete = met && !within && contains(content.range, *met) &&
                                source.cover(frame.part, content.range);
        const Combine combine = combineWith(met, content, isComplete, hasDepth);
        if (content.area.isEmpty() || (source.all().empty() && combine != Combine::Replace))
            return;
        Assemble step{index,         framebuffer,   partOf(frame), mapping.regriddings,
                      mapping.fromX, mapping.fromY, combine};
        if (within && mapping.isIdentity())
            step.part = intersection(step.part, *within);
        else
            step.within = within;
        steps_.emplace_back(std::move(step));
        if (!mapping.isIdentity())
            return target.add(content);
        if (combine == Combine::Replace)
            target.clear(content.area);
        const Contents added = source.within(content.area);
        for (const Content& each : added.all()) target.add(each);
    }

    static PixelViewport partOf(const OutputFrame& frame) {
        return frame.zoom ? PixelViewport{0, 0, frame.zoom->width, frame.zoom->height} : frame.part;
    }

    const config::ResolvedConfiguration& resolved_;
    WorkList& list_;
    std::vector<Contents> contents_;  ///< of framebuffers
    std::vector<Contents> frames_;
    std::vector<Step> steps_;
};

}  // namespace

StepList stepsOf(const config::ResolvedConfiguration& resolved, const std::vector<Work>& works,
                 WorkList& list) {
    StepMaker maker(resolved, list);
    for (const Work& work : works) maker.add(work);
    return maker.take();
}

}  // namespace eyrie::compound
