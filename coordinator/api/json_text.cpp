// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/json_text.h"

#include <iterator>

#include <fmt/format.h>

namespace eyrie::api {

std::string jsonQuoted(std::string_view text) {
    std::string json = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            json += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            fmt::format_to(std::back_inserter(json), "\\u{:04x}", static_cast<unsigned>(c));
        else
            json += c;
    }
    return json + '"';
}

JsonMembers& JsonMembers::text(std::string_view name, std::string_view value) {
    return raw(name, jsonQuoted(value));
}

JsonMembers& JsonMembers::raw(std::string_view name, std::string_view json) {
    members_ += fmt::format("{}{}:{}", members_.empty() ? "" : ",", jsonQuoted(name), json);
    return *this;
}

std::string jsonList(const std::vector<std::string>& elements) {
    std::string list;
    for (const std::string& element : elements) list += (list.empty() ? "" : ",") + element;
    return "[" + list + "]";
}

}  // namespace eyrie::api
