// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/check/report.h"
#include "cli/commands.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/eqc_reader.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string file;
    bool json = false;
    bool quiet = false;
};

/// A byte more than can be read, so that what is too long is seen to be.
absl::StatusOr<std::string> readText(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::string text;
    if (in) {
        text.resize(config::kLongestText + 1);
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(in.gcount()));
    }
    if (!in && !in.eof())
        return absl::NotFoundError(
            fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
    return text;
}

absl::Status checkFile(const Options& options) {
    check::Checked checked;
    checked.file = options.file;
    ASSIGN_OR_RETURN(const std::string text, readText(options.file));
    checked.configuration = config::readEqc(text, checked.findings);
    if (!checked.findings.hasErrors())
        checked.resolved = config::resolve(checked.configuration, checked.findings);
    if (options.json)
        fmt::print("{}\n", check::json(checked));
    else
        fmt::print(stderr, "{}", config::describe(checked.findings, options.file));
    if (checked.findings.hasErrors())
        return absl::InvalidArgumentError(fmt::format("{}: {} error{}", options.file,
                                                      checked.findings.errors(),
                                                      checked.findings.errors() == 1 ? "" : "s"));
    if (!options.json && !options.quiet)
        fmt::print("{}", check::text(checked));
    return absl::OkStatus();
}

}  // namespace

void addCheck(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "check", "Say what a configuration file is, and all that is wrong in it");
    command->add_option("config", options->file, "An .eqc file of Equalizer, 1.0 to 1.2")
        ->type_name("FILE")
        ->required();
    command->add_flag("--json", options->json, "Print it as JSON");
    command->add_flag("--quiet", options->quiet, "Only errors and warnings");
    command->footer(
        "Prints resources, destination channels, and each compound with all that it inherits: its\n"
        "tasks, its share of the picture, and what its eyes see. Errors and warnings come with "
        "line\n"
        "and column; with an error the exit status is 2.\n\n"
        "Example:\n  eyrie check cave.eqc\n  eyrie check cave.eqc --json");
    command->callback([options, &run] { run = [options] { return checkFile(*options); }; });
}

}  // namespace eyrie::cli
