// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_pipeline.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "coordinator/config/frames_under_way.h"
#include "coordinator/frame/dispatch.h"
#include "coordinator/frame/for_anybody.h"
#include "coordinator/frame/problem.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

absl::Status check(const FrameRequest& request) {
    RETURN_IF_ERROR(fabric::validate(request.camera));
    RETURN_IF_ERROR(fabric::validate(request.look));
    const auto [shorter, longer] = std::minmax(request.width, request.height);
    if (shorter < 1 || longer > fabric::kMaxViewPixels)
        return absl::InvalidArgumentError(
            fmt::format("the picture is {}x{} pixels; each side must be from 1 to {}",
                        request.width, request.height, fabric::kMaxViewPixels));
    const fabric::PixelViewport part = request.drawnPart();
    if (!fabric::PixelViewport{0, 0, request.width, request.height}.contains(part))
        return absl::InvalidArgumentError(
            fmt::format("the part {}x{}+{}+{} is not inside the picture of {}x{} pixels",
                        part.width, part.height, part.x, part.y, request.width, request.height));
    if (!(request.tauPixels >= fabric::kMinTauPixels && request.tauPixels <= fabric::kMaxTauPixels))
        return absl::InvalidArgumentError(fmt::format("tau is {} pixels; it must be from {} to {}",
                                                      request.tauPixels, fabric::kMinTauPixels,
                                                      fabric::kMaxTauPixels));
    return request.budgetMilliseconds
               ? fabric::validateBudgetMilliseconds(*request.budgetMilliseconds)
               : absl::OkStatus();
}

}  // namespace

FramePipeline::FramePipeline(Registry& registry, FramePipelineOptions options)
    : options_(std::move(options)),
      planner_(
          options_.configuration, options_.layout, [this] { listeners_.notify(); },
          options_.keeping),
      programs_(
          {options_.patience, options_.callTimeouts, [this] { gate_.look(); }, options_.telemetry},
          crew_),
      crew_(registry, {.patience = options_.patience}, [this] { listeners_.notify(); }) {}

absl::StatusOr<RenderedFrame> FramePipeline::renderFrame(const FrameRequest& request) {
    RETURN_IF_ERROR(check(request));
    const auto asked = FramePlanner::Clock::now();
    FrameGate::Pass pass(gate_, request.stop);
    if (telemetry() != nullptr)
        telemetry()->metrics.took(observe::Stage::Turn, FramePlanner::Clock::now() - asked);
    return render(request, pass);
}

absl::StatusOr<RenderedFrame> FramePipeline::renderLatest(const ChooseFrame& choose,
                                                          const std::stop_token& stop) {
    const auto asked = FramePlanner::Clock::now();
    FrameGate::Pass pass(gate_, stop);
    if (telemetry() != nullptr)
        telemetry()->metrics.took(observe::Stage::Turn, FramePlanner::Clock::now() - asked);
    const std::optional<FrameRequest> request = pass.hasTurn() ? choose() : std::nullopt;
    if (!request)
        return absl::CancelledError("no frame is wanted any more");
    RETURN_IF_ERROR(check(*request));
    return render(*request, pass);
}

absl::StatusOr<RenderedFrame> FramePipeline::render(const FrameRequest& asked,
                                                    FrameGate::Pass& pass) {
    const std::string line = fmt::format("frames {}", pass.ticket() % config::kMostFramesUnderWay);
    observe::StageTimer total(telemetry(), observe::Stage::Total, line);
    absl::StatusOr<RenderedFrame> frame = renderInTurn(asked, pass, line, total);
    if (telemetry() != nullptr) {
        if (frame.ok())
            telemetry()->metrics.frameMade(frame->statistics);
        else if (asked.stop.stop_requested())
            telemetry()->metrics.frameCancelled();
        else
            telemetry()->metrics.frameFailed();
    }
    return frame;
}

absl::StatusOr<RenderedFrame> FramePipeline::renderInTurn(const FrameRequest& asked,
                                                          FrameGate::Pass& pass,
                                                          const std::string& line,
                                                          observe::StageTimer& total) {
    const auto start = FramePlanner::Clock::now();
    while (pass.hasTurn() && !asked.stop.stop_requested()) {
        const Crew::State state = crew_.state();
        if (const std::string why = problem(state); !why.empty())
            return absl::UnavailableError(why);
        observe::StageTimer planning(telemetry(), observe::Stage::Plan, line);
        ASSIGN_OR_RETURN(PlannedFrame planned,
                         planner_.plan(asked, state, crew_.ready(state.revision)));
        planned.timeLine = line;
        planning.setFrame(planned.number);
        planning.stop();
        total.setFrame(planned.number);
        gate_.setLimit(planner_.framesUnderWay());
        gate_.setInterval(std::chrono::duration_cast<FrameGate::Clock::duration>(
            std::chrono::duration<double, std::milli>(planned.intervalMilliseconds)));
        absl::StatusOr<DrawnFrame> drawn = draw(planned, [&] { pass.letNext(); });
        if (!drawn.ok() && asked.stop.stop_requested())
            break;
        if (!drawn.ok() && crew_.state().revision != state.revision)
            continue;  // the scene was replaced meanwhile: draw that one
        RETURN_IF_ERROR(drawn.status());
        pass.awaitEarlier();
        drawn->picture.revision = planned.revision;
        fabric::FrameStatistics& statistics = drawn->picture.statistics;
        planner_.record(planned, statistics, drawn->taken);
        const std::chrono::duration<double, std::milli> taken = FramePlanner::Clock::now() - start;
        statistics.milliseconds.total = taken.count();
        planner_.finished(asked, planned, statistics, start);
        return std::move(drawn->picture);
    }
    return absl::CancelledError("nobody wants this frame any more");
}

/// Another frame could begin without waiting for those under way.
bool FramePipeline::hasIdleRenderer() const {
    const auto members = crew_.ready(crew_.state().revision);
    const std::set<std::string> used = planner_.renderersUsed();
    return std::ranges::any_of(members, [&](const auto& member) {
        return used.contains(member->id()) && member->isIdle() && !member->isLate();
    });
}

absl::StatusOr<DrawnFrame> FramePipeline::draw(const PlannedFrame& frame,
                                               const std::function<void()>& handedOut) {
    absl::Status failure;
    if (frame.byPrograms && programs_.mayDraw(frame)) {
        absl::StatusOr<DrawnFrame> drawn = programs_.draw(frame, handedOut);
        if (drawn.ok() || frame.request.stop.stop_requested())
            return drawn;
        failure = drawn.status();
    }
    const auto start = FramePlanner::Clock::now();
    absl::StatusOr<DrawnFrame> drawn = drawCentrally(frame, handedOut);
    if (drawn.ok() && absl::IsDeadlineExceeded(failure))
        programs_.drawnWithout(frame.kind, std::chrono::duration_cast<std::chrono::milliseconds>(
                                               FramePlanner::Clock::now() - start));
    return drawn;
}

absl::StatusOr<DrawnFrame> FramePipeline::drawCentrally(const PlannedFrame& frame,
                                                        const std::function<void()>& handedOut) {
    Dispatch::Plan plan =
        dispatchOf(frame, frame.plan, frame.takers, programs_.patienceWith(frame.kind));
    plan.callTimeout = options_.callTimeouts.of(frame.request.completeness);
    plan.handedOut = handedOut;
    plan.freed = [this] { gate_.look(); };
    plan.telemetry = options_.telemetry;
    observe::StageTimer rendering(telemetry(), observe::Stage::Render, frame.timeLine,
                                  frame.number);
    ASSIGN_OR_RETURN(std::vector<Dispatch::Drawn> drawn,
                     std::make_shared<Dispatch>(std::move(plan))->run(crew_));
    rendering.stop();
    const observe::StageTimer composing(telemetry(), observe::Stage::Compose, frame.timeLine,
                                        frame.number);
    DrawnFrame whole;
    whole.taken = takenBy(drawn);
    whole.picture = composedFrame(frame, frame.plan, std::move(drawn));
    return whole;
}

absl::StatusOr<fabric::SeenAreas> FramePipeline::seen(const FrameRequest& request) {
    RETURN_IF_ERROR(check(request));
    fabric::SeenAreas areas;
    RETURN_IF_ERROR(withConfiguration([&](ActiveConfiguration& active) -> absl::Status {
        ASSIGN_OR_RETURN(areas, active.seen(request));
        return absl::OkStatus();
    }));
    return areas;
}

/// All renderers have all the data: any may answer. That one is slow or cannot read a page is not
/// held against it; heartbeats find out who is gone.
absl::StatusOr<fabric::Picked> FramePipeline::pick(const fabric::PickRequest& request) {
    RETURN_IF_ERROR(fabric::validate(request));
    const Crew::State state = crew_.state();
    if (const std::string why = problem(state); !why.empty())
        return absl::UnavailableError(why);
    absl::Status last = absl::UnavailableError("no renderer has the scene open; try again");
    for (const std::shared_ptr<Member>& member : crew_.ready(state.revision)) {
        const std::string address = crew_.addressOf(member->id());  // it may be gone afterwards
        absl::StatusOr<fabric::Picked> picked =
            member->pick(request, state.revision, options_.pickTimeout);
        if (picked.ok() && picked->has_value() &&
            static_cast<std::size_t>((*picked)->object) >= state.scene->objects.size())
            picked = absl::InternalError(fmt::format("{} picked object {}, the scene has {}",
                                                     member->id(), (*picked)->object,
                                                     state.scene->objects.size()));
        if (picked.ok())
            return picked;
        last = forAnybody(picked.status(), *state.scene, member->id(), address);
    }
    return last;
}

std::string FramePipeline::problem(const Crew::State& state) const {
    return problemOf({state.ready, state.opening, state.scene->objects.empty(), state.openError,
                      options_.howToJoin});
}

absl::Status FramePipeline::configure(const SwitchLayout& change) {
    const Crew::State state = crew_.state();
    return planner_.configure(change, state, crew_.ready(state.revision));
}

absl::Status FramePipeline::withConfiguration(
    const std::function<absl::Status(ActiveConfiguration&)>& use) {
    const Crew::State state = crew_.state();
    return planner_.withConfiguration(use, state, crew_.ready(state.revision));
}

Status FramePipeline::status() const {
    Status status;
    status.renderers = crew_.renderers();
    const Crew::State state = crew_.state();
    status.scene = *state.scene;
    status.sceneInfo = state.sceneInfo;
    status.sceneRevision = state.revision;
    status.canvases = planner_.canvases(state, crew_.ready(state.revision));
    status.displayRevision = planner_.displayRevision();
    status.problem = problem(state);
    if (status.problem.empty())
        status.note = noteOf(static_cast<std::size_t>(state.ready), planner_.renderersWanted());
    if (status.problem.empty() && status.note.empty())
        status.note = noteOfSize(state.sceneInfo.bounds);
    return status;
}

int FramePipeline::subscribe(std::function<void()> listener) {
    return listeners_.add(std::move(listener));
}

void FramePipeline::unsubscribe(int handle) { listeners_.remove(handle); }

}  // namespace eyrie::coordinator
