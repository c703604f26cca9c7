// SPDX-License-Identifier: Apache-2.0
#include "cli/picture_source.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "cli/compound_names.h"
#include "cli/load_scene.h"
#include "cli/local_farm.h"
#include "cli/log.h"
#include "coordinator/frame/budget_keeper.h"
#include "fabric/status.h"
#include "renderer/renderer.h"

namespace eyrie::cli {
namespace {

using coordinator::FrameRequest;
using coordinator::RenderedFrame;
using ChooseFrame = coordinator::FrameSource::ChooseFrame;

constexpr std::chrono::seconds kRenderersLimit{60};

class InThisProcess final : public PictureSource {
public:
    InThisProcess(std::unique_ptr<Renderer> renderer, fabric::SceneInfo info,
                  fabric::Rgba background)
        : renderer_(std::move(renderer)), info_(std::move(info)), background_(background) {}

    absl::StatusOr<RenderedFrame> draw(const FrameRequest& request) override {
        if (!request.budgetMilliseconds)
            return draw(request, std::nullopt);
        RETURN_IF_ERROR(fabric::validateBudgetMilliseconds(*request.budgetMilliseconds));
        const auto start = std::chrono::steady_clock::now();
        coordinator::BudgetKeeper& keeper = keepers_.of(request);
        const coordinator::BudgetPlan plan = keeper.plan(request);
        FrameRequest planned = request;
        planned.width = plan.width;
        planned.height = plan.height;
        ASSIGN_OR_RETURN(RenderedFrame frame, draw(planned, plan.budget));
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - start;
        keeper.record(request, frame.statistics, taken.count());
        return frame;
    }

    fabric::SceneInfo sceneInfo() const override { return info_; }
    fabric::Rgba background() const override { return background_; }

private:
    absl::StatusOr<RenderedFrame> draw(const FrameRequest& request,
                                       const std::optional<fabric::FrameBudget>& budget) {
        const fabric::FrameData frameData{++frames_,       request.camera, request.tauPixels,
                                          request.shading, request.look,   request.occlusion,
                                          budget};
        fabric::ChannelTask task;
        task.frameNumber = frames_;
        task.frameDataVersion = frameData.version;
        task.viewWidth = request.width;
        task.viewHeight = request.height;
        task.pixelViewport = request.drawnPart();
        task.wantsDepth = request.wantsDepth;
        task.completeness = request.completeness;
        task.measuresStages = request.measuresStages;
        ASSIGN_OR_RETURN(fabric::ChannelResult result, renderer_->render(frameData, task));
        return RenderedFrame{whole(std::move(result.image), task), result.statistics,
                             renderer_->device()};
    }

    /// What a channel drew, with the background around it.
    fabric::Image whole(fabric::Image drawn, const fabric::ChannelTask& task) const {
        if (drawn.area == task.pixelViewport)
            return drawn;
        fabric::Image image = fabric::makeImage(task.pixelViewport, background_, task.wantsDepth);
        if (!drawn.area.isEmpty())
            fabric::paste(drawn, image);
        return image;
    }

    const std::unique_ptr<Renderer> renderer_;
    const fabric::SceneInfo info_;
    const fabric::Rgba background_;
    std::uint64_t frames_ = 0;
    coordinator::BudgetKeepers keepers_;
};

class InProcesses final : public PictureSource {
public:
    InProcesses(std::unique_ptr<LocalFarm> farm, fabric::Rgba background)
        : farm_(std::move(farm)), background_(background) {}

    absl::StatusOr<RenderedFrame> draw(const FrameRequest& request) override {
        return farm_->frames().renderFrame(request);
    }

    absl::StatusOr<RenderedFrame> drawLatest(const ChooseFrame& choose) override {
        return farm_->frames().renderLatest(choose);
    }

    int framesAtOnce() const override { return farm_->frames().framesAtOnce(); }

    fabric::SceneInfo sceneInfo() const override { return farm_->frames().status().sceneInfo; }
    fabric::Rgba background() const override { return background_; }

private:
    const std::unique_ptr<LocalFarm> farm_;
    const fabric::Rgba background_;
};

absl::StatusOr<std::unique_ptr<PictureSource>> openHere(const fabric::Scene& scene,
                                                        const PictureSourceOptions& options) {
    ASSIGN_OR_RETURN(const RendererOptions settings, rendererOptionsOf(options.drawing));
    ASSIGN_OR_RETURN(auto renderer, Renderer::create(settings));
    ASSIGN_OR_RETURN(fabric::SceneInfo info, renderer->openScene(scene));
    return std::make_unique<InThisProcess>(std::move(renderer), std::move(info), scene.background);
}

absl::StatusOr<std::unique_ptr<PictureSource>> openInProcesses(
    fabric::Scene scene, std::optional<config::Configuration> configuration,
    const PictureSourceOptions& options, const std::stop_token& stop) {
    const int used = configuration ? renderersOf(*configuration) : 1;
    const int renderers =
        options.renderers > 0 ? options.renderers : std::min(used, RendererProcesses::kMaxCount);
    coordinator::CoordinatorOptions settings;
    settings.grpcAddresses = {};
    settings.configuration = std::move(configuration);
    settings.layout = compoundNames().at(options.config.compound);
    ASSIGN_OR_RETURN(auto farm, LocalFarm::start(std::move(settings), options.drawing));
    const fabric::Rgba background = scene.background;
    RETURN_IF_ERROR(farm->coordinator().setScene(std::move(scene)));
    farm->startRenderers(renderers);
    RETURN_IF_ERROR(farm->awaitRenderers(renderers, kRenderersLimit, stop));
    return std::make_unique<InProcesses>(std::move(farm), background);
}

}  // namespace

void noteIdleCompound(const PictureSourceOptions& options, int renderers) {
    const ConfigOptions& config = options.config;
    if (renderers <= 1 && config.file.empty() && !options.quiet &&
        config.compound != ConfigOptions().compound)
        tell(fmt::format(
            "--compound {} has no effect: one process draws; --renderers says how many do",
            config.compound));
}

absl::StatusOr<RenderedFrame> PictureSource::drawLatest(const ChooseFrame& choose) {
    const std::optional<FrameRequest> request = choose();
    if (!request)
        return absl::CancelledError("no frame is wanted any more");
    return draw(*request);
}

absl::StatusOr<std::unique_ptr<PictureSource>> PictureSource::open(
    const std::string& path, const PictureSourceOptions& options, const std::stop_token& stop) {
    quietLog();
    const Told told = options.configIsTold ? Told::Errors : toldOf(options.quiet);
    ASSIGN_OR_RETURN(auto configuration, configurationOf(options.config, told));
    ASSIGN_OR_RETURN(NamedScene named,
                     loadScene(std::span(&path, 1), options.drawing.cache, options.quiet, stop));
    // An eye beside the camera, or a canvas, is what only a configuration has.
    const bool isPlain = options.config.shown == coordinator::Shown{};
    if (options.renderers == 0 && !configuration && isPlain)
        return openHere(named.scene, options);
    return openInProcesses(std::move(named.scene), std::move(configuration), options, stop);
}

}  // namespace eyrie::cli
