// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>
#include <system_error>

/// The words of .jdn scenes (jdn_reader.h).
namespace eyrie::import {

inline bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

/// As many numbers as `values` holds, no more and no less.
template <typename Number>
bool parseNumbers(std::string_view text, std::span<Number> values) {
    for (Number& value : values) {
        text = trimmed(text);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc())
            return false;
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (!text.empty() && !isBlank(text.front()))
            return false;
    }
    return trimmed(text).empty();
}

}  // namespace eyrie::import
