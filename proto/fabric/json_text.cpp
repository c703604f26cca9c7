// SPDX-License-Identifier: Apache-2.0
#include "fabric/json_text.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "fabric/utf8.h"

namespace eyrie::fabric {

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

}  // namespace eyrie::fabric
