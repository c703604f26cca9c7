// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/needs.h"

#include <algorithm>
#include <utility>

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;

/// Of a framebuffer or frame, what later steps take.
struct Need {
    PixelViewport area;
    bool depth = false;

    void include(const PixelViewport& more, bool withDepth) {
        area = enclosing(area, more);
        depth = depth || (withDepth && !more.isEmpty());
    }

    /// What was there before is not needed where all of it is overwritten.
    void overwrite(const PixelViewport& part) {
        if (part.contains(area))
            *this = {};
    }
};

bool isByDepth(Combine combine) {
    return combine == Combine::Nearer || combine == Combine::NearerOrEqual;
}

class Backwards {
public:
    explicit Backwards(Plan& plan)
        : plan_(plan), framebuffers_(plan.framebuffers.size()), frames_(plan.frames) {
        for (const Picture& picture : plan.pictures)
            for (const std::vector<PicturePart>* const parts : {&picture.parts, &picture.right})
                for (const PicturePart& each : *parts)
                    framebuffers_[each.framebuffer].include(each.part, picture.withDepth);
    }

    bool operator()(Clear& step) {
        Need& need = framebuffers_[step.framebuffer];
        if (intersection(need.area, step.part).isEmpty())
            return false;
        need.overwrite(step.part);
        return true;
    }

    bool operator()(Draw& step) {
        Need& need = framebuffers_[step.framebuffer];
        fabric::ChannelTask& task = plan_.draws[step.draw].task;
        task.pixelViewport = intersection(need.area, task.pixelViewport);
        if (task.pixelViewport.isEmpty())
            return false;
        task.wantsDepth = comeOver(step.combine, task.pixelViewport, true, need);
        return true;
    }

    bool operator()(ReadBack& step) {
        const Need& need = frames_[step.frame];
        if (need.area.isEmpty())
            return false;
        if (!step.zoom)
            step.part = intersection(step.part, need.area);
        step.withDepth = need.depth;
        framebuffers_[step.framebuffer].include(step.part, need.depth);
        return !step.part.isEmpty();
    }

    bool operator()(Assemble& step) {
        Need& need = framebuffers_[step.framebuffer];
        if (need.area.isEmpty())
            return false;
        const bool isInPlace = step.regriddings.empty() && step.fromX == 0 && step.fromY == 0;
        if (isInPlace)
            step.part = intersection(step.part, need.area);
        if (step.part.isEmpty())
            return false;
        frames_[step.frame].include(step.part, comeOver(step.combine, step.part, isInPlace, need));
        return true;
    }

    bool operator()(Average& step) {
        Need& need = framebuffers_[step.framebuffer];
        step.part = intersection(step.part, need.area);
        if (step.part.isEmpty())
            return false;
        const bool depth = comeOver(step.combine, step.part, true, need);
        for (const std::size_t sample : step.samples)
            framebuffers_[sample].include(step.part, depth && sample == step.samples.front());
        return true;
    }

private:
    /// Whether depth is needed of what comes.
    static bool comeOver(Combine combine, const PixelViewport& part, bool isInPlace, Need& need) {
        if (isByDepth(combine))
            need.depth = true;
        const bool depth = need.depth;
        if (!isByDepth(combine) && isInPlace)
            need.overwrite(part);
        return depth;
    }

    Plan& plan_;
    std::vector<Need> framebuffers_;
    std::vector<Need> frames_;
};

void dropDraws(Plan& plan) {
    std::vector<PlannedDraw> kept;
    for (Step& step : plan.steps)
        if (auto* const draw = std::get_if<Draw>(&step)) {
            kept.push_back(std::move(plan.draws[draw->draw]));
            draw->draw = kept.size() - 1;
        }
    plan.draws = std::move(kept);
}

}  // namespace

void keepWhatIsNeeded(Plan& plan) {
    Backwards backwards(plan);
    std::vector<Step> kept;
    for (auto step = plan.steps.rbegin(); step != plan.steps.rend(); ++step)
        if (std::visit(backwards, *step))
            kept.push_back(std::move(*step));
    std::ranges::reverse(kept);
    plan.steps = std::move(kept);
    dropDraws(plan);
}

}  // namespace eyrie::compound
