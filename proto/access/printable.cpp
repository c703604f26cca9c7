// SPDX-License-Identifier: Apache-2.0
#include "access/printable.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "fabric/utf8.h"

namespace eyrie::access {
namespace {

constexpr std::size_t kMaxBytes = 200;

/// As \xNN.
std::string escaped(std::string_view bytes) {
    std::string result;
    for (const char c : bytes) result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(c));
    return result;
}

/// Those of ASCII, and U+0080 to U+009F, which some terminals act on, too.
bool isControl(std::string_view character) {
    const auto last = static_cast<unsigned char>(character.back());
    return character.size() == 1 ? last < 0x20 || last == 0x7f
                                 : character.size() == 2 && character[0] == '\xc2' && last < 0xa0;
}

}  // namespace

bool isUtf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = fabric::utf8Length(text);
        if (length == 0)
            return false;
        text.remove_prefix(length);
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
            result += escaped({&c, 1});
    }
    return result;
}

std::string printableUtf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = fabric::utf8Length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        if (length == 0 || isControl(character))
            result += escaped(character);
        else
            result += character;
        text.remove_prefix(character.size());
    }
    return result;
}

}  // namespace eyrie::access
