// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <stop_token>

#include <absl/status/statusor.h>

#include "cli/drawing_options.h"
#include "cli/renderer_processes.h"
#include "cli/temporary_folder.h"
#include "coordinator/coordinator.h"

namespace eyrie::cli {

/// A coordinator with renderer processes of this machine: they meet in a folder that nobody else
/// can enter, over Unix sockets.
class LocalFarm {
public:
    /// Without renderers yet, and without a scene. The addresses of `options` are those besides
    /// the folder's, and may be none; `drawing` is the renderers'.
    /// Errors: InvalidArgument (`drawing`), Unavailable.
    static absl::StatusOr<std::unique_ptr<LocalFarm>> start(coordinator::CoordinatorOptions options,
                                                            const DrawingOptions& drawing);

    coordinator::Coordinator& coordinator() { return *coordinator_; }
    coordinator::FrameSource& frames() { return coordinator_->frames(); }

    /// Starts `count` renderer processes; returns at once. Called once.
    void startRenderers(int count);

    /// There are to be `count` renderer processes from now on, once some have been started.
    void setRenderers(int count) { renderers_->setCount(count); }

    /// Waits until `count` renderers have the scene open and frames can be had. Errors:
    /// FailedPrecondition (none can work here, they have said why; or too few can draw this, with
    /// why), DeadlineExceeded (with what is amiss), Cancelled.
    absl::Status awaitRenderers(int count, std::chrono::milliseconds limit,
                                const std::stop_token& stop);

    /// FailedPrecondition when every renderer failed before it ever worked.
    absl::Status check() const;

private:
    LocalFarm(TemporaryFolder folder, std::unique_ptr<coordinator::Coordinator> coordinator,
              DrawingOptions drawing);

    TemporaryFolder folder_;
    const DrawingOptions drawing_;
    std::unique_ptr<coordinator::Coordinator> coordinator_;
    std::unique_ptr<RendererProcesses> renderers_;
    int started_ = 0;
};

}  // namespace eyrie::cli
