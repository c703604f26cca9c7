// SPDX-License-Identifier: Apache-2.0
#include "cli/options/unplaced_word.h"

#include <vector>

#include <fmt/format.h>

#include "fabric/near_name.h"

namespace eyrie::cli {
namespace {

/// From the program to the last of the commands that the line names.
std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
    std::vector<const CLI::App*> commands = {&app};
    for (auto named = app.get_subcommands(); !named.empty();
         named = commands.back()->get_subcommands())
        commands.push_back(named.front());
    return commands;
}

/// As they are written: "--listen", "mesh".
std::vector<std::string> namesIn(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* other : command.get_subcommands(nullptr))
        names.push_back(other->get_name());
    return names;
}

}  // namespace

std::string nameOfCommand(const CLI::App& app) {
    std::string name;
    for (const CLI::App* command : commandsOf(app))
        name += (name.empty() ? "" : " ") + command->get_name();
    return name;
}

std::string aboutUnplacedWord(const CLI::App& app) {
    std::vector<const CLI::App*> commands = commandsOf(app);
    const CLI::App& last = *commands.back();
    commands.pop_back();
    for (const CLI::App* command : commands)
        if (const std::vector<std::string> early = command->remaining(); !early.empty())
            return fmt::format("'{0}' stands before the command; write `{1} {0} ...`",
                               early.front(), nameOfCommand(app));
    const std::vector<std::string> unknown = last.remaining();
    if (unknown.empty())
        return "";
    const std::string& word = unknown.front();
    return fmt::format("'{}' is nothing that {} knows{}", word, nameOfCommand(app),
                       fabric::didYouMean(word.substr(0, word.find('=')), namesIn(last)));
}

}  // namespace eyrie::cli
