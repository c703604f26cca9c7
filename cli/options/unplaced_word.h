// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace eyrie::cli {

/// "eyrie import mesh" of an `app` that has parsed a line with these commands.
std::string nameOfCommand(const CLI::App& app);

/// What is wrong with the first word of the parsed line that belongs nowhere: no option or command
/// of that name, with the one that is likely meant, or an option that stands before its command.
/// Empty where each word has its place.
std::string aboutUnplacedWord(const CLI::App& app);

}  // namespace eyrie::cli
