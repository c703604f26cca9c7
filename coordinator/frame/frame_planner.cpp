// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_planner.h"

#include <algorithm>
#include <utility>

#include "coordinator/config/frames_under_way.h"
#include "fabric/status.h"

namespace eyrie::coordinator {
namespace {

using Members = std::vector<std::shared_ptr<Member>>;

std::vector<config::RendererFacts> factsOf(const Members& members) {
    std::vector<config::RendererFacts> facts;
    for (const auto& member : members)
        facts.push_back({member->id(), member->node(), member->device().renderer});
    return facts;
}

/// Those that are late with what others draw meanwhile.
std::vector<std::string> lateOnes(const Members& members) {
    std::vector<std::string> late;
    for (const auto& member : members)
        if (member->isLate())
            late.push_back(member->id());
    return late;
}

std::size_t positionOf(const std::string& id, const Members& members) {
    const auto found = std::ranges::find(members, id, [](const auto& one) { return one->id(); });
    return static_cast<std::size_t>(found - members.begin());
}

/// Whether the programs of two frames, which may be under way, are more than a renderer runs.
bool areTooMany(const std::vector<std::size_t>& renderers) {
    return std::ranges::any_of(renderers, [&](std::size_t each) {
        return 2 * std::ranges::count(renderers, each) >
               static_cast<std::ptrdiff_t>(fabric::kMaxPrograms);
    });
}

/// Between renderers of their own.
std::optional<PlannedFrame::ByPrograms> byPrograms(const PlannedFrame& frame) {
    std::optional<compound::Exchange> exchange = compound::exchangeOf(frame.plan, frame.number);
    if (!exchange)
        return std::nullopt;
    PlannedFrame::ByPrograms programs;
    for (const compound::PlannedProgram& each : exchange->programs)
        programs.renderers.push_back(
            positionOf(frame.configuration->rendererFor(each.channel), frame.members));
    if (std::ranges::adjacent_find(programs.renderers, std::ranges::not_equal_to()) ==
            programs.renderers.end() ||
        areTooMany(programs.renderers))
        return std::nullopt;
    programs.others = exchange->rest;
    programs.others.draws.resize(exchange->draws.size());
    programs.takers = frame.configuration->takersOf(programs.others);
    programs.exchange = *std::move(exchange);
    return programs;
}

}  // namespace

/// With what may change the configuration: holds the lock, and tells of a change without it.
class FramePlanner::Turn {
public:
    explicit Turn(FramePlanner& planner) : planner_(planner), lock_(planner.mutex_) {}
    ~Turn() {
        const bool tells = std::exchange(planner_.isToTell_, false);
        lock_.unlock();
        if (tells)
            planner_.changed_();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    FramePlanner& planner_;
    std::unique_lock<std::mutex> lock_;
};

FramePlanner::FramePlanner(std::optional<config::Configuration> given, std::string layout,
                           std::function<void()> changed, ConfigurationKeeping keeping)
    : changed_(std::move(changed)),
      configuration_(
          std::move(given), std::move(layout), [this] { isToTell_ = true; }, std::move(keeping)) {}

absl::StatusOr<PlannedFrame> FramePlanner::plan(const FrameRequest& asked, const Crew::State& scene,
                                                Members ready) {
    if (ready.empty())
        return absl::UnavailableError("no renderer is ready");
    const Turn turn(*this);
    if (scene.revision != std::exchange(lastRevision_, scene.revision))
        keepers_.forget();
    PlannedFrame frame;
    frame.request = asked;
    frame.scene = scene;
    frame.members = std::move(ready);
    std::optional<fabric::FrameBudget> budget;
    if (asked.budgetMilliseconds) {
        const BudgetPlan plan = keepers_.of(asked).plan(asked);
        budget = plan.budget;
        frame.request.width = plan.width;
        frame.request.height = plan.height;
    }
    active_ = configuration_.with(factsOf(frame.members));
    frame.configuration = active_;
    frame.number = ++frameNumber_;
    ASSIGN_OR_RETURN(frame.plan,
                     active_->plan(frame.request, frame.number, lateOnes(frame.members)));
    frame.takers = active_->takersOf(frame.plan);
    frame.intervalMilliseconds = active_->intervalMilliseconds();
    frame.frameData = frameDataFor(frame.request, budget);
    frame.kind = kinds_.of(frame.request, scene.revision);
    frame.revision = revision_.of(scene.revision, active_->onDisplay());
    if (asked.jpegQuality > 0)
        frame.tiles = compound::tilesOf(frame.plan).value_or(std::vector<compound::Tile>());
    if (frame.tiles.empty())
        frame.byPrograms = byPrograms(frame);
    return frame;
}

const fabric::FrameData& FramePlanner::frameDataFor(
    const FrameRequest& request, const std::optional<fabric::FrameBudget>& budget) {
    const fabric::FrameData asked{
        frameData_.version, request.camera, request.tauPixels, request.shading, request.look,
        request.occlusion,  budget};
    if (frameData_.version == 0 || asked != frameData_) {
        frameData_ = asked;
        ++frameData_.version;
    }
    return frameData_;
}

void FramePlanner::record(const PlannedFrame& frame, const fabric::FrameStatistics& statistics,
                          std::span<const ActiveConfiguration::Taken> taken) {
    if (!tellsItsCost(frame.request, statistics) || !frame.request.part.isEmpty())
        return;
    const std::lock_guard lock(mutex_);
    frame.configuration->record(frame.request.session, frame.plan, frame.number, taken);
}

void FramePlanner::finished(const FrameRequest& asked, const PlannedFrame& frame,
                            const fabric::FrameStatistics& statistics, Clock::time_point begun) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double, std::milli> taken =
        now - std::max(begun, std::exchange(lastFinished_, now));
    if (!asked.budgetMilliseconds || frame.scene.revision != lastRevision_)
        return;
    BudgetKeeper& keeper = keepers_.of(asked);
    const BudgetPlan next = keeper.plan(asked);
    if (next.width == frame.request.width && next.height == frame.request.height)
        keeper.record(asked, statistics, taken.count());
}

/// What is seen and set before the next frame is of what that will be made by. Renderers that are
/// not ready while they open another scene are still counted on; frames find out who has gone.
void FramePlanner::meet(const Crew::State& scene, const Members& ready) {
    if (!ready.empty() && (scene.opening == 0 || ready.size() >= configuration_.renderers()))
        configuration_.meet(factsOf(ready));
}

absl::Status FramePlanner::configure(const SwitchLayout& change, const Crew::State& scene,
                                     const Members& ready) {
    const Turn turn(*this);
    meet(scene, ready);
    return configuration_.configure(change);
}

absl::Status FramePlanner::withConfiguration(
    const std::function<absl::Status(ActiveConfiguration&)>& use, const Crew::State& scene,
    const Members& ready) {
    const Turn turn(*this);
    meet(scene, ready);
    return configuration_.change(use);
}

std::vector<CanvasStatus> FramePlanner::canvases(const Crew::State& scene, const Members& ready) {
    const Turn turn(*this);
    meet(scene, ready);
    return configuration_.canvases();
}

std::uint64_t FramePlanner::displayRevision() const {
    const std::lock_guard lock(mutex_);
    return configuration_.displayRevision();
}

std::size_t FramePlanner::renderersWanted() const {
    const std::lock_guard lock(mutex_);
    return configuration_.renderersWanted();
}

int FramePlanner::framesUnderWay() const {
    const std::lock_guard lock(mutex_);
    return static_cast<int>(config::framesUnderWay(configuration_.latency()));
}

std::set<std::string> FramePlanner::renderersUsed() const {
    const std::lock_guard lock(mutex_);
    std::set<std::string> used;
    if (active_)
        for (const auto& [pipe, renderer] : active_->renderers()) used.insert(renderer);
    return used;
}

}  // namespace eyrie::coordinator
