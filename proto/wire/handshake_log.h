// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "access/failed_handshakes.h"

namespace eyrie::wire {

/// Why a handshake that ended with gRPC's `error` came to nothing, in the words of OpenSSL or gRPC:
/// "certificate verify failed". Nothing: nobody was refused; the peer hung up, or the server ended.
std::optional<std::string> whyHandshakeFailed(std::string_view error);

/// Finds in gRPC's log who could not connect to this process by TLS, as nothing else of gRPC 1.51
/// tells: a server hears of connections once they are made, and a verifier of certificates only of
/// peers that came as far as showing one.
///
/// The log has two lines of each, on one thread, at level debug: security_handshaker.cc's, at
/// either end of a connection, and chttp2_server.cc's, at ours, which counts it. Neither names the
/// peer. But before the second gRPC has shut the connection down, and has not yet closed it: whose
/// is shut then is the peer, or one of several. Another gRPC may word it otherwise; then nothing
/// is counted, and GrpcHandshakes.* fail. docs/decisions/0090-handshakes-in-grpcs-log.md
///
/// All functions may be called from any thread.
class HandshakeLog {
public:
    using Clock = access::FailedHandshakes::Clock;

    /// Connections looked for a second; more are counted, and not told to the log: a look takes
    /// some system calls for each descriptor of this process.
    static constexpr int kMaxLooks = 20;

    explicit HandshakeLog(access::FailedHandshakes& handshakes) : handshakes_(handshakes) {}

    /// A server of this process listens there, by TLS.
    void watch(int port);

    /// A line of gRPC's log, from source `file`. Returns what to tell ours.
    std::optional<std::string> note(std::string_view file, std::string_view message,
                                    Clock::time_point now = Clock::now());

private:
    bool mayLook(Clock::time_point now);
    std::set<std::uint16_t> ports() const;

    access::FailedHandshakes& handshakes_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::set<std::uint16_t> ports_;
    Clock::time_point second_ = {};  ///< when it began
    int looks_ = 0;                  ///< in that second
};

}  // namespace eyrie::wire
