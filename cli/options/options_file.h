// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

namespace eyrie::cli {

/// What can be set by the environment and by files: options with a long name that ask for more than
/// help. Their long names without the dashes.
std::vector<std::string> settableNames(const CLI::App& command);

/// "import terrain", from the program's name on.
std::string pathOf(const CLI::App& command);

/// The subcommands at the ends: those that do something.
std::vector<const CLI::App*> commandsOf(const CLI::App& app);

/// The values that a file has for one command: option's long name to values. Its form is that of
/// CLI11's configuration files, which is TOML's as far as they go, and INI's: `listen = "…"` on top
/// for every command that has such an option, or in a section, `[serve]` or `[import.terrain]`,
/// which counts before the top. Lists are `["a", "b"]`.
///
/// Errors: NotFound (the file), InvalidArgument: whatever no command knows, naming what comes near.
absl::StatusOr<std::map<std::string, std::vector<std::string>>> readOptionsFile(
    const std::string& path, const CLI::App& app, const CLI::App& command);

}  // namespace eyrie::cli
