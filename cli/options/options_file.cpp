// SPDX-License-Identifier: Apache-2.0
#include "cli/options/options_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cli/options/options_text.h"
#include "fabric/near_name.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

constexpr std::array<std::string_view, 4> kOfTheCommandLineOnly = {"help", "version",
                                                                   "print-config", "options"};

bool isOfTheCommandLineOnly(std::string_view name) {
    return std::ranges::find(kOfTheCommandLineOnly, name) != kOfTheCommandLineOnly.end();
}

absl::StatusOr<std::vector<CLI::ConfigItem>> itemsOf(const std::string& path) {
    if (std::error_code error; std::filesystem::is_directory(path, error))
        return absl::InvalidArgumentError(
            fmt::format("--options {}: this is a folder, not a file", path));
    std::ifstream input(path);
    if (!input)
        return absl::NotFoundError(fmt::format("--options {}: cannot be read", path));
    const std::string whole{std::istreambuf_iterator<char>(input), {}};
    const absl::StatusOr<std::string> plain = withoutComments(whole);
    RETURN_IF_ERROR(fabric::withContext(plain.status(), "--options " + path));
    std::istringstream text(*plain);
    CLI::ConfigBase reader;
    reader.comment('\n');  // none are left, and a '#' in quotes is none
    try {
        std::vector<CLI::ConfigItem> items = reader.from_config(text);
        // CLI11's marks of where sections begin and end.
        std::erase_if(items,
                      [](const auto& item) { return item.name == "++" || item.name == "--"; });
        return items;
    } catch (const CLI::Error& error) {
        return absl::InvalidArgumentError(fmt::format("--options {}: {}", path, error.what()));
    }
}

const CLI::App* subcommandOf(const CLI::App& app, const std::string& name) {
    for (const CLI::App* one : app.get_subcommands({}))
        if (one->get_name() == name)
            return one;
    return nullptr;
}

absl::StatusOr<const CLI::App*> commandOf(const CLI::ConfigItem& item, const CLI::App& app) {
    const CLI::App* command = &app;
    for (const std::string& name : item.parents) {
        const CLI::App* inner = subcommandOf(*command, name);
        if (inner == nullptr) {
            std::vector<std::string> names;
            for (const CLI::App* one : command->get_subcommands({}))
                names.push_back(one->get_name());
            return absl::InvalidArgumentError(fmt::format("[{}] is no command{}",
                                                          fmt::join(item.parents, "."),
                                                          fabric::didYouMean(name, names)));
        }
        command = inner;
    }
    return command;
}

/// `command`: the section's, or the program for none.
absl::Status check(const CLI::ConfigItem& item, const CLI::App& app, const CLI::App& command) {
    if (isOfTheCommandLineOnly(item.name))
        return absl::InvalidArgumentError(
            fmt::format("'{}' is for the command line only", item.name));
    std::vector<std::string> known;
    for (const CLI::App* one : commandsOf(command))
        std::ranges::copy(settableNames(*one), std::back_inserter(known));
    if (std::ranges::find(known, item.name) != known.end())
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("'{}' is no option of {}{}", item.name.substr(0, 64),
                    &command == &app ? "any command" : "eyrie " + pathOf(command),
                    fabric::didYouMean(item.name, known)));
}

/// `section` is around `command`, or is it.
bool holds(const CLI::App& section, const CLI::App& command) {
    for (const CLI::App* at = &command; at != nullptr; at = at->get_parent())
        if (at == &section)
            return true;
    return false;
}

}  // namespace

std::vector<std::string> settableNames(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        if (!option->get_lnames().empty() && !isOfTheCommandLineOnly(option->get_lnames().front()))
            names.push_back(option->get_lnames().front());
    return names;
}

std::string pathOf(const CLI::App& command) {
    const CLI::App* parent = command.get_parent();
    if (parent == nullptr || parent->get_parent() == nullptr)
        return command.get_name();
    return pathOf(*parent) + " " + command.get_name();
}

std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    const std::vector<const CLI::App*> inner = app.get_subcommands({});
    if (inner.empty())
        return {&app};
    std::vector<const CLI::App*> commands;
    for (const CLI::App* one : inner)
        std::ranges::copy(commandsOf(*one), std::back_inserter(commands));
    return commands;
}

absl::StatusOr<std::map<std::string, std::vector<std::string>>> readOptionsFile(
    const std::string& path, const CLI::App& app, const CLI::App& command) {
    ASSIGN_OR_RETURN(const std::vector<CLI::ConfigItem> items, itemsOf(path));
    const std::vector<std::string> names = settableNames(command);
    std::map<std::string, std::vector<std::string>> values;
    std::map<std::string, std::size_t> depths;  // of the sections that they are from
    for (const CLI::ConfigItem& item : items) {
        const std::string place = "--options " + path;
        const absl::StatusOr<const CLI::App*> section = commandOf(item, app);
        RETURN_IF_ERROR(fabric::withContext(section.status(), place));
        RETURN_IF_ERROR(fabric::withContext(check(item, app, **section), place));
        const bool isHere = std::ranges::find(names, item.name) != names.end();
        if (!isHere || !holds(**section, command))
            continue;
        const auto known = depths.find(item.name);
        if (known != depths.end() && known->second == item.parents.size())
            return absl::InvalidArgumentError(
                fmt::format("{}: '{}' is set twice", place, item.fullname()));
        if (known != depths.end() && known->second > item.parents.size())
            continue;
        depths[item.name] = item.parents.size();
        values[item.name] = item.inputs;
    }
    return values;
}

}  // namespace eyrie::cli
