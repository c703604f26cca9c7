// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/all_pictures.h"
#include "cli/bench/flights.h"
#include "cli/bound_text.h"
#include "cli/commands.h"
#include "cli/config_options.h"
#include "cli/drawing_options.h"
#include "cli/flight_video.h"
#include "cli/image_files.h"
#include "cli/log.h"
#include "cli/occlusion_option.h"
#include "cli/options/one_of.h"
#include "cli/output_reader.h"
#include "cli/own_places.h"
#include "cli/picture_bands.h"
#include "cli/picture_source.h"
#include "cli/renderer_processes.h"
#include "cli/stop_signal.h"
#include "cli/text_file.h"
#include "cli/values.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/frame/problem.h"
#include "coordinator/stream/home_camera.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"
#include "renderer/mesh/output_file.h"
#include "wire/json.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string scene;
    std::string camera;
    std::string flight;  ///< drawn instead, as a video
    int framesPerSecond = 30;
    bool hasRate = false;  ///< was given
    std::string size = "1280x720";
    double tau = 1;
    fabric::Shading shading = fabric::Shading::Smooth;
    fabric::Occlusion occlusion = fabric::Occlusion::Auto;
    std::string look;
    std::optional<double> exaggeration;
    PictureSourceOptions pictures;
    std::string out;
    std::string depth;
    std::string stats;
    bool all = false;
    bool json = false;
};

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
    if (!options.camera.empty()) {
        ASSIGN_OR_RETURN(const std::string text, readText(options.camera));
        ASSIGN_OR_RETURN(request.camera, wire::cameraFromJson(text, options.camera));
    }
    request.tauPixels = options.tau;
    request.shading = options.shading;
    request.occlusion = options.occlusion;
    ASSIGN_OR_RETURN(request.look, lookOf(options));
    request.width = size.width;
    request.height = size.height;
    request.wantsDepth = !options.depth.empty();
    request.shown = {options.pictures.config.shown};
    request.measuresStages = !options.stats.empty() || options.json;
    return request;
}

/// The files that a picture is written to while it is being drawn.
struct Outputs {
    std::unique_ptr<PictureFile> picture;
    std::optional<DepthFile> depth;

    absl::Status take(const fabric::Image& rows) {
        if (depth && rows.depth.size() != rows.colour.size())
            return absl::InvalidArgumentError(
                "--depth: an anaglyph shows two depths a pixel; name one eye with --eye, or leave "
                "--depth out");
        if (depth)
            RETURN_IF_ERROR(depth->put(rows));
        return picture->append(rows);
    }
};

absl::StatusOr<Outputs> createOutputs(const Options& options,
                                      const coordinator::FrameRequest& request,
                                      const std::stop_token& stop) {
    Outputs outputs;
    ASSIGN_OR_RETURN(const OutputReader ofPicture, OutputReader::await(options.out, stop));
    ASSIGN_OR_RETURN(const OutputReader ofDepth, OutputReader::await(options.depth, stop));
    const auto [width, height] = wholeSize(request);
    ASSIGN_OR_RETURN(outputs.picture, PictureFile::create(options.out, width, height, stop));
    if (!options.depth.empty()) {
        ASSIGN_OR_RETURN(outputs.depth, DepthFile::create(options.depth, width, height));
    }
    return outputs;
}

absl::Status writeStatistics(const std::string& statistics, const Options& options,
                             const std::stop_token& stop) {
    if (options.stats.empty())
        return absl::OkStatus();
    ASSIGN_OR_RETURN(const OutputReader reader, OutputReader::await(options.stats, stop));
    return writeText(statistics, options.stats, stop);
}

absl::Status finish(Outputs& outputs, const DrawnBands& drawn, const Options& options,
                    const coordinator::FrameRequest& request, const std::stop_token& stop) {
    const auto [width, height] = wholeSize(request);
    const std::string statistics =
        wire::statisticsJson(drawn.statistics, width, height, drawn.device);
    if (outputs.depth)
        RETURN_IF_ERROR(outputs.depth->commit());
    RETURN_IF_ERROR(writeStatistics(statistics, options, stop));
    RETURN_IF_ERROR(outputs.picture->commit());
    if (!drawn.whyEmpty.empty() && !options.pictures.quiet)
        tell(fmt::format("{}: {}", options.out, drawn.whyEmpty));
    else if (!drawn.whyBlind.empty() && !options.pictures.quiet)
        tell(fmt::format("{}: a part shows nothing: {}", options.out, drawn.whyBlind));
    if (options.json)
        fmt::print("{}\n", statistics);
    else if (!options.pictures.quiet)
        tell(fmt::format(
            "{}: {} triangles, {:.1f} ms, error {} of {:.3g} pixels asked{}", options.out,
            drawn.statistics.triangles, drawn.statistics.milliseconds.total,
            boundText(drawn.statistics.tauAchievedPixels), drawn.statistics.tauAskedPixels,
            drawn.statistics.complete ? "" : ", incomplete"));
    return absl::OkStatus();
}

/// What one frame of a configuration shows, each in files of its own.
absl::StatusOr<std::vector<NamedPicture>> picturesOf(const Options& options) {
    const ConfigOptions& config = options.pictures.config;
    if (config.file.empty() || config.shown != coordinator::Shown{})
        return absl::InvalidArgumentError(
            "--all is of a configuration, and of all that it shows: name one with --config, and "
            "leave out --canvas, --segment, --eye and --stereo");
    ASSIGN_OR_RETURN(const auto configuration, configurationOf(config, Told::Errors));
    std::vector<NamedPicture> pictures = allPictures(*configuration);
    if (pictures.empty())
        return absl::InvalidArgumentError("--all: the configuration shows nothing");
    return pictures;
}

Options named(Options options, const std::string& name) {
    options.out = pathOf(options.out, name);
    if (!options.depth.empty())
        options.depth = pathOf(options.depth, name);
    return options;
}

/// So that no picture, depths or statistics replace each other, or what they are made of.
absl::Status checkPlaces(const Options& options, std::span<const Options> pictures) {
    std::vector<NamedFile> written{{"--stats", options.stats}};
    for (const Options& picture : pictures) {
        written.push_back({"-o", picture.out});
        written.push_back({"--depth", picture.depth});
    }
    const std::vector<NamedFile> read{{"the scene", options.scene},
                                      {"--camera", options.camera},
                                      {"--look", options.look},
                                      {"--config", options.pictures.config.file}};
    return checkOwnPlaces(written, read);
}

/// Finds out what cannot be written before anything is drawn or written.
absl::Status checkOutputs(const Options& options) {
    RETURN_IF_ERROR(checkPictureName(options.out, "-o"));
    for (const std::string& path : {options.out, options.depth, options.stats})
        if (!path.empty())
            RETURN_IF_ERROR(mesh::OutputFile::check(path));
    return absl::OkStatus();
}

/// Where no camera is named: that of a viewer who has just come, or for heights as they are shown.
void lookAtAll(const PictureSource& pictures, const Options& options,
               coordinator::FrameRequest& request) {
    if (!options.camera.empty())
        return;
    request.camera = stream::homeCamera(
        stream::exaggeratedBounds(pictures.sceneInfo(), request.look.exaggeration));
    const std::string note = coordinator::noteOfSize(pictures.sceneInfo().bounds);
    if (!note.empty() && !options.pictures.quiet)
        tell(fmt::format("{}: {}", options.scene, note));
}

absl::Status render(const Options& options) {
    const StopSignal stop;
    RETURN_IF_ERROR(checkPlaces(options, std::span(&options, 1)));
    RETURN_IF_ERROR(checkOutputs(options));
    ASSIGN_OR_RETURN(coordinator::FrameRequest request, requestOf(options));
    ASSIGN_OR_RETURN(const auto pictures,
                     PictureSource::open(options.scene, options.pictures, stop.token()));
    lookAtAll(*pictures, options, request);
    ASSIGN_OR_RETURN(Outputs outputs, createOutputs(options, request, stop.token()));
    ASSIGN_OR_RETURN(
        const DrawnBands drawn,
        drawInBands(*pictures, request, kBandPixels, [&](const fabric::Image& rows) {
            if (stop.token().stop_requested())
                return absl::Status(absl::CancelledError("stopped; nothing was written"));
            return outputs.take(rows);
        }));
    return finish(outputs, drawn, options, request, stop.token());
}

absl::Status write(const fabric::Image& image, const Options& options,
                   const coordinator::FrameRequest& request, const std::stop_token& stop) {
    ASSIGN_OR_RETURN(Outputs outputs, createOutputs(options, request, stop));
    RETURN_IF_ERROR(outputs.take(image));
    if (outputs.depth)
        RETURN_IF_ERROR(outputs.depth->commit());
    return outputs.picture->commit();
}

/// All in one frame, with one version of its data, and so of one moment.
absl::Status renderAll(const Options& options) {
    const StopSignal stop;
    ASSIGN_OR_RETURN(const std::vector<NamedPicture> asked, picturesOf(options));
    std::vector<Options> own;
    for (const NamedPicture& each : asked) own.push_back(named(options, each.name));
    RETURN_IF_ERROR(checkPlaces(options, own));
    for (const Options& each : own) RETURN_IF_ERROR(checkOutputs(each));
    ASSIGN_OR_RETURN(coordinator::FrameRequest request, requestOf(options));
    request.shown.clear();
    for (const NamedPicture& each : asked) request.shown.push_back(each.shown);
    ASSIGN_OR_RETURN(const auto pictures,
                     PictureSource::open(options.scene, options.pictures, stop.token()));
    lookAtAll(*pictures, options, request);
    ASSIGN_OR_RETURN(const coordinator::RenderedFrame frame, pictures->draw(request));
    if (frame.further.size() + 1 != asked.size() || frame.pictures.size() != asked.size())
        return absl::InternalError(fmt::format("{} pictures were asked for, {} were drawn",
                                               asked.size(), frame.further.size() + 1));
    for (std::size_t i = 0; i < asked.size(); ++i) {
        RETURN_IF_ERROR(
            write(i == 0 ? frame.image : frame.further[i - 1], own[i], request, stop.token()));
        if (!options.pictures.quiet && !options.json)
            tell(own[i].out);
        if (!options.pictures.quiet && !frame.pictures[i].whyBlind.empty())
            tell(fmt::format("{}: not all of it is seen: {}", own[i].out,
                             frame.pictures[i].whyBlind));
    }
    const std::string statistics =
        wire::statisticsJson(frame.statistics, request.width, request.height, frame.device);
    if (options.json)
        fmt::print("{}\n", statistics);
    return writeStatistics(statistics, options, stop.token());
}

absl::Status renderFlight(const Options& options) {
    const StopSignal stop;
    if (options.all || options.json || !options.depth.empty() || !options.stats.empty())
        return absl::InvalidArgumentError(
            "--flight is drawn as a video: leave out --all, --depth, --stats and --json");
    ASSIGN_OR_RETURN(const coordinator::FrameRequest request, requestOf(options));
    ASSIGN_OR_RETURN(bench::NamedFlight flight, bench::NamedFlight::read(options.flight));
    return writeFlightVideo(
        {std::move(flight), options.framesPerSecond, options.out, options.pictures.quiet},
        options.scene, options.pictures, request, stop.token());
}

absl::Status renderAsAsked(const Options& options) {
    noteIdleCompound(options.pictures, options.pictures.renderers);
    if (options.hasRate && options.flight.empty() && !options.pictures.quiet)
        tell("--fps has no effect: it is of the video of a --flight");
    if (!options.camera.empty() && !options.flight.empty())
        return absl::InvalidArgumentError(
            "name either --camera, for a picture, or --flight, for a video");
    if (!options.flight.empty())
        return renderFlight(options);
    return options.all ? renderAll(options) : render(options);
}

void addOutputOptions(CLI::App& command, Options& options) {
    command
        .add_option("-o,--output", options.out,
                    "Picture to write: .png, .jpg or .jpeg; of --flight: .mp4, .mkv or .webm")
        ->type_name("FILE")
        ->required();
    command
        .add_option("--depth", options.depth,
                    "PFM to write: view-space metres of what is opaque, inf where nothing is")
        ->type_name("FILE");
    command.add_option("--stats", options.stats, "JSON to write: what was drawn, and how well")
        ->type_name("FILE");
    command.add_flag("--quiet", options.pictures.quiet, "Only warnings and errors");
    command.add_flag("--json", options.json, "Print the statistics as JSON");
}

void addLookOptions(CLI::App& command, Options& options) {
    static const std::map<std::string, fabric::Shading> kShadings = {
        {"smooth", fabric::Shading::Smooth},
        {"gouraud", fabric::Shading::Gouraud},
        {"flat", fabric::Shading::Flat},
        {"wireframe", fabric::Shading::Wireframe}};
    command.add_option("--shading", options.shading, "How surfaces are drawn [smooth]")
        ->transform(valueOf(kShadings))
        ->type_name("smooth|gouraud|flat|wireframe");
    command
        .add_option("--look", options.look,
                    R"(JSON: how objects are shown, such as {"contours":{"intervalMetres":100}})")
        ->type_name("FILE");
    command.add_option("--exaggeration", options.exaggeration,
                       "Terrain's heights times this, before what --look says [1]");
}

}  // namespace

void addRender(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("render", "Render a picture without a screen");
    command->add_option("scene", options->scene, "What is drawn, as for `eyrie serve`")
        ->type_name("FILE|URL")
        ->required();
    command
        ->add_option("--camera", options->camera,
                     R"(JSON: {"eye":[x,y,z],"target":[x,y,z],"up":[0,0,1],"fovyDegrees":45} )"
                     "[all of the scene, as viewers see it first]")
        ->type_name("FILE");
    command
        ->add_option(
            "--flight", options->flight,
            "Draw a video of a flight instead, each picture in full: orbit, walkthrough, "
            "worst, or a file, JSON as the page saves it or a camera path (as for `eyrie bench`). "
            "Needs the module for video, which is built where libavcodec-dev and "
            "libavformat-dev are installed")
        ->type_name("NAME|FILE");
    command->add_option("--fps", options->framesPerSecond, "Of the video, pictures a second")
        ->check(CLI::Range(1, 240))
        ->capture_default_str();
    command
        ->add_option("--size", options->size,
                     "Of the picture, in pixels, up to 16384 a side; of a video even sides, and as "
                     "many pixels as 4096x2304 at most")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    command->add_option("--tau", options->tau, "Screen-space error allowed, in pixels")
        ->capture_default_str();
    addLookOptions(*command, *options);
    addOcclusionOption(*command, options->occlusion);
    command
        ->add_option("--renderers", options->pictures.renderers,
                     "Draw with so many processes instead of in this one [as many as --config "
                     "uses]")
        ->check(CLI::Range(1, RendererProcesses::kMaxCount));
    addConfigOptions(*command, options->pictures.config);
    addShownOptions(*command, options->pictures.config);
    command->add_flag("--all", options->all,
                      "Draw every segment of every canvas, for each eye of it, in one frame: -o "
                      "OUT.png becomes OUT.CANVAS.SEGMENT.png or, of stereo views, "
                      "OUT.CANVAS.SEGMENT.left.png and .right.png, each of --size (names, or "
                      "positions from 0 on where there are none); --depth likewise");
    addDrawingOptions(*command, options->pictures.drawing);
    addOutputOptions(*command, *options);
    command->footer(
        "docs/looks.md explains --look.\n"
        "Examples:\n"
        "  eyrie render scan.ply -o a.png\n"
        "  eyrie render scene.json --camera cam.json --size 1920x1080 --tau 1 -o a.png\n"
        "  eyrie render dem.eyt --camera cam.json --renderers 3 --compound DB \\\n"
        "      -o a.png --depth a.pfm --stats a.json\n"
        "  eyrie render dem.eyt --flight flight.json --fps 30 --size 1280x720 -o flight.mp4\n"
        "  eyrie render scan.eym --camera cam.json --size 1024x1024 --config cave.eqc --all -o "
        "cave.png");
    command->callback([options, command, &run] {
        options->hasRate = command->count("--fps") > 0;
        run = [options] { return renderAsAsked(*options); };
    });
}

}  // namespace eyrie::cli
