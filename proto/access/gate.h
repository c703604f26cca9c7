// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "access/tokens.h"

namespace eyrie::access {

/// What a request brings to show who asks.
struct Credentials {
    std::string_view authorization;  ///< "Bearer TOKEN"; empty: none
    std::string_view ticket;         ///< of a cookie (ticket.h); empty: none
};

/// Turned away so far.
struct Refusals {
    std::uint64_t missing = 0;    ///< brought nothing
    std::uint64_t wrong = 0;      ///< brought what is not, or no longer, valid
    std::uint64_t limited = 0;    ///< of those: after too many wrong ones from its address
    std::uint64_t forbidden = 0;  ///< may do less than it asked for

    bool operator==(const Refusals&) const = default;
};

/// Decides who comes in. Wrong tokens go to the log once a minute and address, without the token.
/// All functions may be called from any thread.
class Gate {
public:
    using Clock = std::chrono::system_clock;

    /// Wrong tokens from one address within a minute that are answered one by one.
    static constexpr int kMaxWrong = 10;
    static constexpr std::chrono::seconds kWindow{60};
    static constexpr std::chrono::hours kTicketLife{12};

    explicit Gate(Tokens tokens) : tokens_(std::move(tokens)) {}

    /// The role of who asks from `address`, an IP address without a port, when it is at least
    /// `needed`. A right token always passes, whatever others at the same address do: it cannot be
    /// guessed (Tokens::kMinBytes). Errors: Unauthenticated (no or a wrong token), PermissionDenied
    /// (for less), ResourceExhausted (a wrong one, as too many before).
    absl::StatusOr<Role> admit(const Credentials& credentials, std::string_view address,
                               Role needed, Clock::time_point now = Clock::now());

    /// A ticket for the bearer token in `authorization`, which admit() let in.
    static std::string ticketFor(std::string_view authorization,
                                 Clock::time_point now = Clock::now());

    Refusals refusals() const;

private:
    struct Failures {
        Clock::time_point since;
        int count = 0;
    };
    absl::Status refuseWrong(std::string_view address, Clock::time_point now);
    Failures& failuresOf(std::string_view address, Clock::time_point now);

    const Tokens tokens_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::map<std::string, Failures, std::less<>> failures_;
    Refusals refusals_;
};

/// "TOKEN" of "Bearer TOKEN"; empty: of another form.
std::string_view bearerToken(std::string_view authorization);

}  // namespace eyrie::access
