// SPDX-License-Identifier: Apache-2.0
#include "fabric/json_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "fabric/utf8.h"

namespace eyrie::fabric {
namespace {

/// The end of the list of numbers alone that begins at `at`; `at` where it is another.
std::size_t endOfNumbers(std::string_view json, std::size_t at) {
    const std::size_t end = json.find_first_not_of(" \n-+.0123456789eE,", at + 1);
    return end != json.npos && json[end] == ']' ? end : at;
}

}  // namespace

std::string quotedJson(std::string_view text) {
    std::string json = "\"";
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        const char c = text.front();
        if (length == 0)
            json += '?';
        else if (c == '"' || c == '\\')
            json += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            json += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            json += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return json + '"';
}

std::string numberJson(double value) {
    if (std::isnan(value))
        return "null";
    if (std::isinf(value))
        return value > 0 ? "\"Infinity\"" : "\"-Infinity\"";
    return fmt::format("{}", value);
}

/// In place: nothing becomes longer, and what has pictures or traces in it is large.
void joinNumbers(std::string& json) {
    std::size_t kept = 0;
    std::size_t end = 0;  // of the list that is being joined
    bool isInText = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (i < end && (c == ' ' || c == '\n')) {
            if (json[kept - 1] == ',')
                json[kept++] = ' ';
            continue;
        }
        json[kept++] = c;
        if (c == '"')
            isInText = !isInText;
        else if (c == '\\' && isInText && i + 1 < json.size())
            json[kept++] = json[++i];
        else if (c == '[' && !isInText)
            end = endOfNumbers(json, i);
    }
    json.resize(kept);
}

}  // namespace eyrie::fabric
