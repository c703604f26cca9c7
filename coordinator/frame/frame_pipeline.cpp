// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_pipeline.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "coordinator/compound/compose.h"
#include "coordinator/frame/problem.h"
#include "coordinator/frame/program_runs.h"
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

std::vector<config::RendererFacts> factsOf(const std::vector<std::shared_ptr<Member>>& members) {
    std::vector<config::RendererFacts> facts;
    for (const auto& member : members)
        facts.push_back({member->id(), "", member->device().renderer});
    return facts;
}

/// How long programs are left alone after one has failed: renderers may be dying.
constexpr std::chrono::seconds kProgramsRest{2};

std::uint64_t newSession() {
    std::random_device random;
    return (std::uint64_t{random()} << 32 | random()) | 1;  // not 0
}

std::vector<bool> idleOnes(const std::vector<std::shared_ptr<Member>>& members) {
    std::vector<bool> idle;
    for (const auto& member : members) idle.push_back(member->isIdle());
    return idle;
}

std::vector<ActiveConfiguration::Taken> takenBy(const std::vector<Dispatch::Drawn>& drawn) {
    std::vector<ActiveConfiguration::Taken> taken;
    for (const Dispatch::Drawn& one : drawn)
        taken.push_back({one.result.image.area, one.result.statistics.milliseconds,
                         std::chrono::duration<double, std::milli>(one.taken).count()});
    return taken;
}

bool isThroughWall(const compound::Plan& plan) {
    return std::ranges::any_of(plan.draws,
                               [](const auto& draw) { return draw.task.sight.has_value(); });
}

/// `more` are of the plan's draws after those that were drawn.
RenderedFrame composed(const compound::Plan& plan, std::vector<Dispatch::Drawn> drawn,
                       std::vector<fabric::Image> more, fabric::Rgba background) {
    RenderedFrame frame;
    if (!drawn.empty())
        frame.device = drawn.front().device;
    frame.isThroughWall = isThroughWall(plan);
    std::vector<fabric::Image> images;
    for (Dispatch::Drawn& part : drawn) {
        fabric::accumulate(frame.statistics, part.result.statistics);
        images.push_back(std::move(part.result.image));
    }
    std::ranges::move(more, std::back_inserter(images));
    std::vector<fabric::Image> pictures =
        compound::composePictures(plan, std::move(images), background);
    if (pictures.empty())
        return frame;
    frame.image = std::move(pictures.front());
    frame.further.assign(std::make_move_iterator(pictures.begin() + 1),
                         std::make_move_iterator(pictures.end()));
    return frame;
}

}  // namespace

FramePipeline::FramePipeline(Registry& registry, FramePipelineOptions options)
    : options_(std::move(options)),
      configuration_(options_.configuration, options_.layout, [this] { listeners_.notify(); }),
      programPatience_(options_.patience),
      crew_(registry, {.patience = options_.patience}, [this] { listeners_.notify(); }) {}

absl::StatusOr<RenderedFrame> FramePipeline::renderFrame(const FrameRequest& request) {
    RETURN_IF_ERROR(check(request));
    const std::lock_guard turn(turn_);
    const auto start = Registry::Clock::now();
    while (true) {
        const Crew::State state = crew_.state();
        if (const std::string why = problem(state); !why.empty())
            return absl::UnavailableError(why);
        absl::StatusOr<RenderedFrame> frame = renderOfScene(request, state);
        if (!frame.ok() && crew_.state().revision != state.revision)
            continue;  // the scene was replaced meanwhile: draw that one
        RETURN_IF_ERROR(frame.status());
        double& total = frame->statistics.milliseconds.total;
        total = std::chrono::duration<double, std::milli>(Registry::Clock::now() - start).count();
        if (request.budgetMilliseconds)
            keepers_.of(request).record(request, frame->statistics, total);
        return frame;
    }
}

absl::StatusOr<RenderedFrame> FramePipeline::renderOfScene(const FrameRequest& asked,
                                                           const Crew::State& state) {
    if (state.revision != std::exchange(lastRevision_, state.revision)) {
        keepers_.forget();
        session_ = newSession();
    }
    FrameRequest request = asked;
    budget_.reset();
    if (asked.budgetMilliseconds) {
        const BudgetPlan plan = keepers_.of(asked).plan(asked);
        budget_ = plan.budget;
        request.width = plan.width;
        request.height = plan.height;
    }
    const std::vector<std::shared_ptr<Member>> members = crew_.ready(state.revision);
    if (members.empty())
        return absl::UnavailableError("no renderer is ready");
    ActiveConfiguration& active = configuration_.with(factsOf(members));
    const std::uint64_t number = ++frameNumber_;
    ASSIGN_OR_RETURN(compound::Plan plan, active.plan(request, number, idleOnes(members)));
    if (const auto exchange = compound::exchangeOf(plan, number);
        exchange && mayExchange(active, *exchange, members.size())) {
        absl::StatusOr<RenderedFrame> frame =
            drawByPrograms(request, active, plan, *exchange, members, state);
        if (frame.ok())
            return frame;
        spdlog::warn("frame {} is put together here: {}", number, frame.status().ToString());
        programsRestUntil_ = Registry::Clock::now() + kProgramsRest;
    }
    return drawCentrally(request, active, plan, members, state);
}

/// Between renderers of their own; one that has just failed may fail again.
bool FramePipeline::mayExchange(const ActiveConfiguration& active,
                                const compound::Exchange& exchange, std::size_t renderers) const {
    if (Registry::Clock::now() < programsRestUntil_)
        return false;
    const std::size_t first = active.rendererFor(exchange.programs.front().channel, renderers);
    return std::ranges::any_of(exchange.programs, [&](const compound::PlannedProgram& each) {
        return active.rendererFor(each.channel, renderers) != first;
    });
}

absl::StatusOr<RenderedFrame> FramePipeline::drawCentrally(const FrameRequest& request,
                                                           ActiveConfiguration& active,
                                                           const compound::Plan& plan,
                                                           const Members& members,
                                                           const Crew::State& state) {
    ASSIGN_OR_RETURN(std::vector<Dispatch::Drawn> drawn,
                     draw(request, plan, active.takersOf(plan, members.size()), state.revision));
    active.record(plan, frameNumber_, takenBy(drawn));
    RenderedFrame frame = composed(plan, std::move(drawn), {}, state.scene->background);
    frame.statistics.tauAskedPixels = request.tauPixels;
    return frame;
}

absl::StatusOr<RenderedFrame> FramePipeline::drawByPrograms(
    const FrameRequest& request, ActiveConfiguration& active, const compound::Plan& plan,
    const compound::Exchange& exchange, const Members& members, const Crew::State& state) {
    Members renderers;
    std::vector<std::string> addresses;
    for (const compound::PlannedProgram& each : exchange.programs) {
        renderers.push_back(members[active.rendererFor(each.channel, members.size())]);
        addresses.push_back(crew_.addressOf(renderers.back()->id()));
    }
    const std::uint64_t kind = kinds_.of(request, state.revision);
    const std::chrono::milliseconds timeout =
        programPatience_.limit(kind).value_or(options_.patience.first);
    const auto started = Registry::Clock::now();
    const fabric::FrameData& frameData = frameDataFor(request);
    auto running = std::async(std::launch::async, [&] {
        return ProgramRuns::run(exchange,
                                {frameData, state.revision, session_, state.scene->background,
                                 request.completeness, timeout},
                                renderers, addresses);
    });
    compound::Plan others = exchange.rest;
    others.draws.resize(exchange.draws.size());
    auto drawn = draw(request, others, active.takersOf(others, members.size()), state.revision);
    ASSIGN_OR_RETURN(ProgramRuns::Result result, running.get());
    RETURN_IF_ERROR(drawn.status());
    programPatience_.record(
        kind, timeout,
        std::chrono::duration_cast<std::chrono::milliseconds>(Registry::Clock::now() - started));
    std::vector<ActiveConfiguration::Taken> taken(plan.draws.size());
    const std::vector<ActiveConfiguration::Taken> byOthers = takenBy(*drawn);
    for (std::size_t i = 0; i < byOthers.size(); ++i) taken[exchange.draws[i]] = byOthers[i];
    for (const ProgramRuns::Result::Draw& each : result.draws)
        taken[each.draw] = {plan.draws[each.draw].task.pixelViewport, each.statistics.milliseconds,
                            each.statistics.milliseconds.total};
    active.record(plan, frameNumber_, taken);
    RenderedFrame frame = composed(exchange.rest, *std::move(drawn), std::move(result.pictures),
                                   state.scene->background);
    for (const ProgramRuns::Result::Draw& each : result.draws)
        fabric::accumulate(frame.statistics, each.statistics);
    frame.device = result.device;
    frame.isThroughWall = isThroughWall(plan);
    frame.statistics.tauAskedPixels = request.tauPixels;
    return frame;
}

absl::StatusOr<std::vector<Dispatch::Drawn>> FramePipeline::draw(const FrameRequest& request,
                                                                 const compound::Plan& plan,
                                                                 Takers takers,
                                                                 std::uint64_t revision) {
    const fabric::FrameData& frameData = frameDataFor(request);
    std::vector<fabric::ChannelTask> tasks;
    for (const compound::PlannedDraw& draw : plan.draws) {
        fabric::ChannelTask& task = tasks.emplace_back(draw.task);
        task.frameDataVersion = frameData.version;
        task.completeness = request.completeness;
        task.measuresStages = request.measuresStages;
    }
    const std::uint64_t kind = kinds_.of(request, revision);
    // What renderers did among themselves took as long as what they do for the coordinator will.
    const auto first = programPatience_.limit(kind).value_or(options_.patience.first);
    auto dispatch =
        std::make_shared<Dispatch>(Dispatch::Plan{frameData, std::move(tasks), revision, kind,
                                                  first, options_.callTimeout, std::move(takers)});
    return dispatch->run(crew_);
}

const fabric::FrameData& FramePipeline::frameDataFor(const FrameRequest& request) {
    const fabric::FrameData asked{
        frameData_.version, request.camera, request.tauPixels, request.shading, request.look,
        request.occlusion,  budget_};
    if (frameData_.version == 0 || asked != frameData_) {
        frameData_ = asked;
        ++frameData_.version;
    }
    return frameData_;
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
        absl::StatusOr<fabric::Picked> picked =
            member->pick(request, state.revision, options_.pickTimeout);
        if (picked.ok() && picked->has_value() &&
            static_cast<std::size_t>((*picked)->object) >= state.scene->objects.size())
            picked = absl::InternalError(fmt::format("{} picked object {}, the scene has {}",
                                                     member->id(), (*picked)->object,
                                                     state.scene->objects.size()));
        if (picked.ok())
            return picked;
        last = picked.status();
    }
    return last;
}

std::string FramePipeline::problem(const Crew::State& state) const {
    return problemOf({state.ready, state.opening, state.scene->objects.empty(), state.openError,
                      options_.howToJoin});
}

absl::Status FramePipeline::configure(const SwitchLayout& change) {
    const std::lock_guard turn(turn_);
    return configuration_.configure(change);
}

Status FramePipeline::status() const {
    Status status;
    status.renderers = crew_.renderers();
    const Crew::State state = crew_.state();
    status.scene = *state.scene;
    status.sceneInfo = state.sceneInfo;
    status.canvases = configuration_.canvases();
    status.problem = problem(state);
    return status;
}

int FramePipeline::subscribe(std::function<void()> listener) {
    return listeners_.add(std::move(listener));
}

void FramePipeline::unsubscribe(int handle) { listeners_.remove(handle); }

}  // namespace eyrie::coordinator
