// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/compound_names.h"
#include "cli/config_options.h"
#include "cli/door_options.h"
#include "cli/drawing_options.h"
#include "cli/hardware_devices.h"
#include "cli/load_scene.h"
#include "cli/local_farm.h"
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

/// How long the address waits for the first renderer; the page says what is amiss after that.
constexpr std::chrono::seconds kFirstRendererLimit{20};
constexpr std::chrono::milliseconds kPollInterval{100};

struct Options {
    ShownData data;
    std::string listen = "127.0.0.1:8080";
    std::string grpc;  ///< empty: nowhere
    bool grpcReflection = false;
    DrawingOptions drawing;
    ConfigOptions config;
    DoorOptions door;
    ProgramOptions programs;
    QuotaOptions quotas;
    int renderers = 0;  ///< 0: as many as suit this machine
    bool h264 = false;
    bool quiet = false;
};

/// Checks the number of renderers; turns auto into the 0 that stands for it, and is taken, too.
std::string countOrAuto(std::string& text) {
    if (text == "auto") {
        text = "0";
        return {};
    }
    if (CLI::Range(0, RendererProcesses::kMaxCount)(text).empty())
        return {};
    return fmt::format("{} is neither auto nor 1 to {}", text, RendererProcesses::kMaxCount);
}

void announce(const std::string& url, const coordinator::Status& status, bool quiet) {
    fmt::print("Eyrie is at {}\n", url);
    std::fflush(stdout);
    if (quiet || status.renderers.empty())
        return;
    const fabric::DeviceInfo& device = status.renderers.front().device;
    spdlog::info("drawing with {} ({}{}); Ctrl-C ends it", device.renderer, device.platform,
                 device.software ? ", software" : "");
}

using Shown = std::vector<coordinator::CanvasStatus>;

/// As many renderers as somebody asked for; as many as what is shown of the configuration uses; as
/// many as suit this machine.
class RendererCount {
public:
    RendererCount(int asked, const std::optional<config::Configuration>& configuration)
        : fixed_(asked > 0 || configuration ? asked
                                            : RendererProcesses::suitableCount(hardwareDevices())),
          configuration_(configuration) {}

    bool isFixed() const { return fixed_ > 0; }
    int of(const Shown& shown) const {
        if (isFixed())
            return fixed_;
        return std::min(renderersOf(*configuration_, shown), RendererProcesses::kMaxCount);
    }

private:
    const int fixed_;  ///< 0: it depends
    const std::optional<config::Configuration> configuration_;
};

/// Until the user has had enough; an error when no renderer can work. Renderers come and go with
/// what is `shown`.
absl::Status serveUntilStopped(LocalFarm& farm, const RendererCount& count, Shown shown,
                               const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        RETURN_IF_ERROR(farm.check());
        if (!count.isFixed())
            if (Shown now = farm.frames().status().canvases; now != shown) {
                shown = std::move(now);
                farm.setRenderers(count.of(shown));
            }
        std::this_thread::sleep_for(kPollInterval);
    }
    return absl::OkStatus();
}

absl::StatusOr<coordinator::CoordinatorOptions> settingsOf(const Options& options,
                                                           const Doors& doors) {
    coordinator::CoordinatorOptions settings;
    settings.grpcAddresses = {};
    if (!options.grpc.empty()) {
        RETURN_IF_ERROR(fabric::withContext(wire::checkAddress(options.grpc), "--grpc"));
        RETURN_IF_ERROR(checkGrpcDoor(doors, options.grpc, "--grpc"));
        settings.grpcAddresses = {options.grpc};
        settings.grpcReflection = options.grpcReflection;
        settings.security = doors.security;
    }
    ASSIGN_OR_RETURN(settings.configuration,
                     configurationOf(options.config, toldOf(options.quiet)));
    settings.configurationFile = configurationName(options.config);
    settings.layout = compoundNames().at(options.config.compound);
    settings.dataFolder = options.data.folder;
    ASSIGN_OR_RETURN(settings.programs, programsOf(options.programs));
    ASSIGN_OR_RETURN(settings.quotas, quotasOf(options.quotas));
    return settings;
}

absl::Status serve(const Options& options) {
    const StopSignal stop;
    if (options.quiet)
        quietLog();
    logWhoShows(options.data);
    ASSIGN_OR_RETURN(const Doors doors, doorsOf(options.door));
    ASSIGN_OR_RETURN(const video::Module* video, videoModule(options.h264));
    ASSIGN_OR_RETURN(coordinator::CoordinatorOptions settings, settingsOf(options, doors));
    const RendererCount count(options.renderers, settings.configuration);
    auto started = LocalFarm::start(std::move(settings), options.drawing);
    if (absl::IsUnavailable(started.status()) && !options.grpc.empty())
        return fabric::withContext(absl::InvalidArgumentError(started.status().message()),
                                   "--grpc");
    ASSIGN_OR_RETURN(const auto farm, std::move(started));
    ASSIGN_OR_RETURN(const auto door, openWebDoor(options.listen, doors, video,
                                                  options.quotas.crowd, farm->coordinator()));
    ASSIGN_OR_RETURN(NamedScene named, loadScene(options.data.names, options.drawing.cache,
                                                 options.quiet, stop.token()));
    RETURN_IF_ERROR(farm->coordinator().setScene(std::move(named.scene), std::move(named.asNamed)));
    const Shown shown = farm->frames().status().canvases;
    farm->startRenderers(count.of(shown));
    const absl::Status ready =
        options.data.names.empty()
            ? absl::OkStatus()  // whoever sets something to show waits himself
            : farm->awaitRenderers(1, kFirstRendererLimit, stop.token());
    RETURN_IF_ERROR(farm->check());
    if (!ready.ok() && !absl::IsCancelled(ready))
        spdlog::warn("{}", std::string_view(ready.message().data(), ready.message().size()));
    if (stop.token().stop_requested())
        return absl::OkStatus();
    announce(door->url(), farm->frames().status(), options.quiet);
    if (!options.grpc.empty()) {
        fmt::print("Programs call by gRPC at {}\n", farm->coordinator().grpcAddresses().back());
        std::fflush(stdout);
    }
    absl::Status end = serveUntilStopped(*farm, count, shown, stop.token());
    closeWebDoor(*door, farm->coordinator());  // while there are renderers
    return end;
}

}  // namespace

void addServe(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("serve", "Show data in the browser, drawn here");
    addShownData(*command, options->data);
    command->add_option("--listen", options->listen, "Where browsers find it; port 0: any free one")
        ->type_name("HOST:PORT")
        ->capture_default_str();
    command
        ->add_option("--grpc", options->grpc,
                     "Where programs call by gRPC; port 0: any free one [nowhere]")
        ->type_name("HOST:PORT|unix:/PATH");
    addReflectionOption(*command, options->grpcReflection)->needs("--grpc");
    command
        ->add_option("--renderers", options->renderers,
                     "Renderer processes; auto: as many as the layouts that --config shows use, at "
                     "any time; one a GPU; without, two (on a single core, one)")
        ->transform(CLI::Validator(countOrAuto, ""))
        ->type_name(fmt::format("auto|1 to {}", RendererProcesses::kMaxCount))
        ->default_str("auto");
    addProgramOptions(*command, options->programs);
    addQuotaOptions(*command, options->quotas);
    addConfigOptions(*command, options->config);
    addDoorOptions(*command, options->door);
    addPeerOptions(*command, options->door);
    addLocalNamesOption(*command, options->door);
    addVideoOption(*command, options->h264);
    addDrawingOptions(*command, options->drawing);
    command->add_flag("--quiet", options->quiet, "No progress, only warnings and errors");
    command->footer(
        "Examples:\n"
        "  eyrie serve dem.tif scan.ply\n"
        "  eyrie serve tiles/*.tif\n"
        "  eyrie serve https://data.example/dem.eyt\n"
        "  eyrie serve scene.json --listen 0.0.0.0:8080 --token-file tokens\n"
        "  eyrie serve scan.ply --config powerwall.eqc\n"
        "  eyrie serve scan.ply --grpc 0.0.0.0:9090 --tls-cert viz.crt --tls-key viz.key \\\n"
        "      --tls-ca ca.crt\n"
        "With --tls-ca who calls at --grpc has to show a certificate of that authority.\n"
        "Ctrl-C ends it.");
    command->callback([options, &run] { run = [options] { return serve(*options); }; });
}

}  // namespace eyrie::cli
