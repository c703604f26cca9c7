// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/exchange.h"

#include <algorithm>
#include <deque>
#include <set>
#include <utility>

namespace eyrie::compound {
namespace {

using fabric::Merge;

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);

std::size_t framebufferOf(const Step& step) {
    return std::visit([](const auto& each) { return each.framebuffer; }, step);
}

Merge mergeOf(Combine combine) {
    switch (combine) {
        case Combine::Nearer:
            return Merge::DepthBehind;
        case Combine::NearerOrEqual:
            return Merge::DepthBefore;
        case Combine::Over:
        case Combine::Replace:
            break;
    }
    return Merge::Paste;
}

/// Which steps go into programs, and from which framebuffer.
class Division {
public:
    explicit Division(const Plan& plan) : plan_(plan), last_(plan.framebuffers.size(), 0) {
        for (std::size_t i = 0; i < plan.steps.size(); ++i)
            if (std::holds_alternative<ReadBack>(plan.steps[i]) ||
                !plan.framebuffers[framebufferOf(plan.steps[i])].isDestination)
                last_[framebufferOf(plan.steps[i])] = i + 1;
    }

    bool isInProgram(std::size_t step) const {
        return step < last_[framebufferOf(plan_.steps[step])];
    }

private:
    const Plan& plan_;
    std::vector<std::size_t> last_;  ///< of each framebuffer, past its program's last step
};

/// One program in the making.
struct Draft {
    std::size_t framebuffer = 0;
    PlannedProgram planned;
    bool isBegun = false;
    std::set<std::size_t> taken;  ///< frames

    fabric::ProgramStage& stage() {
        if (planned.program.stages.empty())
            planned.program.stages.emplace_back();
        return planned.program.stages.back();
    }
    fabric::ProgramStage& next() { return planned.program.stages.emplace_back(); }
};

class Divider {
public:
    Divider(const Plan& plan, std::uint64_t frameNumber)
        : plan_(plan),
          frameNumber_(frameNumber),
          division_(plan),
          programOf_(plan.framebuffers.size(), kNowhere),
          takers_(plan.frames),
          hasDepth_(plan.frames, false) {}

    std::optional<Exchange> divide() {
        findTakers();
        if (std::ranges::any_of(plan_.steps, [](const Step& step) {
                return std::holds_alternative<Average>(step);
            }))
            return std::nullopt;
        for (std::size_t i = 0; i < plan_.steps.size(); ++i)
            if (division_.isInProgram(i) &&
                !std::visit([&](const auto& s) { return add(s); }, plan_.steps[i]))
                return std::nullopt;
        if (!isExchanged_ || !arePicturesHere())
            return std::nullopt;
        leaveTheRest();
        for (Draft& draft : drafts_) exchange_.programs.push_back(std::move(draft.planned));
        return std::move(exchange_);
    }

private:
    /// Who assembles a frame, and how much of it.
    struct Taker {
        std::optional<std::size_t> framebuffer;  ///< of a program; none: here
        fabric::PixelViewport part;
    };
    void findTakers() {
        for (std::size_t i = 0; i < plan_.steps.size(); ++i)
            if (const auto* const step = std::get_if<Assemble>(&plan_.steps[i]))
                takers_[step->frame].push_back(
                    {division_.isInProgram(i) ? std::optional(step->framebuffer) : std::nullopt,
                     step->part});
    }

    Draft& draftOf(std::size_t framebuffer) {
        std::size_t& index = programOf_[framebuffer];
        if (index == kNowhere) {
            index = drafts_.size();
            Draft& draft = drafts_.emplace_back();
            draft.framebuffer = framebuffer;
            draft.planned.channel = plan_.framebuffers[framebuffer].channel;
            draft.planned.program.frameNumber = frameNumber_;
            draft.planned.program.area = plan_.framebuffers[framebuffer].area;
        }
        return drafts_[index];
    }

    bool add(const Clear& step) { return !draftOf(step.framebuffer).isBegun; }

    bool add(const Draw& step) {
        Draft& draft = draftOf(step.framebuffer);
        const bool isFirst = !std::exchange(draft.isBegun, true);
        const fabric::ChannelTask& task = plan_.draws[step.draw].task;
        fabric::ChannelProgram& program = draft.planned.program;
        program.hasDepth = program.hasDepth || task.wantsDepth;
        if (!isFirst && !(step.combine == Combine::Nearer && task.wantsDepth))
            return false;
        fabric::ProgramStage& stage = isFirst ? draft.stage() : draft.next();
        stage.draw = task;
        draft.planned.draws.push_back(step.draw);
        return true;
    }

    bool add(const ReadBack& step) {
        Draft& draft = draftOf(step.framebuffer);
        draft.isBegun = true;
        if (step.zoom)
            return false;
        fabric::ChannelProgram& program = draft.planned.program;
        program.hasDepth = program.hasDepth || step.withDepth;
        hasDepth_[step.frame] = step.withDepth;
        for (const auto& [taker, wanted] : takers_[step.frame]) {
            if (taker == step.framebuffer)
                return false;
            const fabric::PixelViewport part =
                taker ? fabric::intersection(step.part, wanted) : step.part;
            draft.stage().outputs.push_back(
                {static_cast<std::uint32_t>(step.frame), part, step.withDepth, ""});
            std::optional<std::size_t> reader;
            if (taker) {
                draftOf(*taker);
                reader = programOf_[*taker];
                isExchanged_ = true;
            } else {
                answers_.push_back(
                    {programOf_[step.framebuffer], step.frame, part, step.withDepth, kNowhere});
            }
            drafts_[programOf_[step.framebuffer]].planned.takers.push_back(reader);
        }
        return true;
    }

    bool add(const Assemble& step) {
        if (!step.regriddings.empty() || step.fromX != 0 || step.fromY != 0)
            return false;
        Draft& draft = draftOf(step.framebuffer);
        draft.isBegun = true;
        if (!draft.taken.insert(step.frame).second)
            return false;
        const Merge merge = mergeOf(step.combine);
        fabric::ChannelProgram& program = draft.planned.program;
        program.hasDepth = program.hasDepth || merge != Merge::Paste || hasDepth_[step.frame];
        fabric::ProgramStage& stage = draft.stage().outputs.empty() ? draft.stage() : draft.next();
        stage.inputs.push_back({static_cast<std::uint32_t>(step.frame), step.part, merge});
        return true;
    }

    bool add(const Average&) { return false; }

    /// All that is shown is put together by the coordinator.
    bool arePicturesHere() const {
        const auto isHere = [&](const PicturePart& part) {
            return plan_.framebuffers[part.framebuffer].isDestination;
        };
        return std::ranges::all_of(plan_.pictures, [&](const Picture& picture) {
            return std::ranges::all_of(picture.parts, isHere) &&
                   std::ranges::all_of(picture.right, isHere);
        });
    }

    /// What a program leaves in a destination's framebuffer is an answer, too.
    void answerDestinations() {
        for (std::size_t i = 0; i < drafts_.size(); ++i) {
            Draft& draft = drafts_[i];
            if (!plan_.framebuffers[draft.framebuffer].isDestination)
                continue;
            fabric::ChannelProgram& program = draft.planned.program;
            const std::size_t frame = plan_.frames + i;
            draft.stage().outputs.push_back(
                {static_cast<std::uint32_t>(frame), program.area, program.hasDepth, ""});
            draft.planned.takers.push_back(std::nullopt);
            answers_.push_back({i, frame, program.area, program.hasDepth, draft.framebuffer});
        }
    }

    void leaveTheRest() {
        answerDestinations();
        Plan& rest = exchange_.rest;
        rest.framebuffers = plan_.framebuffers;
        rest.frames = plan_.frames;
        rest.pictures = plan_.pictures;
        std::vector<Step> steps;
        for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
            if (division_.isInProgram(i))
                continue;
            Step step = plan_.steps[i];
            if (auto* const draw = std::get_if<Draw>(&step)) {
                exchange_.draws.push_back(draw->draw);
                rest.draws.push_back(plan_.draws[draw->draw]);
                draw->draw = rest.draws.size() - 1;
            }
            steps.push_back(std::move(step));
        }
        // By programs, as the answers come.
        std::ranges::stable_sort(answers_, {}, &Answer::program);
        for (const Answer& answer : answers_) take(answer);
        rest.steps.insert(rest.steps.end(), steps.begin(), steps.end());
    }

    struct Answer {
        std::size_t program;
        std::size_t frame;
        fabric::PixelViewport part;
        bool withDepth;
        std::size_t framebuffer;  ///< that it is the beginning of; kNowhere: it is a frame
    };

    void take(const Answer& answer) {
        Plan& rest = exchange_.rest;
        PlannedDraw& arrived = rest.draws.emplace_back();
        arrived.task.pixelViewport = answer.part;
        arrived.task.wantsDepth = answer.withDepth;
        const std::size_t draw = rest.draws.size() - 1;
        std::size_t framebuffer = answer.framebuffer;
        if (framebuffer == kNowhere) {
            framebuffer = rest.framebuffers.size();
            rest.framebuffers.emplace_back().area = answer.part;
        }
        rest.steps.emplace_back(Draw{framebuffer, draw, Combine::Over});
        if (answer.framebuffer == kNowhere)
            rest.steps.emplace_back(
                ReadBack{framebuffer, answer.frame, answer.part, answer.withDepth, {}});
    }

    const Plan& plan_;
    const std::uint64_t frameNumber_;
    const Division division_;
    std::vector<std::size_t> programOf_;      ///< of framebuffers
    std::vector<std::vector<Taker>> takers_;  ///< of frames
    std::vector<bool> hasDepth_;              ///< of frames
    std::deque<Draft> drafts_;                ///< stay where they are
    std::vector<Answer> answers_;
    bool isExchanged_ = false;
    Exchange exchange_;
};

}  // namespace

std::optional<Exchange> exchangeOf(const Plan& plan, std::uint64_t frameNumber) {
    // Who draws a tile is known when it is drawn.
    if (std::ranges::any_of(plan.draws,
                            [](const PlannedDraw& each) { return each.queue.has_value(); }))
        return std::nullopt;
    return Divider(plan, frameNumber).divide();
}

}  // namespace eyrie::compound
