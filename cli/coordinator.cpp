// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.h"

#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/cache_options.h"
#include "cli/commands.h"
#include "cli/compound_names.h"
#include "cli/config_options.h"
#include "cli/door_options.h"
#include "cli/load_scene.h"
#include "cli/log.h"
#include "cli/program_runs.h"
#include "cli/quota_options.h"
#include "cli/shown_data.h"
#include "cli/stop_signal.h"
#include "cli/video_option.h"
#include "cli/web_door.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "wire/listen.h"

namespace eyrie::cli {
namespace {

struct Options {
    ShownData data;
    std::string listen = "127.0.0.1:8080";
    std::string grpc = "127.0.0.1:9090";
    bool grpcReflection = false;
    CacheOptions cache;
    ConfigOptions config;
    DoorOptions door;
    bool h264 = false;
    ProgramOptions programs;
    QuotaOptions quotas;
    bool quiet = false;
};

absl::Status coordinate(const Options& options) {
    const StopSignal stop;
    if (options.quiet)
        quietLog();
    RETURN_IF_ERROR(fabric::withContext(wire::checkAddress(options.grpc), "--grpc"));
    logWhoShows(options.data);
    ASSIGN_OR_RETURN(const Doors doors, doorsOf(options.door));
    ASSIGN_OR_RETURN(const video::Module* video, videoModule(options.h264));
    RETURN_IF_ERROR(checkGrpcDoor(doors, options.grpc, "--grpc"));
    coordinator::CoordinatorOptions settings;
    settings.security = doors.security;
    settings.grpcAddresses = {options.grpc};
    ASSIGN_OR_RETURN(settings.configuration,
                     configurationOf(options.config, toldOf(options.quiet)));
    settings.configurationFile = configurationName(options.config);
    settings.layout = compoundNames().at(options.config.compound);
    settings.dataFolder = options.data.folder;
    ASSIGN_OR_RETURN(settings.programs, programsOf(options.programs));
    ASSIGN_OR_RETURN(settings.quotas, quotasOf(options.quotas));
    settings.grpcReflection = options.grpcReflection;
    ASSIGN_OR_RETURN(NamedScene named,
                     loadScene(options.data.names, options.cache, options.quiet, stop.token()));
    auto coordinator = coordinator::Coordinator::start(settings);
    if (absl::IsUnavailable(coordinator.status()))  // a port in use: the caller can choose another
        return fabric::withContext(absl::InvalidArgumentError(coordinator.status().message()),
                                   "--grpc");
    RETURN_IF_ERROR(coordinator.status());
    RETURN_IF_ERROR((*coordinator)->setScene(std::move(named.scene), std::move(named.asNamed)));
    ASSIGN_OR_RETURN(const auto door, openWebDoor(options.listen, doors, video,
                                                  options.quotas.crowd, **coordinator));
    fmt::print("Eyrie is at {}\n", door->url());
    for (const std::string& address : (*coordinator)->grpcAddresses())
        fmt::print("Renderers register at {}\n", address);
    std::fflush(stdout);
    stop.wait();
    closeWebDoor(*door, **coordinator);
    return absl::OkStatus();
}

}  // namespace

void addCoordinator(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("coordinator", "Show data in the browser, drawn by other processes");
    addShownData(*command, options->data);
    command->add_option("--listen", options->listen, "Where browsers find it; port 0: any free one")
        ->type_name("HOST:PORT")
        ->capture_default_str();
    command->add_option("--grpc", options->grpc, "Where renderers register; port 0: any free one")
        ->type_name("HOST:PORT|unix:/PATH")
        ->capture_default_str();
    addProgramOptions(*command, options->programs);
    addQuotaOptions(*command, options->quotas);
    addReflectionOption(*command, options->grpcReflection);
    addConfigOptions(*command, options->config);
    addDoorOptions(*command, options->door);
    addPeerOptions(*command, options->door);
    addLocalNamesOption(*command, options->door);
    addVideoOption(*command, options->h264);
    addCacheOptions(*command, options->cache);
    command->add_flag("--quiet", options->quiet, "No progress, only warnings and errors");
    command->footer(
        "Example:\n"
        "  eyrie coordinator --listen 0.0.0.0:8080 --grpc 0.0.0.0:9090 \\\n"
        "      --token-file tokens scene.json\n"
        "then `eyrie renderer --coordinator HOST:9090 --listen 0.0.0.0:0 --token-file tokens` on\n"
        "every machine that draws. With --tls-cert, --tls-key and --tls-ca on all of them they\n"
        "are encrypted and show each other certificates: docs/security.md.");
    command->callback([options, &run] { run = [options] { return coordinate(*options); }; });
}

}  // namespace eyrie::cli
