// SPDX-License-Identifier: Apache-2.0
#include "access/ticket.h"

#include <array>
#include <charconv>

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

namespace eyrie::access {
namespace {

constexpr std::size_t kDigestBytes = 32;
constexpr std::size_t kMaxTicketBytes = 96;
using Digest = std::array<unsigned char, kDigestBytes>;

Digest sha256(std::string_view text) {
    Digest digest{};
    EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
    return digest;
}

}  // namespace

std::string makeTicket(std::string_view secret, std::int64_t expires) {
    const std::string text = fmt::format("eyrie ticket {}", expires);
    Digest digest{};
    HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
         reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data(), nullptr);
    std::string ticket = fmt::format("{}.", expires);
    for (const unsigned char byte : digest) ticket += fmt::format("{:02x}", byte);
    return ticket;
}

std::optional<std::int64_t> expiryOf(std::string_view ticket) {
    const std::size_t dot = ticket.find('.');
    if (ticket.size() > kMaxTicketBytes || dot == std::string_view::npos)
        return std::nullopt;
    std::int64_t expires = 0;
    const char* end = ticket.data() + dot;
    const auto [stop, error] = std::from_chars(ticket.data(), end, expires);
    return error == std::errc() && stop == end ? std::optional(expires) : std::nullopt;
}

bool isSame(std::string_view a, std::string_view b) {
    // Of digests, which are equally long: so not even the length shows.
    const Digest digestOfA = sha256(a);
    const Digest digestOfB = sha256(b);
    return CRYPTO_memcmp(digestOfA.data(), digestOfB.data(), kDigestBytes) == 0;
}

}  // namespace eyrie::access
