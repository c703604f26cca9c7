// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
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
    std::chrono::milliseconds heartbeatInterval{500};
    int missedHeartbeats = 5;                        ///< so many late ones in a row: dead
    std::chrono::milliseconds deadShownFor{60'000};  ///< how long the dead and refused stay listed
    std::size_t maxRenderers = 256;                  ///< alive ones
    std::size_t maxRefused = 16;                     ///< listed; the latest
    std::size_t maxDisplaced = 64;                   ///< remembered; the latest
};

/// The renderers that have registered: who is alive, and how to reach them.
/// Time comes in as a parameter. All functions may be called from any thread.
class Registry {
public:
    using Clock = ChannelRenderer::Clock;

    enum class Presence {
        Alive,
        Draining,  ///< alive; gets no new tasks, and leaves when it has finished those it has
        Dead,
        Refused,  ///< was never let in
    };

    struct Entry {
        std::string id;
        std::string address;
        fabric::DeviceInfo device;
        std::shared_ptr<ChannelRenderer> renderer;  ///< null: Refused
        Presence presence = Presence::Alive;
        std::string why = {};          ///< it is dead or refused, for a person to read
        Clock::time_point since = {};  ///< it is dead or refused
        std::string node = {};         ///< of a configuration, that it is to be; empty: any

        bool isAlive() const {
            return presence == Presence::Alive || presence == Presence::Draining;
        }
    };

    explicit Registry(const RegistryOptions& options = {}) : options_(options) {}

    const RegistryOptions& options() const { return options_; }

    /// Adds a living renderer, in place of an earlier one at the same address, and returns its id.
    /// ResourceExhausted when there are maxRenderers.
    absl::StatusOr<std::string> add(const std::string& address, const fabric::DeviceInfo& device,
                                    std::shared_ptr<ChannelRenderer> renderer,
                                    Clock::time_point now, std::string node = {});

    /// Lists one that may not register, under its address. A living one there stays.
    void refuse(const std::string& address, const fabric::DeviceInfo& device, std::string_view why,
                Clock::time_point now);

    /// NotFound when the renderer is not registered, or was given up: it is to register again.
    /// FailedPrecondition when another took its place at its address while it was alive: did it
    /// register again, they would displace each other for ever.
    absl::Status heartbeat(const std::string& id, Clock::time_point now);

    /// A heartbeat of one that wants to leave: it drains from now on. NotFound once it is gone.
    absl::Status drain(const std::string& id, Clock::time_point now);

    /// Forgets a renderer that drained and has finished.
    void remove(const std::string& id);

    /// Gives a renderer up; `why` goes to the log.
    void markDead(const std::string& id, std::string_view why, Clock::time_point now);

    /// Gives up renderers whose heartbeats stopped, or whose connection has ended, and forgets
    /// those dead for long. To be called more often than heartbeats come: time in which it was not
    /// called for longer than that, as when this process was stopped, is nobody's silence.
    void expire(Clock::time_point now);

    /// In the order of registration, dead and refused ones included.
    std::vector<Entry> entries() const;

    /// Notified, without locks held, after each change of entries().
    Listeners& listeners() const { return listeners_; }

private:
    struct Record {
        Entry entry;
        Clock::time_point lastSeen;
    };
    struct Displaced {
        std::string id;
        std::string address;
    };

    Record* findAlive(const std::string& id);
    void forgive(Clock::time_point now);
    void trimRefused();
    void displace(const std::string& address);

    const RegistryOptions options_;
    mutable std::mutex mutex_;  ///< guards what follows, but for listeners_
    std::vector<Record> records_;
    std::deque<Displaced> displaced_;  ///< the latest last
    int nextId_ = 1;
    Clock::time_point lastLook_ = Clock::time_point::max();  ///< of expire()
    mutable Listeners listeners_;
};

}  // namespace eyrie::coordinator
