// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <stop_token>
#include <string>

#include <absl/status/statusor.h>

#include "service/channel_drawer.h"
#include "wire/security.h"

namespace eyrie::service {

class GlThread;
class RenderServer;

struct RendererNodeOptions {
    std::string coordinator;  ///< its gRPC address: "host:port" or "unix:/path"
    /// Where to serve: "host:port" or "unix:/path". Of a wildcard host such as 0.0.0.0 the
    /// coordinator takes the address that it sees this process come from.
    std::string listen = "127.0.0.1:0";
    std::string node = {};  ///< RegistrationOptions::node
    /// End when the coordinator has been away for giveUpAfter, instead of waiting for it: for
    /// renderers that belong to one `eyrie serve`.
    bool exitWithCoordinator = false;
    std::chrono::milliseconds giveUpAfter{10'000};
    wire::Security security = {};  ///< of its own door, and at the coordinator's and others'
    std::chrono::milliseconds retryInterval{1000};
};

/// One renderer process: all that `eyrie renderer` runs.
class RendererNode {
public:
    /// Creates the drawer on a thread of its own, and serves it. Errors: what `create` says,
    /// InvalidArgument or Unavailable (the address to listen on).
    static absl::StatusOr<std::unique_ptr<RendererNode>> start(const RendererNodeOptions& options,
                                                               const DrawerFactory& create);

    ~RendererNode();
    RendererNode(const RendererNode&) = delete;
    RendererNode& operator=(const RendererNode&) = delete;

    const fabric::DeviceInfo& device() const;
    /// Where it serves, with the port that was chosen.
    const std::string& address() const;

    /// Registers with the coordinator and stays registered until `stop`; then takes no new
    /// channels, finishes those it was given, for 5 seconds at most, and leaves. Returns OK after
    /// `stop`; otherwise why it cannot go on (see keepRegistered).
    absl::Status run(const std::stop_token& stop);

private:
    RendererNode(RendererNodeOptions options, std::unique_ptr<GlThread> thread,
                 std::unique_ptr<RenderServer> server);

    const RendererNodeOptions options_;
    // The server ends first: it waits for the jobs that it has given to the thread.
    const std::unique_ptr<GlThread> thread_;
    const std::unique_ptr<RenderServer> server_;
};

}  // namespace eyrie::service
