// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/door_options.h"
#include "cli/drawing_options.h"
#include "cli/log.h"
#include "cli/stop_signal.h"
#include "cli/values.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "service/renderer_drawer.h"
#include "service/renderer_node.h"
#include "wire/listen.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string coordinator;
    std::string listen = "127.0.0.1:0";
    std::string node;
    int device = -1;
    std::vector<std::string> allowedUrls;
    std::string data;
    std::vector<std::string> dataAt;
    DrawingOptions drawing;
    DoorOptions door;
    bool exitWithCoordinator = false;
    bool quiet = false;
};

absl::Status run(const Options& options) {
    StopSignal stop;
    if (options.quiet)
        quietLog();
    RETURN_IF_ERROR(fabric::withContext(wire::checkAddress(options.coordinator), "--coordinator"));
    RETURN_IF_ERROR(fabric::withContext(wire::checkAddress(options.listen), "--listen"));
    ASSIGN_OR_RETURN(const Doors doors, doorsOf(options.door));
    RETURN_IF_ERROR(checkGrpcDoor(doors, options.listen, "--listen"));
    ASSIGN_OR_RETURN(RendererOptions settings, rendererOptionsOf(options.drawing));
    settings.device = options.device;
    auto places = service::DataPlaces::parse(options.dataAt);
    RETURN_IF_ERROR(fabric::withContext(places.status(), "--data-at"));
    if (!options.data.empty())
        RETURN_IF_ERROR(fabric::withContext(places->lookIn(options.data), "--data"));
    service::RendererNodeOptions node;
    node.coordinator = options.coordinator;
    node.listen = options.listen;
    node.node = options.node;
    node.security = doors.security;
    node.exitWithCoordinator = options.exitWithCoordinator;
    ASSIGN_OR_RETURN(
        const auto renderer,
        service::RendererNode::start(
            node, service::rendererDrawer(settings, page::AllowedUrls(options.allowedUrls),
                                          *std::move(places))));
    const fabric::DeviceInfo& device = renderer->device();
    spdlog::info("drawing with {} ({}, {}) at {}", device.renderer, device.platform,
                 device.software ? "software" : "hardware", renderer->address());
    return renderer->run(stop.token());
}

}  // namespace

void addRenderer(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("renderer", "Draw for a coordinator");
    command->add_option("--coordinator", options->coordinator, "Where it takes registrations")
        ->type_name("HOST:PORT|unix:/PATH")
        ->required();
    command->add_option("--listen", options->listen, "Where to take work; port 0: any free one")
        ->type_name("HOST:PORT|unix:/PATH")
        ->capture_default_str();
    command
        ->add_option(
            "--node", options->node,
            "Name or host of the configuration's node whose pipes it is for, before others "
            "[any]")
        ->type_name("NAME");
    command->add_option("--device", options->device, "EGL device; -1: the first that works")
        ->check(CLI::Range(-1, 255))
        ->capture_default_str();
    command
        ->add_option("--data", options->data,
                     "Folder in which this machine has the scenes' files: each is looked for there "
                     "first, by the longest end of its path that is found "
                     "[where the scene names it]")
        ->type_name("DIR");
    command
        ->add_option(
            "--data-at", options->dataAt,
            "Where this machine has a file, folder or URL that scenes name, such as "
            "/data=/mnt/fast/data; may be given several times, and the longest FROM counts")
        ->type_name("FROM=TO")
        ->allow_extra_args(false);
    command
        ->add_option("--allow-url", options->allowedUrls,
                     "Beginning of the URLs that scenes may name, such as https://data.example/; "
                     "may be given several times; any: all [none]")
        ->type_name("URL")
        ->allow_extra_args(false);
    addDoorOptions(*command, options->door);
    addPeerOptions(*command, options->door);
    addDrawingOptions(*command, options->drawing);
    command->add_flag("--exit-with-coordinator", options->exitWithCoordinator,
                      "End when the coordinator has gone, instead of waiting for it");
    command->add_flag("--quiet", options->quiet, "Only warnings and errors");
    command->footer(
        "Example, on each machine that draws:\n"
        "  eyrie renderer --coordinator viz:9090 --listen 0.0.0.0:0 --memory 8G --token-file "
        "tokens\n"
        "The data must be readable under the paths that the coordinator names, or in --data or\n"
        "where --data-at says, and the same as the other renderers'. URLs are read only where\n"
        "--allow-url says so: else whoever reaches this port could have this machine ask servers\n"
        "that only it can reach. Redirections of an allowed server are followed.\n"
        "EYRIE_EFFECTS=FOLDER takes shaders from there, also while drawing: docs/effects.md.");
    command->callback([options, &run] { run = [options] { return cli::run(*options); }; });
}

}  // namespace eyrie::cli
