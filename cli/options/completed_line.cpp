// SPDX-License-Identifier: Apache-2.0
#include "cli/options/completed_line.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "cli/options/options_file.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

using Arguments = std::vector<std::string>;

const CLI::App* commandOf(const CLI::App& app, const Arguments& arguments) {
    const CLI::App* command = &app;
    for (const std::string& word : arguments) {
        const auto inner =
            command->get_subcommands([&](const CLI::App* one) { return one->get_name() == word; });
        if (inner.empty())
            break;
        command = inner.front();
    }
    return command == &app || !command->get_subcommands({}).empty() ? nullptr : command;
}

/// Where options end: at "--", or with the last argument.
Arguments::const_iterator endOfOptions(const Arguments& arguments) {
    return std::ranges::find(arguments, "--");
}

/// "--name", of "--name=value"; "-n", of "-nvalue".
std::string nameIn(const std::string& argument) {
    if (argument.starts_with("--"))
        return argument.substr(0, argument.find('='));
    return argument.starts_with("-") ? argument.substr(0, 2) : std::string();
}

bool isGiven(const CLI::Option& option, const Arguments& arguments) {
    return std::any_of(arguments.begin(), endOfOptions(arguments), [&](const std::string& one) {
        const std::string name = nameIn(one);
        return name.size() > 1 && option.check_name(name);
    });
}

std::optional<std::string> fileOf(const Arguments& arguments, const Environment& environment) {
    constexpr std::string_view kName = "--options";
    for (auto at = arguments.begin(); at != endOfOptions(arguments); ++at) {
        if (*at == kName && std::next(at) != arguments.end())
            return *std::next(at);
        if (at->starts_with("--options="))
            return at->substr(kName.size() + 1);
    }
    auto named = environment(variableOf("options"));
    return named && !named->empty() ? named : std::nullopt;
}

bool isList(const CLI::Option& option) { return option.get_expected_max() > 1; }
bool isFlag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

std::vector<std::string> wordsOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

absl::StatusOr<bool> truthOf(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr std::array<std::string_view, 4> kTrue = {"true", "1", "yes", "on"};
    constexpr std::array<std::string_view, 4> kFalse = {"false", "0", "no", "off"};
    if (std::ranges::find(kTrue, text) != kTrue.end())
        return true;
    if (std::ranges::find(kFalse, text) != kFalse.end())
        return false;
    return absl::InvalidArgumentError(
        fmt::format("is '{}'; a flag is true or false", text.substr(0, 64)));
}

/// What the command line would have to say.
absl::StatusOr<Arguments> argumentsOf(const CLI::Option& option,
                                      const std::vector<std::string>& values) {
    const std::string name = "--" + option.get_lnames().front();
    if (!isList(option) && values.size() != 1)
        return absl::InvalidArgumentError(
            fmt::format("has {} values where one is wanted", values.size()));
    if (isFlag(option)) {
        ASSIGN_OR_RETURN(const bool isSet, truthOf(values.front()));
        return isSet ? Arguments{name} : Arguments{};
    }
    Arguments arguments;
    for (const std::string& value : values) arguments.push_back(name + "=" + value);
    return arguments;
}

}  // namespace

std::string variableOf(const std::string& option) {
    std::string name = "EYRIE_" + option;
    std::ranges::transform(name, name.begin(), [](unsigned char c) {
        return c == '-' ? '_' : static_cast<char>(std::toupper(c));
    });
    return name;
}

std::vector<std::string> variablesOf(const CLI::App& app) {
    std::vector<std::string> variables = {variableOf("options")};
    for (const CLI::App* command : commandsOf(app))
        for (const std::string& name : settableNames(*command))
            variables.push_back(variableOf(name));
    return variables;
}

absl::StatusOr<CompletedLine> completed(const CLI::App& app, std::vector<std::string> arguments,
                                        const Environment& environment) {
    CompletedLine line{std::move(arguments)};
    line.command = commandOf(app, line.arguments);
    if (line.command == nullptr)
        return line;
    std::map<std::string, std::vector<std::string>> inFile;
    const std::optional<std::string> file = fileOf(line.arguments, environment);
    if (file) {
        ASSIGN_OR_RETURN(inFile, readOptionsFile(*file, app, *line.command));
    }
    Arguments added;
    for (const std::string& name : settableNames(*line.command)) {
        const CLI::Option& option = *line.command->get_option("--" + name);
        if (isGiven(option, line.arguments))
            continue;
        std::vector<std::string> values;
        if (const auto variable = environment(variableOf(name)); variable && !variable->empty()) {
            values = isList(option) ? wordsOf(*variable) : std::vector{*variable};
            line.origins[name] = variableOf(name);
        } else if (const auto found = inFile.find(name); found != inFile.end()) {
            values = found->second;
            line.origins[name] = *file;
        } else {
            continue;
        }
        const auto more = argumentsOf(option, values);
        RETURN_IF_ERROR(fabric::withContext(
            more.status(), fmt::format("--{} (from {})", name, line.origins[name])));
        added.insert(added.end(), more->begin(), more->end());
    }
    line.arguments.insert(endOfOptions(line.arguments), added.begin(), added.end());
    return line;
}

}  // namespace eyrie::cli
