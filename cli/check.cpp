// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/check/report.h"
#include "cli/commands.h"
#include "cli/configuration_file.h"
#include "cli/image_files.h"
#include "cli/log.h"
#include "cli/own_places.h"
#include "coordinator/compound/plan_check.h"
#include "coordinator/config/configuration_message.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

struct Options {
    std::string file;
    std::string convert;
    int renderers = 0;
    bool json = false;
    bool quiet = false;
};

absl::Status checkNames(const Options& options) {
    if (options.convert.empty() || isJson(options.convert) || options.convert.ends_with(".eqc"))
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("--convert is '{}'; its name must end in .eqc or .json", options.convert));
}

absl::Status convert(config::Configuration configuration, const std::string& path) {
    if (isJson(path))
        return writeText(config::writeJson(configuration), path);
    // Whatever it was read from, it has what the newest version has: text of an older one would be
    // brought to that once more.
    configuration.version = config::kNewestVersion;
    return writeText(config::writeEqc(configuration), path);
}

absl::Status checkFile(const Options& options) {
    RETURN_IF_ERROR(checkNames(options));
    RETURN_IF_ERROR(checkOwnPlaces(std::array{NamedFile{"--convert", options.convert}},
                                   std::array{NamedFile{"the configuration", options.file}}));
    check::Checked checked;
    checked.file = options.file;
    ASSIGN_OR_RETURN(checked.configuration, readConfiguration(options.file, checked.findings));
    if (!checked.findings.hasErrors())
        checked.resolved = config::resolve(checked.configuration, checked.findings);
    if (!checked.findings.hasErrors())
        compound::checkPlans(checked.configuration, checked.findings);
    if (!checked.findings.hasErrors() && options.renderers > 0)
        checked.started =
            check::startedWith(checked.configuration, static_cast<std::size_t>(options.renderers));
    if (options.json)
        fmt::print("{}\n", check::json(checked));
    else if (checked.findings.hasErrors())
        tellErrors(config::describe(checked.findings, options.file));
    else
        tell(config::describe(checked.findings, options.file));
    if (checked.findings.hasErrors())
        return absl::InvalidArgumentError(fmt::format("{}: {} error{}", options.file,
                                                      checked.findings.errors(),
                                                      checked.findings.errors() == 1 ? "" : "s"));
    if (!options.convert.empty())
        RETURN_IF_ERROR(convert(checked.configuration, options.convert));
    if (!options.json && !options.quiet && options.convert.empty())
        fmt::print("{}", check::text(checked));
    return absl::OkStatus();
}

}  // namespace

void addCheck(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "check", "Say what a configuration file is, and all that is wrong in it");
    command
        ->add_option("config", options->file,
                     "An .eqc file of Equalizer, 1.0 to 1.2, or a .json file of the same")
        ->type_name("FILE")
        ->required();
    command->add_flag("--json", options->json, "Print it as JSON");
    command
        ->add_option("--convert", options->convert,
                     "Write it in the other form, whole or not at all: a name that ends in .eqc or "
                     ".json")
        ->type_name("FILE");
    command
        ->add_option("--renderers", options->renderers,
                     "Say, too, what is started where so many renderers are present, and how many "
                     "are missing")
        ->check(CLI::Range(1, 1024));
    command->add_flag("--quiet", options->quiet, "Only errors, warnings and notes");
    command->footer(
        "Prints resources, canvases, destination channels, and each compound with all that it\n"
        "inherits: its tasks, its share of the picture, and what its eyes see, where heads are in\n"
        "their places. Errors and warnings come with line and column or, of JSON, with the field;\n"
        "with an error the exit status is 2.\n\n"
        "Examples:\n"
        "  eyrie check cave.eqc\n"
        "  eyrie check cave.eqc --renderers 4\n"
        "  eyrie check cave.eqc --json\n"
        "  eyrie check cave.eqc --convert cave.json");
    command->callback([options, &run] { run = [options] { return checkFile(*options); }; });
}

}  // namespace eyrie::cli
