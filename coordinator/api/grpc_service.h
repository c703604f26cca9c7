// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/farm/registry.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::coordinator {

/// The coordinator's gRPC door: CoordinatorService, where renderers register, and the standard
/// health service. All functions may be called from any thread.
class GrpcService {
public:
    /// Serves on each of `addresses` ("host:port", port 0: the system chooses; "unix:/path").
    /// `registry` outlives it. The renderers tell
    /// `telemetry` what they draw. Errors: InvalidArgument, Unavailable (an address).
    static absl::StatusOr<std::unique_ptr<GrpcService>> start(
        const std::vector<std::string>& addresses, Registry& registry,
        observe::SharedTelemetry telemetry = nullptr);

    ~GrpcService();
    GrpcService(const GrpcService&) = delete;
    GrpcService& operator=(const GrpcService&) = delete;

    /// Where it listens, with the ports that were chosen.
    const std::vector<std::string>& addresses() const;

    /// Takes no more calls. May be called twice.
    void stop();

private:
    class Impl;
    explicit GrpcService(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::coordinator
