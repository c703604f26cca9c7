// SPDX-License-Identifier: Apache-2.0
#include "cli/options/one_of.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fabric/near_name.h"

namespace eyrie::cli {

std::string noneOf(const std::string& word, const std::vector<std::string>& names) {
    return fmt::format("'{}' is none of {}{}", word, fmt::join(names, ", "),
                       fabric::didYouMean(word, names));
}

CLI::Validator oneOf(std::vector<std::string> names) {
    return CLI::Validator(
        [names = std::move(names)](std::string& word) {
            return std::ranges::count(names, word) > 0 ? std::string() : noneOf(word, names);
        },
        "");
}

}  // namespace eyrie::cli
