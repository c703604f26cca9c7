// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

namespace eyrie::http {

struct CrowdLimits {
    std::size_t connections = 512;       ///< of all kinds
    std::size_t viewers = 64;            ///< WebSockets
    std::size_t viewersPerAddress = 16;  ///< a wall has a browser a segment; 0: no limit
    std::size_t sessions = 64;           ///< that are drawn, each for any number of viewers
    std::size_t sessionsPerAddress = 8;  ///< begun by viewers of it; 0: no limit
};

/// Who is connected, and who has to go when it gets crowded. A connection that waits, for its first
/// request or the next one, costs whoever opens it nothing: where there is no place left, the one
/// that has waited longest goes, of the address that has most of them. So neither can an address
/// with many idle connections keep others out, nor do those that are being served ever go.
///
/// Used on the server's thread only, except that places may be given up on any.
class Crowd {
public:
    /// A connection's or a viewer's place; given up when the last copy goes.
    using Place = std::shared_ptr<void>;

    /// One that waits. Destroy it, or end it, when the request has come.
    class Waiting {
    public:
        Waiting() = default;
        ~Waiting() { end(); }
        Waiting(const Waiting&) = delete;
        Waiting& operator=(const Waiting&) = delete;
        void end();

    private:
        friend class Crowd;
        struct Entry {
            std::string address;
            std::function<void()> drop;
        };
        std::list<Entry>* queue_ = nullptr;
        std::list<Entry>::iterator at_;
    };

    explicit Crowd(const CrowdLimits& limits);
    Crowd(const Crowd&) = delete;
    Crowd& operator=(const Crowd&) = delete;

    /// A place for a new connection; null when all are taken by those being served.
    Place enter();

    /// `drop` is called when the connection has to make room: it ends `waiting` and gives up its
    /// place before it returns. Not called after the end of `waiting`.
    void await(Waiting& waiting, const std::string& address, std::function<void()> drop);

    /// A place for a viewer in `session`; empty: in one of its own. ResourceExhausted when there
    /// are too many viewers or sessions, of all or of `address`; a session counts as of the address
    /// that began it, until its last viewer has gone.
    absl::StatusOr<Place> seat(const std::string& address, const std::string& session);

private:
    /// How many there are, of all and of each address.
    struct Count {
        std::size_t all = 0;
        std::map<std::string, std::size_t> of;

        bool isFull(std::size_t most, std::size_t mostOfOne, const std::string& address) const;
        void leave(const std::string& address);
    };
    struct Taken {
        std::mutex mutex;  ///< guards what follows
        std::size_t connections = 0;
        Count viewers;
        Count sessions;
    };
    bool isFull() const;
    bool dropOne();
    /// One more in a count that is not full; with the lock.
    Place take(Count Taken::*count, const std::string& address) const;

    const CrowdLimits limits_;
    const std::shared_ptr<Taken> taken_;
    std::map<std::string, std::weak_ptr<void>> named_;  ///< places of sessions that have names
    std::list<Waiting::Entry> waiting_;                 ///< who has waited longest is first
};

}  // namespace eyrie::http
