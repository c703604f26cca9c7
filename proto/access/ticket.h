// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace eyrie::access {

/// Proof that its holder has presented `secret`, until `expires` (seconds since 1970):
/// "EXPIRES.HMAC-SHA256 in hexadecimal". It tells nothing of the secret, nobody can make one
/// without it, and nothing has to be remembered: it outlives a restart, and ends with the secret.
std::string makeTicket(std::string_view secret, std::int64_t expires);

/// Eight hexadecimal digits that tell tickets for one secret from those for others, and nothing of
/// the secret.
std::string markOf(std::string_view secret);

/// When a ticket says that it expires; nothing: it has another form.
std::optional<std::int64_t> expiryOf(std::string_view ticket);

/// Whether two texts are equal, in a time that does not depend on where they differ.
bool isSame(std::string_view a, std::string_view b);

}  // namespace eyrie::access
