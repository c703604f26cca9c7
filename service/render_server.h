// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "service/gl_thread.h"
#include "wire/security.h"

namespace eyrie::service {

/// One renderer behind gRPC: RenderService and the standard health service.
class RenderServer {
public:
    /// Listens on "host:port" (port 0: the system chooses) or "unix:/path". `thread` outlives the
    /// server. Who calls is known by `security`. Errors: Unavailable (the address cannot be
    /// listened on).
    static absl::StatusOr<std::unique_ptr<RenderServer>> start(const std::string& address,
                                                               GlThread& thread,
                                                               const wire::Security& security = {});
    ~RenderServer();
    RenderServer(const RenderServer&) = delete;
    RenderServer& operator=(const RenderServer&) = delete;

    /// Where it listens, with the port that was chosen.
    const std::string& address() const;

    /// Has the health service say that this renderer is about to leave; calls are served on.
    void announceLeaving();

    /// Takes no more calls and ends those in progress, after `grace` by cancelling them. Waits for
    /// the channel that is being drawn. May be called twice.
    void stop(std::chrono::milliseconds grace);

private:
    class Impl;
    explicit RenderServer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::service
