// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "access/rare_warnings.h"

namespace eyrie::access {

/// Encrypted connections that came to nothing as the peer and this process did not agree on one:
/// counted, and due for the log once a minute and address. All functions may be called from any
/// thread.
class FailedHandshakes {
public:
    using Clock = RareWarnings::Clock;

    void count() { ++count_; }
    std::uint64_t soFar() const { return count_; }

    /// What to tell the log of one with `address`, nothing if that is not known, which ended as
    /// `reason` says; nothing: it was told of that address within this minute.
    std::optional<std::string> warning(const std::optional<std::string>& address,
                                       std::string_view reason, Clock::time_point now);

    /// Those at gRPC's ports of this process, of whichever server: gRPC does not say of which.
    /// Lasts as long as the process, as gRPC's threads do.
    static FailedHandshakes& atGrpcPorts();

private:
    std::atomic<std::uint64_t> count_{0};
    RareWarnings warnings_;
};

}  // namespace eyrie::access
