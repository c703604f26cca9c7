// SPDX-License-Identifier: Apache-2.0
#include "cli/options/whole_number.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace eyrie::cli {

CLI::Validator wholeNumber() {
    return CLI::Validator(
        [](std::string& word) {
            std::uint64_t value = 0;
            const char* const last = word.data() + word.size();
            const auto [end, error] = std::from_chars(word.data(), last, value);
            if (error != std::errc() || end != last)
                return fmt::format("'{}' is no whole number from 0 to {}", word,
                                   std::numeric_limits<std::uint64_t>::max());
            word = fmt::format("{}", value);  // that CLI11 takes for octal where it begins with 0
            return std::string();
        },
        "");
}

}  // namespace eyrie::cli
