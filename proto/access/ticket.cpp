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
constexpr std::size_t kMarkDigits = 8;
using Digest = std::array<unsigned char, kDigestBytes>;

Digest sha256(std::string_view text) {
    Digest digest{};
    EVP_Digest(text.data(), text.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
    return digest;
}

/// HMAC-SHA256 of a text, in hexadecimal.
std::string signedBy(std::string_view secret, std::string_view text) {
    Digest digest{};
    HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
         reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data(), nullptr);
    std::string signature;
    for (const unsigned char byte : digest) signature += fmt::format("{:02x}", byte);
    return signature;
}

}  // namespace

std::string makeTicket(std::string_view secret, std::int64_t expires) {
    return fmt::format("{}.{}", expires, signedBy(secret, fmt::format("eyrie ticket {}", expires)));
}

std::string markOf(std::string_view secret) {
    return signedBy(secret, "eyrie ticket's mark").substr(0, kMarkDigits);
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
