// SPDX-License-Identifier: Apache-2.0
#include "access/gate.h"

#include <algorithm>

#include <fmt/format.h>

#include "access/printable.h"
#include "access/ticket.h"
#include "fabric/log.h"

namespace eyrie::access {
namespace {

/// Addresses remembered; the one whose minute began first goes first.
constexpr std::size_t kMaxAddresses = 1024;

std::int64_t unixSeconds(Gate::Clock::time_point time) {
    return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
}

char lower(char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); }

}  // namespace

std::string_view bearerToken(std::string_view authorization) {
    constexpr std::string_view kScheme = "bearer ";
    if (authorization.size() <= kScheme.size() ||
        !std::equal(kScheme.begin(), kScheme.end(), authorization.begin(),
                    [](char wanted, char found) { return wanted == lower(found); }))
        return {};
    authorization.remove_prefix(kScheme.size());
    authorization.remove_prefix(
        std::min(authorization.find_first_not_of(' '), authorization.size()));
    return authorization.size() > Tokens::kMaxBytes ? std::string_view() : authorization;
}

absl::StatusOr<Role> Gate::admit(const Credentials& credentials, std::string_view address,
                                 Role needed, Clock::time_point now) {
    const std::optional<Role> role = roleOf(credentials, now);
    const std::lock_guard lock(mutex_);
    if (!role && credentials.authorization.empty()) {
        Refusals& refusals = refusalsAt(credentials.door);
        ++(credentials.ticket.empty() ? refusals.missing : refusals.wrong);
        // A ticket that has expired is nobody's attack.
        return absl::UnauthenticatedError(
            "this needs a token; the operator has it, in the file that --token-file names");
    }
    if (!role)
        return refuseWrong(credentials.door, address, now);
    if (*role >= needed)
        return *role;
    ++refusalsAt(credentials.door).forbidden;
    return absl::PermissionDeniedError(
        fmt::format("this needs a token of role {}; the one presented is of role {}",
                    nameOf(needed), nameOf(*role)));
}

std::optional<Role> Gate::roleOf(const Credentials& credentials, Clock::time_point now) const {
    if (!credentials.authorization.empty())
        return tokens()->roleOf(bearerToken(credentials.authorization));
    if (!credentials.ticket.empty())
        return tokens()->roleOfTicket(credentials.ticket, unixSeconds(now));
    return std::nullopt;
}

absl::Status Gate::refuseWrong(Door door, std::string_view address, Clock::time_point now) {
    ++refusalsAt(door).wrong;
    Failures& failures = failuresOf(address, now);
    if (++failures.count == 1)
        spdlog::warn("a wrong token came from {}; more of them within a minute are not told",
                     printable(address));
    if (failures.count <= kMaxWrong)
        return absl::UnauthenticatedError("the token is not, or no longer, valid");
    ++refusalsAt(door).limited;
    return absl::ResourceExhaustedError(
        fmt::format("too many wrong tokens from {}; wait a minute", printable(address)));
}

Gate::Failures& Gate::failuresOf(std::string_view address, Clock::time_point now) {
    const auto isOver = [now](const Failures& failures) {
        return now < failures.since || now - failures.since >= kWindow;
    };
    const auto found = failures_.find(address);
    if (found != failures_.end()) {
        if (isOver(found->second))
            found->second = {now, 0};
        return found->second;
    }
    if (failures_.size() >= kMaxAddresses)
        failures_.erase(std::min_element(
            failures_.begin(), failures_.end(),
            [](const auto& a, const auto& b) { return a.second.since < b.second.since; }));
    return failures_.emplace(std::string(address), Failures{now, 0}).first->second;
}

std::string Gate::ticketFor(std::string_view authorization, Clock::time_point now) {
    return makeTicket(bearerToken(authorization), unixSeconds(now + kTicketLife));
}

std::string Gate::markFor(std::string_view authorization) {
    return markOf(bearerToken(authorization));
}

Refusals Gate::refusals(Door door) const {
    const std::lock_guard lock(mutex_);
    return refusals_[static_cast<std::size_t>(door)];
}

}  // namespace eyrie::access
