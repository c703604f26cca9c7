// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_pipeline.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "coordinator/composite/assemble_2d.h"
#include "coordinator/composite/assemble_db.h"
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
    : registry_(registry),
      options_(std::move(options)),
      patience_(options_.patience),
      crew_(registry, options_.openTimeout, [this] { listeners_.notify(); }) {}

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
    if (state.revision != lastRevision_)
        keepers_.forget();
    FrameRequest request = asked;
    budget_.reset();
    if (asked.budgetMilliseconds) {
        const BudgetPlan plan = keepers_.of(asked).plan(asked);
        budget_ = plan.budget;
        request.width = plan.width;
        request.height = plan.height;
    }
    ASSIGN_OR_RETURN(std::vector<Dispatch::Drawn> drawn, draw(request, state.revision));
    return compose(request, state.scene->background, std::move(drawn));
}

absl::StatusOr<std::vector<Dispatch::Drawn>> FramePipeline::draw(const FrameRequest& request,
                                                                 std::uint64_t revision) {
    forgetOtherKinds(request, revision);
    const fabric::FrameData& frameData = frameDataFor(request);
    const fabric::ChannelTask whole{
        ++frameNumber_,     frameData.version,    request.width,
        request.height,     request.drawnPart(),  {},
        request.wantsDepth, request.completeness, request.measuresStages};
    auto dispatch = std::make_shared<Dispatch>(Dispatch::Plan{
        frameData, decompose(whole, options_.decomposition, balance_.cuts(freeRenderers(revision))),
        revision, patience_.limit(), options_.callTimeout});
    ASSIGN_OR_RETURN(std::vector<Dispatch::Drawn> drawn, dispatch->run(crew_));
    std::vector<double> milliseconds;
    for (const Dispatch::Drawn& part : drawn) {
        patience_.record(part.taken);
        milliseconds.push_back(part.result.statistics.milliseconds.total);
    }
    balance_.record(milliseconds);
    return drawn;
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

/// What earlier frames took tells of frames that differ in nothing but the camera. Where their load
/// lies is the same whatever time they are to keep.
void FramePipeline::forgetOtherKinds(const FrameRequest& request, std::uint64_t revision) {
    FrameRequest likeLast = request;
    likeLast.camera = lastRequest_.camera;
    if (request.budgetMilliseconds != lastRequest_.budgetMilliseconds)
        patience_.forget();
    likeLast.budgetMilliseconds = lastRequest_.budgetMilliseconds;
    if (likeLast != lastRequest_ || revision != lastRevision_) {
        patience_.forget();
        balance_.forget();
    }
    lastRequest_ = request;
    lastRevision_ = revision;
}

/// A renderer that is still busy with an earlier frame's part sits out until it has finished.
int FramePipeline::freeRenderers(std::uint64_t revision) const {
    const auto members = crew_.ready(revision);
    const auto free = std::count_if(members.begin(), members.end(),
                                    [](const auto& member) { return member->isIdle(); });
    return std::max(1, static_cast<int>(free));
}

RenderedFrame FramePipeline::compose(const FrameRequest& request, fabric::Rgba background,
                                     std::vector<Dispatch::Drawn> drawn) const {
    RenderedFrame frame;
    frame.device = drawn.front().device;
    frame.statistics.tauAskedPixels = request.tauPixels;
    std::vector<fabric::Image> images;
    for (Dispatch::Drawn& part : drawn) {
        fabric::accumulate(frame.statistics, part.result.statistics);
        images.push_back(std::move(part.result.image));
    }
    const fabric::PixelViewport area = request.drawnPart();
    if (images.size() == 1 || options_.decomposition == Decomposition::TwoD) {
        frame.image = assemble2D(area, background, request.wantsDepth, std::move(images));
    } else {
        frame.image = assembleDb(area, background, std::move(images));
        if (!request.wantsDepth)
            frame.image.depth.clear();
    }
    return frame;
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

Status FramePipeline::status() const {
    Status status;
    for (const Registry::Entry& entry : registry_.entries())
        status.renderers.push_back({entry.id, entry.device, entry.alive});
    const Crew::State state = crew_.state();
    status.scene = *state.scene;
    status.sceneInfo = state.sceneInfo;
    status.problem = problem(state);
    return status;
}

int FramePipeline::subscribe(std::function<void()> listener) {
    return listeners_.add(std::move(listener));
}

void FramePipeline::unsubscribe(int handle) { listeners_.remove(handle); }

}  // namespace eyrie::coordinator
