// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/api/programs.h"
#include "coordinator/api/quotas.h"
#include "coordinator/config/configuration.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/observe/telemetry.h"
#include "fabric/scene.h"
#include "wire/security.h"

namespace eyrie::api {
class Api;
}

namespace eyrie::coordinator {

struct CoordinatorOptions {
    /// Where renderers register: "host:port" (port 0: the system chooses) or "unix:/path".
    std::vector<std::string> grpcAddresses{"127.0.0.1:0"};
    /// How frames are made; nothing: by a configuration of the renderers there are.
    std::optional<config::Configuration> configuration = {};
    std::string layout = {};  ///< of that, at first; empty: 2D (config::defaultConfiguration)
    /// What `configuration` was read from: what is set of it is kept for this name.
    std::string configurationFile = {};
    /// How renderers and the coordinator know each other; nothing: whoever reaches the addresses.
    wire::Security security = {};
    /// Where programs may name files, keep flights and have data imported, and where what they set
    /// is kept for the next coordinator; empty: nowhere.
    std::filesystem::path dataFolder = {};
    api::Programs programs = {};  ///< what programs may have done by other processes
    api::Quotas quotas = {};      ///< what they may ask for
    bool grpcReflection = false;  ///< tools may ask over gRPC which calls there are
    /// Whoever runs it starts renderers, and starts them again: nobody is told to start one.
    bool startsRenderers = false;
    /// Of .eyt and .eym files that the renderers can read. Without objects: setScene() follows.
    fabric::Scene scene = {};
};

/// A coordinator without its doors for browsers: renderers register with it, and it makes frames
/// with those it has. All functions may be called from any thread.
class Coordinator {
public:
    /// Errors: InvalidArgument (the scene, or an address of another form), Unavailable (an address
    /// that cannot be listened on).
    static absl::StatusOr<std::unique_ptr<Coordinator>> start(const CoordinatorOptions& options);

    ~Coordinator();
    Coordinator(const Coordinator&) = delete;
    Coordinator& operator=(const Coordinator&) = delete;

    /// Lives as long as the coordinator. End what calls renderFrame before the coordinator.
    FrameSource& frames();

    /// For programs, over gRPC already. Lives as long as the coordinator.
    const api::Api& api() const;

    /// What it tells of itself.
    const observe::SharedTelemetry& telemetry() const;

    /// Where renderers register, with the ports that were chosen.
    const std::vector<std::string>& grpcAddresses() const;

    /// Has all renderers open `scene` in place of the one before: as CoordinatorOptions::scene, for
    /// which another may have been set before. Without objects it is for programs to say what is
    /// shown. What others were set in its place is known again by `asNamed`, where that is not
    /// `scene`: without what was found for it in its files. InvalidArgument: fabric::validate
    /// refuses it.
    absl::Status setScene(fabric::Scene scene, std::optional<fabric::Scene> asNamed = {});

    /// Takes no more calls of programs over gRPC; those in progress go on, and renderers are heard
    /// as before. Streams of statistics end.
    void drain();

    /// drain(), a wait for calls in progress, of some seconds since then at most, and no more
    /// registrations. Frames can still be made with the renderers there are, until
    /// their heartbeats are missed. May be called twice.
    void stop();

    /// Ends, with errors and soon, all frames in progress and every later one, whatever renderers
    /// do: for who cannot wait for them any longer.
    void abandonFrames();

private:
    class Impl;
    explicit Coordinator(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::coordinator
