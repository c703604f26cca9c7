// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "access/token_file.h"
#include "access/tokens.h"

namespace eyrie::access {

/// Where somebody asks to come in.
enum class Door { Http, Grpc };

/// What a request brings to show who asks.
struct Credentials {
    std::string_view authorization;  ///< "Bearer TOKEN"; empty: none
    std::string_view ticket;         ///< of a cookie (ticket.h); empty: none
    Door door = Door::Http;
};

/// Turned away at a door so far.
struct Refusals {
    std::uint64_t missing = 0;    ///< brought nothing
    std::uint64_t wrong = 0;      ///< brought what is not, or no longer, valid
    std::uint64_t limited = 0;    ///< of those: after too many wrong ones from its address
    std::uint64_t forbidden = 0;  ///< may do less than it asked for
    /// Could not be spoken to encrypted. No gate's: FailedHandshakes' of gRPC's ports.
    std::uint64_t handshakes = 0;

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

    explicit Gate(Tokens tokens) : fixed_(std::make_shared<const Tokens>(std::move(tokens))) {}
    /// What the file has at each moment.
    explicit Gate(std::shared_ptr<TokenFile> file) : file_(std::move(file)) {}

    /// The role of who asks from `address`, an IP address without a port, when it is at least
    /// `needed`. A right token always passes, whatever others at the same address do: it cannot be
    /// guessed (Tokens::kMinBytes). Errors: Unauthenticated (no or a wrong token), PermissionDenied
    /// (for less), ResourceExhausted (a wrong one, as too many before).
    absl::StatusOr<Role> admit(const Credentials& credentials, std::string_view address,
                               Role needed, Clock::time_point now = Clock::now());

    /// The role of who shows that; nothing: none. Not counted as asking to come in.
    std::optional<Role> roleOf(const Credentials& credentials,
                               Clock::time_point now = Clock::now()) const;

    /// A ticket for the bearer token in `authorization`, which admit() let in.
    static std::string ticketFor(std::string_view authorization,
                                 Clock::time_point now = Clock::now());

    /// What tells tickets for that token from those for others (ticket.h).
    static std::string markFor(std::string_view authorization);
    /// Whether it is that of one of the tokens.
    bool hasMark(std::string_view mark) const { return tokens()->hasMark(mark); }

    /// The first token of that role, for who shows it to others; empty: there is none.
    std::string tokenOf(Role role) const { return std::string(tokens()->first(role)); }

    Refusals refusals(Door door) const;

private:
    struct Failures {
        Clock::time_point since;
        int count = 0;
    };
    absl::Status refuseWrong(Door door, std::string_view address, Clock::time_point now);
    Refusals& refusalsAt(Door door) { return refusals_[static_cast<std::size_t>(door)]; }
    Failures& failuresOf(std::string_view address, Clock::time_point now);

    std::shared_ptr<const Tokens> tokens() const {
        return file_ == nullptr ? fixed_ : file_->current();
    }

    const std::shared_ptr<const Tokens> fixed_;  ///< null: those of the file
    const std::shared_ptr<TokenFile> file_;
    mutable std::mutex mutex_;  ///< guards what follows
    std::map<std::string, Failures, std::less<>> failures_;
    std::array<Refusals, 2> refusals_;  ///< by Door
};

/// "TOKEN" of "Bearer TOKEN"; empty: of another form.
std::string_view bearerToken(std::string_view authorization);

}  // namespace eyrie::access
