// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/farm/channel_renderer.h"
#include "coordinator/farm/listeners.h"
#include "fabric/statistics.h"

namespace eyrie::coordinator {

struct RegistryOptions {
    std::chrono::milliseconds heartbeatInterval{1000};
    int missedHeartbeats = 3;                        ///< so many late ones in a row: dead
    std::chrono::milliseconds deadShownFor{60'000};  ///< how long a dead renderer stays listed
    std::size_t maxRenderers = 256;                  ///< alive ones
};

/// The renderers that have registered: who is alive, and how to reach them.
/// Time comes in as a parameter. All functions may be called from any thread.
class Registry {
public:
    using Clock = ChannelRenderer::Clock;

    struct Entry {
        std::string id;
        std::string address;
        fabric::DeviceInfo device;
        std::shared_ptr<ChannelRenderer> renderer;
        bool alive = true;
    };

    explicit Registry(const RegistryOptions& options = {}) : options_(options) {}

    const RegistryOptions& options() const { return options_; }

    /// Adds a living renderer, in place of an earlier one at the same address, and returns its id.
    /// ResourceExhausted when there are maxRenderers.
    absl::StatusOr<std::string> add(const std::string& address, const fabric::DeviceInfo& device,
                                    std::shared_ptr<ChannelRenderer> renderer,
                                    Clock::time_point now);

    /// NotFound when the renderer is not registered, or was given up: it is to register again.
    absl::Status heartbeat(const std::string& id, Clock::time_point now);

    /// Gives a renderer up; `why` goes to the log.
    void markDead(const std::string& id, std::string_view why, Clock::time_point now);

    /// Gives up renderers whose heartbeats stopped, and forgets those dead for long.
    void expire(Clock::time_point now);

    /// In the order of registration, dead ones included.
    std::vector<Entry> entries() const;

    /// Notified, without locks held, after each change of entries().
    Listeners& listeners() const { return listeners_; }

private:
    struct Record {
        Entry entry;
        Clock::time_point lastSeen;  ///< of a dead one: when it was given up
    };

    Record* find(const std::string& id);

    const RegistryOptions options_;
    mutable std::mutex mutex_;  ///< guards records_ and nextId_
    std::vector<Record> records_;
    int nextId_ = 1;
    mutable Listeners listeners_;
};

}  // namespace eyrie::coordinator
