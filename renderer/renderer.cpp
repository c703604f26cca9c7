// SPDX-License-Identifier: Apache-2.0
#include "renderer/renderer.h"

#include <chrono>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/draw/budget_choice.h"
#include "renderer/draw/picture_error.h"
#include "renderer/draw/scene_draw.h"
#include "renderer/draw/selection.h"
#include "renderer/draw/view_turns.h"
#include "renderer/gl/debug_output.h"
#include "renderer/gl/egl_context.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/lod/view.h"
#include "renderer/scene_opener.h"
#include "renderer/task_check.h"

namespace eyrie {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// To where it is to go: less is copied.
fabric::Image readBack(gl::Framebuffer& framebuffer, const fabric::PixelViewport& covered,
                       bool withDepth, const fabric::Delivery& delivery) {
    const auto room =
        delivery.room && !covered.isEmpty() ? delivery.room(covered, withDepth) : std::nullopt;
    if (!room)
        return framebuffer.read(covered, withDepth);
    framebuffer.read(covered, *room);
    return {covered, {}, {}};
}

}  // namespace

class Renderer::Impl {
public:
    static absl::StatusOr<std::unique_ptr<Impl>> create(const RendererOptions& options);
    ~Impl() { context_->makeCurrent().IgnoreError(); }  // what is below goes with the context
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const fabric::DeviceInfo& device() const { return context_->device(); }
    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene);
    absl::StatusOr<fabric::ChannelResult> render(const fabric::FrameData& asked,
                                                 const fabric::ChannelTask& task,
                                                 const fabric::Delivery& delivery);
    std::shared_ptr<const pick::Picker> picker() const { return open_ ? open_->picker : nullptr; }
    RendererMemory memory() const;

private:
    absl::Status unlessIncomplete();

    Impl(std::unique_ptr<gl::EglContext> context, const RendererOptions& options)
        : context_(std::move(context)), opener_(options, context_->device()) {}

    std::unique_ptr<gl::EglContext> context_;  // first: everything below needs it current
    SceneOpener opener_;
    draw::SceneDraw sceneDraw_;
    draw::ViewTurns turns_;
    std::optional<OpenScene> open_;
    /// What the device had no memory for stays missing, and no error tells so again: until a scene
    /// is opened every further picture fails with this.
    absl::Status incomplete_;
};

absl::StatusOr<std::unique_ptr<Renderer::Impl>> Renderer::Impl::create(
    const RendererOptions& options) {
    ASSIGN_OR_RETURN(auto context, gl::EglContext::create(options.device));
    return std::unique_ptr<Impl>(new Impl(std::move(context), options));
}

absl::StatusOr<fabric::SceneInfo> Renderer::Impl::openScene(const fabric::Scene& scene) {
    RETURN_IF_ERROR(context_->makeCurrent());
    ASSIGN_OR_RETURN(open_, opener_.open(scene));
    incomplete_ = absl::OkStatus();
    sceneDraw_.forget();
    turns_.forget();
    return open_->info;
}

/// What GL had no memory for may be uploads, which stay missing: no picture is whole any more.
absl::Status Renderer::Impl::unlessIncomplete() {
    absl::Status met = gl::takeGlError();
    if (absl::IsResourceExhausted(met))
        incomplete_ = absl::FailedPreconditionError(
            fmt::format("data are missing since an earlier picture: {}; open the scene again",
                        std::string_view(met.message().data(), met.message().size())));
    return met;
}

absl::StatusOr<fabric::ChannelResult> Renderer::Impl::render(const fabric::FrameData& asked,
                                                             const fabric::ChannelTask& task,
                                                             const fabric::Delivery& delivery) {
    RETURN_IF_ERROR(context_->makeCurrent());
    const std::stop_token& stop = delivery.stop;
    if (!open_)
        return absl::FailedPreconditionError("no scene is open; open one before rendering");
    RETURN_IF_ERROR(incomplete_);
    RETURN_IF_ERROR(validateTask(asked, task));
    RETURN_IF_ERROR(draw::unlessStopped(stop));
    fabric::ChannelResult result;
    fabric::FrameStatistics& statistics = result.statistics;
    statistics.tauAskedPixels = asked.tauPixels;
    const auto start = Clock::now();
    opener_.reloadChanged(start);

    const lod::TaskViews views(asked.camera, task);
    const fabric::FrameData frameData =
        draw::withinBudget(open_->objects, views.whole, asked, task, statistics);
    const draw::ViewTurn turn = turns_.next(
        {draw::cutViewOf(frameData.look, task, views.whole), task.range, task.pixelViewport},
        task.completeness);
    const draw::Selection selection =
        draw::selectPieces(open_->objects, views, frameData, task, turn, statistics, stop);
    RETURN_IF_ERROR(draw::unlessStopped(stop));
    statistics.milliseconds.cull = millisecondsSince(start);

    const auto drawStart = Clock::now();
    const draw::SceneFrame frame{open_->scene, open_->objects, selection, views.drawn,
                                 frameData,    task,           delivery};
    RETURN_IF_ERROR(unlessIncomplete());
    RETURN_IF_ERROR(sceneDraw_.framebuffer().resize(views.drawn.width, views.drawn.height));
    RETURN_IF_ERROR(sceneDraw_.draw(frame, statistics));
    RETURN_IF_ERROR(draw::unlessStopped(stop));
    statistics.milliseconds.draw = millisecondsSince(drawStart);

    const auto readStart = Clock::now();
    gl::Framebuffer& framebuffer = sceneDraw_.framebuffer();
    result.image = readBack(framebuffer, selection.covered, task.wantsDepth, delivery);
    statistics.milliseconds.readback = millisecondsSince(readStart);
    const auto errorStart = Clock::now();
    statistics.tauAchievedPixels = draw::promisedPixels(
        open_->objects, views,
        {frameData, task, selection.covered, framebuffer,
         device().software ? occlusion::Reading::ByParts : occlusion::Reading::AllAtOnce});
    statistics.milliseconds.cull += millisecondsSince(errorStart);
    RETURN_IF_ERROR(unlessIncomplete());
    statistics.milliseconds.total = millisecondsSince(start);
    if (task.measuresStages)
        RETURN_IF_ERROR(sceneDraw_.measureStages(frame, statistics.milliseconds));
    return result;
}

RendererMemory Renderer::Impl::memory() const {
    if (!open_)
        return {};
    RendererMemory sum{.hostBytes = open_->indexBytes};
    for (const draw::OpenObject& object : open_->objects) {
        const draw::MemoryUse use = object.drawable->memory();
        sum.deviceBytes += use.deviceBytes;
        sum.hostBytes += use.hostBytes;
    }
    return sum;
}

absl::StatusOr<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
    ASSIGN_OR_RETURN(auto impl, Impl::create(options));
    return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

const fabric::DeviceInfo& Renderer::device() const { return impl_->device(); }

absl::StatusOr<fabric::SceneInfo> Renderer::openScene(const fabric::Scene& scene) {
    return impl_->openScene(scene);
}

absl::StatusOr<fabric::ChannelResult> Renderer::render(const fabric::FrameData& frameData,
                                                       const fabric::ChannelTask& task,
                                                       const fabric::Delivery& delivery) {
    return impl_->render(frameData, task, delivery);
}

std::shared_ptr<const pick::Picker> Renderer::picker() const { return impl_->picker(); }

RendererMemory Renderer::memory() const { return impl_->memory(); }

}  // namespace eyrie
