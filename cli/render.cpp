// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "cli/commands.h"
#include "cli/compound_names.h"
#include "cli/data_cache.h"
#include "cli/image_files.h"
#include "cli/local_farm.h"
#include "cli/scene_files.h"
#include "cli/stop_signal.h"
#include "cli/values.h"
#include "coordinator/frame/frame_source.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"
#include "renderer/mesh/output_file.h"
#include "renderer/renderer.h"
#include "wire/json.h"

namespace eyrie::cli {
namespace {

constexpr std::chrono::seconds kRenderersLimit{60};

struct Options {
    std::string scene;
    std::string camera;
    std::string size = "1280x720";
    double tau = 1;
    fabric::Shading shading = fabric::Shading::Smooth;
    std::string look;
    std::optional<double> exaggeration;
    int renderers = 0;  ///< 0: draw in this process
    coordinator::Decomposition compound = coordinator::Decomposition::TwoD;
    std::string out;
    std::string depth;
    std::string stats;
    std::string cache;
    bool quiet = false;
    bool json = false;
};

using Frame = absl::StatusOr<coordinator::RenderedFrame>;

absl::StatusOr<fabric::Look> lookOf(const Options& options) {
    fabric::Look look;
    if (!options.look.empty()) {
        ASSIGN_OR_RETURN(const std::string text, readText(options.look));
        ASSIGN_OR_RETURN(look, wire::lookFromJson(text, options.look));
    }
    if (!options.exaggeration)
        return look;
    if (!(std::abs(*options.exaggeration) <= fabric::kMaxExaggeration))
        return absl::InvalidArgumentError(
            fmt::format("--exaggeration is {}; expected {} to {}", *options.exaggeration,
                        -fabric::kMaxExaggeration, fabric::kMaxExaggeration));
    look.exaggeration = *options.exaggeration;
    return look;
}

absl::StatusOr<coordinator::FrameRequest> requestOf(const Options& options) {
    coordinator::FrameRequest request;
    ASSIGN_OR_RETURN(const PictureSize size, parsePictureSize(options.size, "--size"));
    if (!(options.tau >= fabric::kMinTauPixels && options.tau <= fabric::kMaxTauPixels))
        return absl::InvalidArgumentError(fmt::format("--tau is {}; expected {} to {} pixels",
                                                      options.tau, fabric::kMinTauPixels,
                                                      fabric::kMaxTauPixels));
    ASSIGN_OR_RETURN(const std::string text, readText(options.camera));
    ASSIGN_OR_RETURN(request.camera, wire::cameraFromJson(text, options.camera));
    request.tauPixels = options.tau;
    request.shading = options.shading;
    ASSIGN_OR_RETURN(request.look, lookOf(options));
    request.width = size.width;
    request.height = size.height;
    request.wantsDepth = !options.depth.empty();
    return request;
}

absl::StatusOr<fabric::Scene> loadScene(const Options& options, const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const auto folder, cacheFolder(options.cache));
    DataCache cache(folder, ProgressBar::styleFor(options.quiet), stop);
    std::vector<std::string> notes;
    return assembleScene(std::vector<std::string>{options.scene}, cache, notes);
}

Frame renderHere(const fabric::Scene& scene, const coordinator::FrameRequest& request) {
    ASSIGN_OR_RETURN(const auto renderer, Renderer::create({}));
    RETURN_IF_ERROR(renderer->openScene(scene).status());
    const fabric::FrameData frameData{1, request.camera, request.tauPixels, request.shading,
                                      request.look};
    fabric::ChannelTask task;
    task.frameDataVersion = frameData.version;
    task.viewWidth = request.width;
    task.viewHeight = request.height;
    task.pixelViewport = {0, 0, request.width, request.height};
    task.wantsDepth = request.wantsDepth;
    ASSIGN_OR_RETURN(const fabric::ChannelResult result, renderer->render(frameData, task));
    coordinator::RenderedFrame frame{
        fabric::makeImage(task.pixelViewport, scene.background, request.wantsDepth),
        result.statistics, renderer->device()};
    if (!result.image.area.isEmpty())
        fabric::paste(result.image, frame.image);
    return frame;
}

Frame renderInProcesses(fabric::Scene scene, const coordinator::FrameRequest& request,
                        const Options& options, const std::stop_token& stop) {
    spdlog::set_level(spdlog::level::warn);
    ASSIGN_OR_RETURN(const auto farm, LocalFarm::start(options.compound));
    RETURN_IF_ERROR(farm->coordinator().setScene(std::move(scene)));
    farm->startRenderers(options.renderers);
    RETURN_IF_ERROR(farm->awaitRenderers(options.renderers, kRenderersLimit, stop));
    return farm->frames().renderFrame(request);
}

absl::Status writeResults(const coordinator::RenderedFrame& frame, const Options& options,
                          const coordinator::FrameRequest& request) {
    const std::string statistics =
        wire::statisticsJson(frame.statistics, request.width, request.height, frame.device);
    if (!options.depth.empty())
        RETURN_IF_ERROR(writeDepth(frame.image, options.depth));
    if (!options.stats.empty())
        RETURN_IF_ERROR(writeText(statistics, options.stats));
    RETURN_IF_ERROR(writePicture(frame.image, options.out));
    if (options.json)
        fmt::print("{}\n", statistics);
    else if (!options.quiet)
        fmt::print(stderr, "{}: {} triangles, {:.1f} ms, error {:.3g} of {:.3g} pixels asked{}\n",
                   options.out, frame.statistics.triangles, frame.statistics.milliseconds.total,
                   frame.statistics.tauAchievedPixels, frame.statistics.tauAskedPixels,
                   frame.statistics.complete ? "" : ", incomplete");
    return absl::OkStatus();
}

/// Finds out what cannot be written before anything is drawn or written.
absl::Status checkOutputs(const Options& options) {
    RETURN_IF_ERROR(checkPictureName(options.out, "-o"));
    for (const std::string& path : {options.out, options.depth, options.stats})
        if (!path.empty())
            RETURN_IF_ERROR(mesh::OutputFile::create(path).status());
    return absl::OkStatus();
}

absl::Status render(const Options& options) {
    const StopSignal stop;
    RETURN_IF_ERROR(checkOutputs(options));
    ASSIGN_OR_RETURN(const coordinator::FrameRequest request, requestOf(options));
    ASSIGN_OR_RETURN(fabric::Scene scene, loadScene(options, stop.token()));
    const Frame frame = options.renderers == 0
                            ? renderHere(scene, request)
                            : renderInProcesses(std::move(scene), request, options, stop.token());
    RETURN_IF_ERROR(frame.status());
    if (stop.token().stop_requested())
        return absl::CancelledError("stopped; nothing was written");
    return writeResults(*frame, options, request);
}

void addOutputOptions(CLI::App& command, Options& options) {
    command.add_option("-o,--output", options.out, "Picture to write: .png, .jpg or .jpeg")
        ->type_name("FILE")
        ->required();
    command
        .add_option("--depth", options.depth,
                    "PFM to write: view-space metres, inf where nothing is")
        ->type_name("FILE");
    command.add_option("--stats", options.stats, "JSON to write: what was drawn, and how well")
        ->type_name("FILE");
    command.add_flag("--quiet", options.quiet, "Only errors");
    command.add_flag("--json", options.json, "Print the statistics as JSON");
}

void addLookOptions(CLI::App& command, Options& options) {
    static const std::map<std::string, fabric::Shading> kShadings = {
        {"smooth", fabric::Shading::Smooth},
        {"flat", fabric::Shading::Flat},
        {"wireframe", fabric::Shading::Wireframe}};
    command.add_option("--shading", options.shading, "How surfaces are drawn [smooth]")
        ->transform(CLI::CheckedTransformer(kShadings).description(""))
        ->type_name("smooth|flat|wireframe");
    command
        .add_option("--look", options.look,
                    R"(JSON: how terrain is shown, such as {"contours":{"intervalMetres":100}})")
        ->type_name("FILE");
    command.add_option("--exaggeration", options.exaggeration,
                       "Terrain's heights times this, before what --look says [1]");
}

}  // namespace

void addRender(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("render", "Render a picture without a screen");
    command->add_option("scene", options->scene, "What is drawn, as for `eyrie serve`")
        ->type_name("FILE")
        ->required();
    command
        ->add_option("--camera", options->camera,
                     R"(JSON: {"eye":[x,y,z],"target":[x,y,z],"up":[0,0,1],"fovyDegrees":45})")
        ->type_name("FILE")
        ->required();
    command->add_option("--size", options->size, "Of the picture, in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    command->add_option("--tau", options->tau, "Screen-space error allowed, in pixels")
        ->capture_default_str();
    addLookOptions(*command, *options);
    command
        ->add_option("--renderers", options->renderers,
                     "Draw with so many processes instead of in this one")
        ->check(CLI::Range(1, RendererProcesses::kMaxCount));
    command
        ->add_option("--compound", options->compound,
                     "How these cut the frame: 2D, by pixels, or DB, by data [2D]")
        ->transform(CLI::CheckedTransformer(compoundNames()).description(""))
        ->type_name("2D|DB");
    command->add_option("--cache", options->cache, "Where imports are kept [~/.cache/eyrie]")
        ->type_name("FOLDER");
    addOutputOptions(*command, *options);
    command->footer(
        "docs/looks.md explains --look.\n"
        "Examples:\n"
        "  eyrie render scene.json --camera cam.json --size 1920x1080 --tau 1 -o a.png\n"
        "  eyrie render dem.eyt --camera cam.json --renderers 3 --compound DB \\\n"
        "      -o a.png --depth a.pfm --stats a.json");
    command->callback([options, &run] { run = [options] { return render(*options); }; });
}

}  // namespace eyrie::cli
