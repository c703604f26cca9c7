// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::access {

/// What who asks may do; each may do what those before it may.
enum class Role {
    View = 1,  ///< look: pictures, picks, figures
    Control,   ///< change what everybody sees: layouts, configuration, scene
    Admin,     ///< the rest: data, imports; to be a renderer, or the coordinator of one
};

std::string_view nameOf(Role role);

/// The secrets of a token file, one a line after its role:
///
///     # made by: openssl rand -hex 16
///     view    0f6a3d0c8f6b4a7d9d7f8d6f0c4f5e21
///     admin   6d1f1f9a5f8c4b6e8d5c3a2b1f0e9d8c
///
/// Immutable; any thread.
class Tokens {
public:
    static constexpr std::size_t kMinBytes = 24;
    static constexpr std::size_t kMaxBytes = 256;

    /// Errors: NotFound, PermissionDenied (unreadable here, or readable by everybody or writable by
    /// others: chmod 600 or 640), InvalidArgument (with the line).
    static absl::StatusOr<Tokens> read(const std::filesystem::path& file);

    /// `name` is used in messages, which never quote a secret.
    static absl::StatusOr<Tokens> parse(std::string_view text, std::string_view name);

    /// Compares with every secret, in a time that does not depend on which is like it.
    std::optional<Role> roleOf(std::string_view secret) const;

    /// Of a ticket (ticket.h) for one of the secrets that has not expired at `now`, seconds since
    /// 1970.
    std::optional<Role> roleOfTicket(std::string_view ticket, std::int64_t now) const;

    /// Whether it is that of a secret (ticket.h): only tickets that came with it can be for one.
    bool hasMark(std::string_view mark) const { return marks_.contains(mark); }

    /// The first secret of that role; empty: there is none.
    std::string_view first(Role role) const;

private:
    struct Token {
        Role role = Role::View;
        std::string secret;
    };
    absl::Status add(std::string_view line, std::string_view place);

    std::vector<Token> tokens_;
    std::set<std::string, std::less<>> marks_;
};

}  // namespace eyrie::access
