// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/config_options.h"
#include "cli/json_object.h"
#include "cli/load_scene.h"
#include "cli/log.h"
#include "cli/pick_text.h"
#include "cli/picture_source.h"
#include "cli/stop_signal.h"
#include "cli/text_file.h"
#include "cli/values.h"
#include "coordinator/config/default_config.h"
#include "coordinator/frame/active_configuration.h"
#include "fabric/seen_area.h"
#include "fabric/status.h"
#include "renderer/pick/picker.h"
#include "wire/json.h"

namespace eyrie::cli {
namespace {

struct Options {
    PictureSourceOptions source;
    std::string scene;
    std::string camera;
    std::string size = "1280x720";
    std::string pixel;
    double exaggeration = 1;
    bool json = false;
};

absl::StatusOr<fabric::PickRequest> requestOf(const Options& options) {
    fabric::PickRequest request;
    ASSIGN_OR_RETURN(const PictureSize size, parsePictureSize(options.size, "--size"));
    ASSIGN_OR_RETURN(const PixelPlace pixel, parsePixel(options.pixel, size, "--pixel"));
    ASSIGN_OR_RETURN(const std::string text, readText(options.camera));
    ASSIGN_OR_RETURN(request.camera, wire::cameraFromJson(text, options.camera));
    request.viewWidth = size.width;
    request.viewHeight = size.height;
    // Pictures count their rows from the top.
    request.place = {pixel.x + 0.5, size.height - pixel.y - 0.5};
    request.exaggeration = options.exaggeration;
    RETURN_IF_ERROR(fabric::validate(request));
    return request;
}

/// By which sights the picture is seen.
absl::StatusOr<fabric::SeenAreas> areasOf(const Options& options,
                                          const fabric::PickRequest& inPicture) {
    ASSIGN_OR_RETURN(const auto configuration,
                     configurationOf(options.source.config, toldOf(options.source.quiet)));
    const bool isPlain = options.source.config.shown == coordinator::Shown{};
    if (!configuration && isPlain)
        return fabric::SeenAreas();
    coordinator::FrameRequest picture;
    picture.camera = inPicture.camera;
    picture.width = inPicture.viewWidth;
    picture.height = inPicture.viewHeight;
    picture.shown = {options.source.config.shown};
    const std::vector<config::RendererFacts> oneRenderer{{"", "", ""}};
    const coordinator::ActiveConfiguration active(
        configuration ? *configuration : config::defaultConfiguration(oneRenderer));
    return active.seen(picture);
}

JsonObject vectorJson(const fabric::Vec3& v) {
    return JsonObject().number("x", v.x).number("y", v.y).number("z", v.z);
}

JsonObject toJson(const fabric::PickedPoint& point, const std::string& object) {
    JsonObject json;
    json.text("object", object)
        .object("position", vectorJson(point.worldMetres))
        .object("normal", vectorJson(point.normal))
        .number("distanceMetres", point.distanceMetres)
        .number("errorMetres", point.errorMetres)
        .number("nearestMetres", point.nearestMetres)
        .number("farthestMetres", point.farthestMetres)
        .number("pixelMetres", point.pixelMetres);
    if (point.elevationMetres)
        json.number("elevationMetres", *point.elevationMetres)
            .number("elevationErrorMetres", point.elevationErrorMetres);
    return json;
}

absl::Status pick(const Options& options) {
    const StopSignal stop;
    if (options.source.quiet)
        quietLog("error");
    ASSIGN_OR_RETURN(const fabric::PickRequest request, requestOf(options));
    ASSIGN_OR_RETURN(const fabric::SeenAreas areas, areasOf(options, request));
    ASSIGN_OR_RETURN(const std::optional<fabric::PickRequest> seen, fabric::pickIn(areas, request));
    ASSIGN_OR_RETURN(const NamedScene named,
                     loadScene(std::span(&options.scene, 1), options.source.drawing.cache,
                               options.source.quiet, stop.token()));
    ASSIGN_OR_RETURN(const RemoteData remote, remoteDataOf(options.source.drawing.cache));
    ASSIGN_OR_RETURN(const auto picker,
                     pick::Picker::open(
                         named.scene, page::sourceOptions(remote.cacheFolder, remote.cacheBytes)));
    fabric::Picked picked;
    if (seen) {
        ASSIGN_OR_RETURN(picked, picker->pick(*seen));
    }
    const std::string object =
        picked ? named.scene.objects[static_cast<std::size_t>(picked->object)].name : "";
    if (options.json)
        fmt::print("{}\n", (picked ? toJson(*picked, object) : JsonObject()).str());
    else if (picked)
        fmt::print("{}", pickText(*picked, object));
    else
        fmt::print("nothing\n");
    return absl::OkStatus();
}

}  // namespace

void addPick(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("pick", "Say what a pixel of a picture shows, and where");
    command->add_option("scene", options->scene, "What is drawn, as for `eyrie serve`")
        ->type_name("FILE|URL")
        ->required();
    command->add_option("--camera", options->camera, "JSON, as for `eyrie render`")
        ->type_name("FILE")
        ->required();
    command->add_option("--size", options->size, "Of the picture, in pixels")
        ->type_name("WIDTHxHEIGHT")
        ->capture_default_str();
    command->add_option("--pixel", options->pixel, "From the upper left one, 0,0, on")
        ->type_name("X,Y")
        ->required();
    command->add_option("--exaggeration", options->exaggeration, "Terrain's heights times this")
        ->capture_default_str();
    addConfigFile(*command, options->source.config);
    addScreenOptions(*command, options->source.config);
    addCacheOptions(*command, options->source.drawing.cache);
    command->add_flag("--quiet", options->source.quiet,
                      "Only warnings of --config and errors, beside the answer");
    command->add_flag("--json", options->json, "Print it as JSON; {} where nothing is");
    command->footer(
        "In double precision, in the finest data, with bounds on the error (docs/errors.md).\n"
        "With --config the picture is what that canvas, segment or eye shows, seen through its "
        "wall;\nwhere two eyes are shown in one place, the left one's.\n"
        "Examples:\n"
        "  eyrie pick dem.eyt --camera cam.json --size 1920x1080 --pixel 960,540 --json\n"
        "  eyrie pick dem.eyt --camera cam.json --pixel 640,360 --config cave.eqc --segment left");
    command->callback([options, &run] { run = [options] { return pick(*options); }; });
}

}  // namespace eyrie::cli
