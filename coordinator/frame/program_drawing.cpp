// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/program_drawing.h"

#include <future>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/frame/program_runs.h"
#include "coordinator/observe/stage_timer.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "wire/local_address.h"

namespace eyrie::coordinator {
namespace {

std::uint64_t newSession() {
    std::random_device random;
    return (std::uint64_t{random()} << 32 | random()) | 1;  // not 0
}

/// What each draw of the plan took, whoever had it.
std::vector<ActiveConfiguration::Taken> takenByAll(const PlannedFrame& frame,
                                                   const std::vector<Dispatch::Drawn>& others,
                                                   const ProgramRuns::Result& programs) {
    std::vector<ActiveConfiguration::Taken> taken(frame.plan.draws.size());
    const std::vector<ActiveConfiguration::Taken> byOthers = takenBy(others);
    for (std::size_t i = 0; i < byOthers.size(); ++i)
        taken[frame.byPrograms->exchange.draws[i]] = byOthers[i];
    for (const ProgramRuns::Result::Draw& each : programs.draws)
        taken[each.draw] = {frame.plan.draws[each.draw].task.pixelViewport,
                            each.statistics.milliseconds, each.statistics.milliseconds.total};
    return taken;
}

}  // namespace

ProgramDrawing::ProgramDrawing(const Options& options, Crew& crew)
    : options_(options), crew_(crew), patience_(options.patience) {}

bool ProgramDrawing::mayDraw(const PlannedFrame& frame) {
    {
        const std::lock_guard lock(mutex_);
        if (!rest_.isOver(Clock::now()))
            return false;
    }
    return allReachEachOther(frame);
}

/// Addresses are those by which the coordinator reaches renderers. One that leads to its own
/// machine leads others elsewhere.
bool ProgramDrawing::allReachEachOther(const PlannedFrame& frame) {
    const std::vector<std::string> addresses = addressesOf(frame);
    const std::vector<compound::PlannedProgram>& programs = frame.byPrograms->exchange.programs;
    for (std::size_t i = 0; i < programs.size(); ++i)
        for (const auto& taker : programs[i].takers) {
            if (!taker || !wire::leadsToOwnMachine(addresses[*taker]) ||
                wire::leadsToOwnMachine(addresses[i]))
                continue;
            const std::lock_guard lock(mutex_);
            if (told_.insert(addresses[*taker]).second)
                spdlog::warn(
                    "the renderer at {} cannot be reached by that at {}, which has pictures for "
                    "it: they are put together here; start it with --listen at an address that "
                    "other machines reach, or with --listen 0.0.0.0:PORT and a --coordinator that "
                    "they reach",
                    addresses[*taker], addresses[i]);
            return false;
        }
    return true;
}

std::vector<std::string> ProgramDrawing::addressesOf(const PlannedFrame& frame) const {
    std::vector<std::string> addresses;
    for (const std::size_t each : frame.byPrograms->renderers)
        addresses.push_back(crew_.addressOf(frame.members[each]->id()));
    return addresses;
}

std::chrono::milliseconds ProgramDrawing::patienceWith(std::uint64_t kind) const {
    const std::lock_guard lock(mutex_);
    return patience_.limit(kind).value_or(options_.patience.first);
}

std::uint64_t ProgramDrawing::sessionOf(std::uint64_t revision) {
    const std::lock_guard lock(mutex_);
    if (revision != std::exchange(revision_, revision))
        session_ = newSession();
    return session_;
}

absl::StatusOr<DrawnFrame> ProgramDrawing::draw(const PlannedFrame& frame,
                                                const std::function<void()>& handedOut) {
    absl::StatusOr<DrawnFrame> drawn = tryToDraw(frame, handedOut);
    if (!drawn.ok() && frame.request.stop.stop_requested())
        return drawn;
    if (!drawn.ok())
        spdlog::warn("frame {} is put together here: {}", frame.number,
                     std::string(drawn.status().message()));
    const std::lock_guard lock(mutex_);
    if (drawn.ok())
        rest_.succeeded();
    else
        rest_.failed(Clock::now());
    return drawn;
}

void ProgramDrawing::drawnWithout(std::uint64_t kind, std::chrono::milliseconds taken) {
    const std::lock_guard lock(mutex_);
    patience_.record(kind, taken, taken);
}

absl::StatusOr<DrawnFrame> ProgramDrawing::tryToDraw(const PlannedFrame& frame,
                                                     const std::function<void()>& handedOut) {
    const PlannedFrame::ByPrograms& programs = *frame.byPrograms;
    std::vector<std::shared_ptr<Member>> renderers;
    for (const std::size_t each : programs.renderers) renderers.push_back(frame.members[each]);
    const std::chrono::milliseconds timeout = patienceWith(frame.kind);
    const std::uint64_t session = sessionOf(frame.scene.revision);
    const auto started = Clock::now();
    observe::Telemetry* const telemetry = options_.telemetry.get();
    observe::StageTimer rendering(telemetry, observe::Stage::Render, frame.timeLine, frame.number);
    auto running = std::async(std::launch::async, [&] {
        return ProgramRuns::run(
            programs.exchange,
            {frame.frameData, frame.scene.revision, session, frame.scene.scene->background,
             frame.request.completeness, frame.request.measuresStages, timeout, handedOut,
             options_.freed, frame.request.stop},
            renderers, addressesOf(frame));
    });
    Dispatch::Plan others =
        dispatchOf(frame, programs.others, programs.takers, patienceWith(frame.kind));
    others.callTimeout = options_.callTimeouts.of(frame.request.completeness);
    others.freed = options_.freed;
    others.telemetry = options_.telemetry;
    auto drawn = std::make_shared<Dispatch>(std::move(others))->run(crew_);
    absl::StatusOr<ProgramRuns::Result> ran = running.get();
    if (ran.ok() && drawn.ok()) {
        const std::lock_guard lock(mutex_);
        patience_.record(
            frame.kind, timeout,
            std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - started));
    }
    ASSIGN_OR_RETURN(ProgramRuns::Result result, std::move(ran));
    RETURN_IF_ERROR(drawn.status());
    rendering.stop();
    const observe::StageTimer composing(telemetry, observe::Stage::Compose, frame.timeLine,
                                        frame.number);
    DrawnFrame whole;
    whole.taken = takenByAll(frame, *drawn, result);
    RenderedFrame& picture = whole.picture;
    picture =
        composedFrame(frame, programs.exchange.rest, *std::move(drawn), std::move(result.pictures));
    for (const ProgramRuns::Result::Draw& each : result.draws) {
        fabric::accumulate(picture.statistics, each.statistics);
        picture.parts.push_back(
            partOf(frame.plan.draws[each.draw].task, each.renderer, each.statistics));
    }
    picture.statistics.tauAskedPixels = frame.request.tauPixels;
    picture.device = result.device;
    return whole;
}

}  // namespace eyrie::coordinator
