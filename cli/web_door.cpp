// SPDX-License-Identifier: Apache-2.0
#include "cli/web_door.h"

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cli/stop_limit.h"
#include "cli/values.h"
#include "coordinator/api/api.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

/// How long the doors may take to close before the frames in progress are given up: longer than
/// viewers are given, and so that the process ends within 5 seconds.
constexpr std::chrono::milliseconds kPatience{3'000};

/// share/eyrie/web beside the bin folder that this program is in.
std::filesystem::path webFolder() {
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    return program.parent_path().parent_path() / "share" / "eyrie" / "web";
}

}  // namespace

absl::StatusOr<std::unique_ptr<http::Server>> openWebDoor(const std::string& listen,
                                                          const Doors& doors,
                                                          const video::Module* video,
                                                          const http::CrowdLimits& limits,
                                                          coordinator::Coordinator& coordinator) {
    ASSIGN_OR_RETURN(const HostPort address, parseHostPort(listen, "--listen"));
    RETURN_IF_ERROR(checkWebDoor(doors,
                                 address.host.find(':') == std::string::npos
                                     ? fmt::format("{}:{}", address.host, address.port)
                                     : fmt::format("[{}]:{}", address.host, address.port),
                                 "--listen"));
    http::ServerOptions options;
    options.gate = doors.gate;
    options.localNamesOnly = doors.localNamesOnly;
    options.tls = doors.tls;
    options.host = address.host;
    options.port = address.port;
    options.webFolder = webFolder();
    options.api = &coordinator.api().rest();
    options.telemetry = coordinator.telemetry();
    options.video = video;
    options.limits = limits;
    options.sessions = coordinator.api().sessions();
    auto server = http::Server::start(options, coordinator.frames());
    if (server.ok())
        return server;
    const auto message = server.status().message();
    return absl::InvalidArgumentError(
        fmt::format("{}; choose another place with --listen HOST:PORT",
                    std::string_view(message.data(), message.size())));
}

void closeWebDoor(http::Server& door, coordinator::Coordinator& coordinator) {
    const StopLimit limit(kPatience, [&] { coordinator.abandonFrames(); });
    coordinator.drain();  // beside what comes by HTTP
    door.stop();
    coordinator.stop();
}

}  // namespace eyrie::cli
