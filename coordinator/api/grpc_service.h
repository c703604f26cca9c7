// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/farm/registry.h"
#include "coordinator/observe/telemetry.h"
#include "wire/security.h"

namespace eyrie::api {
class Handlers;
}

namespace eyrie::coordinator {

struct GrpcOptions {
    wire::Security security = {};  ///< who may call, and how renderers know the coordinator
    bool withReflection = false;   ///< tools may ask which calls there are
    observe::SharedTelemetry telemetry = nullptr;  ///< is told what renderers draw
};

/// The coordinator's gRPC door: RegistryService, where renderers register, CoordinatorService, and
/// the standard health service. All functions may be called from any thread.
class GrpcService {
public:
    /// Serves on each of `addresses` ("host:port", port 0: the system chooses; "unix:/path").
    /// `registry` outlives it. Errors: InvalidArgument, Unavailable (an address).
    static absl::StatusOr<std::unique_ptr<GrpcService>> start(
        const std::vector<std::string>& addresses, Registry& registry,
        const GrpcOptions& options = {});

    ~GrpcService();
    GrpcService(const GrpcService&) = delete;
    GrpcService& operator=(const GrpcService&) = delete;

    /// Where it listens, with the ports that were chosen.
    const std::vector<std::string>& addresses() const;

    /// CoordinatorService answers from now on. `handlers` outlive stop().
    void use(const api::Handlers& handlers);

    /// Health checks say from now on that it does not serve, and CoordinatorService takes no more
    /// calls; renderers are heard as before.
    void drain();

    /// Takes no more calls, of renderers neither, and waits for those in progress, which are
    /// cancelled kDrainTimeout after drain(). May be called twice.
    void stop();

    static constexpr std::chrono::milliseconds kDrainTimeout{2'500};

private:
    class Impl;
    explicit GrpcService(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::coordinator
