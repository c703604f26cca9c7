// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace eyrie::cli {

/// What --help puts them under.
inline constexpr const char* kCommonGroup = "Every command";

/// Of every command: where options come from, and the log.
struct CommonOptions {
    std::string file;
    bool printsConfig = false;
    std::string logFormat = "text";
    std::string logLevel;  ///< empty: info, or warn where the command is to be quiet
};

/// Adds --options, --print-config, --log-format and --log-level to all commands of `app`, to be
/// called after these have been added. `options` outlives the app.
void addCommonOptions(CLI::App& app, CommonOptions& options);

}  // namespace eyrie::cli
