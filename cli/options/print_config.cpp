// SPDX-License-Identifier: Apache-2.0
#include "cli/options/print_config.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/options/options_file.h"

namespace eyrie::cli {
namespace {

std::string quoted(const std::string& value) {
    const bool isPlain = !value.empty() && std::ranges::all_of(value, [](char c) {
        return (c >= '0' && c <= '9') || c == '.' || c == '-';
    });
    const char quote = value.find('"') == std::string::npos ? '"' : '\'';
    return isPlain ? value : quote + value + quote;
}

std::string joined(const std::vector<std::string>& values) {
    if (values.size() == 1)
        return quoted(values.front());
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + quoted(value);
    return "[" + list + "]";
}

std::string lineOf(const CLI::Option& option, const CompletedLine& line) {
    const std::string& name = option.get_lnames().front();
    const auto origin = line.origins.find(name);
    const bool isFlag = option.get_items_expected_max() == 0;
    if (option.count() > 0 || origin != line.origins.end()) {
        const std::string from = origin == line.origins.end() ? "the command line" : origin->second;
        const std::string value =
            isFlag ? (option.count() > 0 ? "true" : "false") : joined(option.results());
        return fmt::format("{} = {}  # {}\n", name, value, from);
    }
    // A setting would be more than the default is: some options need another, or count as given.
    if (isFlag)
        return fmt::format("# {} = false  # default\n", name);
    if (!option.get_default_str().empty())
        return fmt::format("# {} = {}  # default\n", name, quoted(option.get_default_str()));
    return fmt::format("# {} is not set\n", name);
}

}  // namespace

std::string printedConfig(const CompletedLine& line) {
    std::string section = pathOf(*line.command);
    std::ranges::replace(section, ' ', '.');
    std::string text = fmt::format("[{}]\n", section);
    for (const std::string& name : settableNames(*line.command))
        text += lineOf(*line.command->get_option("--" + name), line);
    return text;
}

}  // namespace eyrie::cli
