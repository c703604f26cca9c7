// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/uri_name.h"

#include <charconv>
#include <cstddef>

namespace eyrie::import {

std::string withoutPercents(const std::string& name) {
    constexpr std::size_t kDigits = 2;
    std::string plain;
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name[i] != '%') {
            plain += name[i];
            continue;
        }
        if (name.size() - i <= kDigits)
            return name;
        unsigned byte = 0;
        const char* const first = name.data() + i + 1;
        if (std::from_chars(first, first + kDigits, byte, 16).ptr != first + kDigits || byte == 0)
            return name;
        plain += static_cast<char>(byte);
        i += kDigits;
    }
    return plain;
}

}  // namespace eyrie::import
