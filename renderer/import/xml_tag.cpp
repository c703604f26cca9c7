// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/xml_tag.h"

namespace eyrie::import {

std::size_t endOfTag(std::string_view text) {
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (quote == 0 && text[i] == '>')
            return i + 1;
        if (quote == 0 && (text[i] == '"' || text[i] == '\''))
            quote = text[i];
        else if (text[i] == quote)
            quote = 0;
    }
    return text.size();
}

std::string_view xmlAttribute(std::string_view tag, std::string_view name) {
    constexpr std::string_view kBlank = " \t\r\n";
    for (std::size_t at = tag.find(name); at != std::string_view::npos;
         at = tag.find(name, at + 1)) {
        if (at == 0 || kBlank.find(tag[at - 1]) == std::string_view::npos)
            continue;
        const std::size_t equals = tag.find_first_not_of(kBlank, at + name.size());
        if (equals == std::string_view::npos || tag[equals] != '=')
            continue;
        const std::size_t quote = tag.find_first_not_of(kBlank, equals + 1);
        if (quote == std::string_view::npos || (tag[quote] != '"' && tag[quote] != '\''))
            continue;
        const std::size_t end = tag.find(tag[quote], quote + 1);
        if (end != std::string_view::npos)
            return tag.substr(quote + 1, end - quote - 1);
    }
    return {};
}

std::string withValue(std::string_view tag, std::string_view value, std::string_view other) {
    return std::string(tag).replace(static_cast<std::size_t>(value.data() - tag.data()),
                                    value.size(), other);
}

}  // namespace eyrie::import
