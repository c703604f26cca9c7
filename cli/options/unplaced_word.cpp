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

/// What of a command's part of the line belongs nowhere. CLI11 has the mark there, too, behind
/// which words are no options.
std::vector<std::string> unplacedOf(const CLI::App& command) {
    std::vector<std::string> words = command.remaining();
    std::erase(words, "--");
    return words;
}

/// Without the value that is written to it.
std::string nameOf(const std::string& word) { return word.substr(0, word.find('=')); }

std::string isNothingThat(const std::string& knower, const std::string& word,
                          const std::vector<std::string>& names) {
    return fmt::format("'{}' is nothing that {} knows{}", word, knower,
                       fabric::didYouMean(nameOf(word), names));
}

}  // namespace

std::string nameOfCommand(const CLI::App& app) {
    std::string name;
    for (const CLI::App* command : commandsOf(app))
        name += (name.empty() ? "" : " ") + command->get_name();
    return name;
}

std::string aboutUnplacedWord(const CLI::App& app) {
    const std::vector<const CLI::App*> commands = commandsOf(app);
    const CLI::App& last = *commands.back();
    std::string soFar;
    for (const CLI::App* command : commands) {
        soFar += (soFar.empty() ? "" : " ") + command->get_name();
        const std::vector<std::string> unplaced = unplacedOf(*command);
        if (unplaced.empty())
            continue;
        const std::string& word = unplaced.front();
        if (command == &last || !word.starts_with('-'))
            return isNothingThat(soFar, word, namesIn(*command));
        if (last.get_option_no_throw(nameOf(word)) == nullptr)
            return isNothingThat(nameOfCommand(app), word, namesIn(last));
        return fmt::format("'{0}' stands before the command; write `{1} {0} ...`", word,
                           nameOfCommand(app));
    }
    return "";
}

}  // namespace eyrie::cli
