// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <string>

namespace eyrie::test {

/// Letters and digits of `text`: what a parameterised test may be called.
inline std::string identifier(std::string text) {
    std::erase_if(text, [](unsigned char c) { return std::isalnum(c) == 0; });
    return text;
}

}  // namespace eyrie::test
