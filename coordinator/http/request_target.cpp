// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/request_target.h"

#include <algorithm>

#include <fmt/format.h>

namespace eyrie::http {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

bool isOneOf(char c, std::string_view characters) {
    return characters.find(c) != std::string_view::npos;
}

/// RFC 3986, 3.1.
bool isScheme(std::string_view text) {
    return !text.empty() && isOneOf(text.front(), kLetters) &&
           std::ranges::all_of(text, [](char c) {
               return isOneOf(c, kLetters) || isOneOf(c, kDigits) || isOneOf(c, "+-.");
           });
}

bool isSame(std::string_view text, std::string_view lowerCase) {
    return std::ranges::equal(text, lowerCase, [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
    });
}

/// "viz", "127.0.0.1:8080", "[::1]:8080": names and addresses as the DNS and URLs have them, and no
/// users. Narrower than RFC 3986, 3.2, which knows names that no system looks up.
bool isHost(std::string_view text) {
    const bool isBracketed = text.starts_with('[');
    const std::size_t end = isBracketed ? text.find(']') : std::min(text.find(':'), text.size());
    if (end == std::string_view::npos)
        return false;
    const std::string_view name = text.substr(isBracketed ? 1 : 0, end - (isBracketed ? 1 : 0));
    const std::string_view port = text.substr(end + (isBracketed ? 1 : 0));
    const std::string_view others = isBracketed ? ":." : "-._";
    const bool hasPort = port.starts_with(':') &&
                         port.substr(1).find_first_not_of(kDigits) == std::string_view::npos;
    return !name.empty() && (port.empty() || hasPort) && std::ranges::all_of(name, [&](char c) {
        return isOneOf(c, kLetters) || isOneOf(c, kDigits) || isOneOf(c, others);
    });
}

}  // namespace

absl::StatusOr<std::optional<AbsoluteTarget>> absoluteTarget(std::string_view target,
                                                             bool isEncrypted) {
    constexpr std::string_view kAfterScheme = "://";
    const std::size_t colon = std::min(target.find(':'), target.size());
    const std::string_view scheme = target.substr(0, colon);
    std::string_view rest = target.substr(colon);
    if (!isScheme(scheme) || !rest.starts_with(kAfterScheme))
        return std::nullopt;
    const std::string_view wanted = isEncrypted ? "https" : "http";
    if (!isSame(scheme, wanted))
        return absl::FailedPreconditionError(
            fmt::format("the target is of scheme '{}', and this connection is of {}; ask for {}:// "
                        "here, or connect otherwise",
                        scheme.substr(0, 16), wanted, wanted));
    rest.remove_prefix(kAfterScheme.size());
    const std::string_view host = rest.substr(0, rest.find_first_of("/?"));
    if (!isHost(host))
        return absl::InvalidArgumentError(
            "the target's host is none; it must be a name or an address, with a port or without, "
            "as "
            "in http://127.0.0.1:8080/");
    rest.remove_prefix(host.size());
    AbsoluteTarget absolute{std::string(host), rest.starts_with('/') ? "" : "/"};
    absolute.target.append(rest);
    return absolute;
}

}  // namespace eyrie::http
