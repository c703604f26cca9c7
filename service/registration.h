// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>

#include <absl/status/status.h>

#include "fabric/statistics.h"
#include "wire/security.h"

namespace eyrie::service {

struct RegistrationOptions {
    std::string coordinator;  ///< "host:port" or "unix:/path"
    std::string address;      ///< where the renderer's RenderService listens
    fabric::DeviceInfo device;
    std::string node = {};  ///< of a configuration, that it is to be, by name or host; empty: any
    wire::Security security = {};  ///< how it shows itself, and knows the coordinator
    std::chrono::milliseconds retryInterval{1000};
    /// How long to live without the coordinator; none: for ever.
    std::optional<std::chrono::milliseconds> giveUpAfter;
    /// How long to wait, once stopped, for the tasks in hand.
    std::chrono::milliseconds drainTime{3'500};
};

/// Offers a renderer to its coordinator and says that it is alive, as often as the coordinator
/// wants, until `stop`. Registers again where the coordinator has forgotten it, at once unless that
/// happens again and again (RejoinPause), and waits for one that is away, telling the log when it
/// goes and when it is back.
///
/// After `stop` it says that it leaves, so that it gets no new tasks, waits until those in hand are
/// done, and returns OK. Errors: Unavailable (away for longer than giveUpAfter), or why the
/// coordinator turned it down, such as FailedPrecondition for another version of Eyrie.
absl::Status keepRegistered(const RegistrationOptions& options, const std::stop_token& stop);

}  // namespace eyrie::service
