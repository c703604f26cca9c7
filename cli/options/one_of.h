// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace eyrie::cli {

/// What is wrong with `word` where one of `names` has to stand, and which of them is nearest.
std::string noneOf(const std::string& word, const std::vector<std::string>& names);

/// Refuses every word that is none of `names`, on one line that has them all.
CLI::Validator oneOf(std::vector<std::string> names);

template <typename Value>
std::vector<std::string> namesOf(const std::map<std::string, Value>& values) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    return names;
}

/// Refuses as oneOf() does, and gives the option what the word stands for: of an enumeration, which
/// CLI11 reads by its number.
template <typename Value>
CLI::Validator valueOf(std::map<std::string, Value> values) {
    return CLI::Validator(
        [values = std::move(values)](std::string& word) {
            const auto found = values.find(word);
            if (found == values.end())
                return noneOf(word, namesOf(values));
            word = std::to_string(static_cast<int>(found->second));
            return std::string();
        },
        "");
}

}  // namespace eyrie::cli
