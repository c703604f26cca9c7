// SPDX-License-Identifier: Apache-2.0
#include "cli/import/options.h"

#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace eyrie::cli {

ProgressBar::Style progressStyle(const ImportOptions& options) {
    return options.progressJson ? ProgressBar::Style::Json : ProgressBar::styleFor(options.quiet);
}

absl::Status checkEnding(const ImportOptions& options, std::string_view ending) {
    if (std::filesystem::path(options.out).extension() == ending)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("-o is '{}'; its name must end in {}", options.out, ending));
}

void addCommonOptions(CLI::App& command, ImportOptions& options) {
    command.add_option("-o,--output", options.out, "File to write")->type_name("FILE")->required();
    command.add_flag("--quiet", options.quiet,
                     "No progress, and nothing of what was made or left out: only errors");
    command.add_flag("--progress-json", options.progressJson,
                     "Progress as lines of JSON on standard error, for programs: a stage, and how "
                     "far that is from 0 to 1");
    command.add_flag("--json", options.json, "Print what was made as JSON");
}

}  // namespace eyrie::cli
