// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

namespace eyrie::cli {

/// A command line with what the environment and a file add to it.
struct CompletedLine {
    std::vector<std::string> arguments;
    /// Where an option's value came from that the user did not give there: option's long name to
    /// "EYRIE_LISTEN" or "options.toml".
    std::map<std::string, std::string> origins = {};
    /// The subcommand that it names; null where there is none.
    const CLI::App* command = nullptr;
};

/// The value of an environment variable; nothing where it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& name)>;

/// "EYRIE_CACHE_SIZE" of "cache-size".
std::string variableOf(const std::string& option);

/// All that completed() looks for in the environment, whatever the command.
std::vector<std::string> variablesOf(const CLI::App& app);

/// Completes what comes after the program's name: an option that is not among `arguments` takes its
/// value from the environment (EYRIE_ and its name; what is empty counts as not set; lists are
/// separated by spaces), and else from the file that --options, or EYRIE_OPTIONS, names. Flags are
/// true or false there. Nothing else of the environment is looked at.
///
/// Errors: those of readOptionsFile; InvalidArgument: a flag that is neither.
absl::StatusOr<CompletedLine> completed(const CLI::App& app, std::vector<std::string> arguments,
                                        const Environment& environment);

}  // namespace eyrie::cli
