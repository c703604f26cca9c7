// SPDX-License-Identifier: Apache-2.0
#include "access/printable.h"

#include <cstdint>

#include <fmt/format.h>

namespace eyrie::access {
namespace {

constexpr std::size_t kMaxBytes = 200;

bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// Bytes of the character that begins with `first`; 0: none does.
std::size_t lengthOf(unsigned char first) {
    if (first < 0x80)
        return 1;
    if (first >= 0xc2 && first < 0xe0)
        return 2;
    if (first >= 0xe0 && first < 0xf0)
        return 3;
    return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

/// Whether the second byte rules out overlong forms, surrogates and what lies beyond U+10FFFF.
bool isSecondByte(unsigned char first, unsigned char second) {
    switch (first) {
        case 0xe0:
            return second >= 0xa0;
        case 0xed:
            return second < 0xa0;
        case 0xf0:
            return second >= 0x90;
        case 0xf4:
            return second < 0x90;
        default:
            return true;
    }
}

}  // namespace

bool isUtf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const auto first = static_cast<unsigned char>(text[at]);
        const std::size_t length = lengthOf(first);
        if (length == 0 || at + length > text.size())
            return false;
        if (length > 1 && !isSecondByte(first, static_cast<unsigned char>(text[at + 1])))
            return false;
        for (std::size_t k = 1; k < length; ++k)
            if (!isContinuation(text[at + k]))
                return false;
        at += length;
    }
    return true;
}

std::string printable(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (result.size() >= kMaxBytes)
            return result + "…";
        if (c >= 0x20 && c < 0x7f)
            result += c;
        else
            result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(c));
    }
    return result;
}

}  // namespace eyrie::access
