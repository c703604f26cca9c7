// SPDX-License-Identifier: Apache-2.0
#include "cli/local_farm.h"

#include <thread>
#include <utility>

#include <fmt/format.h>

#include "cli/awaited_renderers.h"
#include "cli/hardware_devices.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

constexpr std::chrono::milliseconds kPollInterval{10};

}  // namespace

absl::StatusOr<std::unique_ptr<LocalFarm>> LocalFarm::start(coordinator::CoordinatorOptions options,
                                                            const DrawingOptions& drawing) {
    RETURN_IF_ERROR(rendererOptionsOf(drawing).status());  // said here, not by each of them
    ASSIGN_OR_RETURN(TemporaryFolder folder, TemporaryFolder::create());
    options.startsRenderers = true;
    options.grpcAddresses.insert(options.grpcAddresses.begin(), folder.socket("coordinator"));
    ASSIGN_OR_RETURN(auto coordinator, coordinator::Coordinator::start(options));
    return std::unique_ptr<LocalFarm>(
        new LocalFarm(std::move(folder), std::move(coordinator), drawing));
}

LocalFarm::LocalFarm(TemporaryFolder folder, std::unique_ptr<coordinator::Coordinator> coordinator,
                     DrawingOptions drawing)
    : folder_(std::move(folder)),
      drawing_(std::move(drawing)),
      coordinator_(std::move(coordinator)) {}

void LocalFarm::startRenderers(int count) {
    started_ = count;
    renderers_ = std::make_unique<RendererProcesses>(
        RendererProcessesOptions{count, coordinator_->grpcAddresses().front(), hardwareDevices(),
                                 drawing_},
        folder_);
}

absl::Status LocalFarm::check() const {
    if (!renderers_ || !renderers_->allFailed())
        return absl::OkStatus();
    return absl::FailedPreconditionError(
        "no renderer can work on this machine; each has said why above");
}

absl::Status LocalFarm::awaitRenderers(int count, std::chrono::milliseconds limit,
                                       const std::stop_token& stop) {
    const AwaitedRenderers awaited{count, started_, folder_.socket("")};
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (true) {
        RETURN_IF_ERROR(check());
        const coordinator::Status status = frames().status();
        ASSIGN_OR_RETURN(const bool there, areThere(awaited, status));
        if (there)
            return absl::OkStatus();
        if (stop.stop_requested())
            return absl::CancelledError("stopped");
        if (std::chrono::steady_clock::now() >= deadline)
            return absl::DeadlineExceededError(fmt::format(
                "{} of {} renderers have the scene open after {:.0f} s{}{}",
                drawingRenderers(status), count, std::chrono::duration<double>(limit).count(),
                status.problem.empty() ? "" : ": ", status.problem));
        std::this_thread::sleep_for(kPollInterval);
    }
}

}  // namespace eyrie::cli
