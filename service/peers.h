// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include <absl/status/status.h>

#include "fabric/image.h"
#include "service/mailbox.h"
#include "wire/security.h"

namespace eyrie::service {

/// The other renderers, as one that sends them pictures sees them. Connections stay open from one
/// frame to the next. All functions may be called from any thread.
class Peers {
public:
    using Clock = std::chrono::steady_clock;

    /// Connections kept open; the one longest unused goes first.
    static constexpr std::size_t kMaxConnections = 64;

    /// `security` is how this renderer shows itself to the others.
    explicit Peers(wire::Security security = {});
    ~Peers();
    Peers(const Peers&) = delete;
    Peers& operator=(const Peers&) = delete;

    /// Sends a picture to the renderer at `address`, and waits until that has taken it. Errors:
    /// Unavailable (nobody listens), DeadlineExceeded, Cancelled after `stop`, what the peer says.
    absl::Status send(const std::string& address, const FrameKey& key, const fabric::Image& image,
                      Clock::time_point deadline, const std::stop_token& stop);

private:
    struct Connection;

    std::shared_ptr<Connection> connectionTo(const std::string& address);

    const wire::Security security_;
    std::mutex mutex_;                                    ///< guards connections_
    std::list<std::shared_ptr<Connection>> connections_;  ///< the last used one first
};

}  // namespace eyrie::service
