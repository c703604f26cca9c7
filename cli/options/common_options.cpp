// SPDX-License-Identifier: Apache-2.0
#include "cli/options/common_options.h"

#include "cli/options/one_of.h"

namespace eyrie::cli {
namespace {

void addTo(CLI::App& command, CommonOptions& options) {
    command
        .add_option("--options", options.file,
                    "A file of options, TOML or INI: for what neither the command line says nor "
                    "the environment, EYRIE_ and the option's name (docs/operations.md)")
        ->type_name("FILE")
        ->group(kCommonGroup);
    command
        .add_flag("--print-config", options.printsConfig,
                  "Print every option, its value and where that came from, and end")
        ->group(kCommonGroup);
    command.add_option("--log-format", options.logFormat, "Of the log: text, or JSON, one a line")
        ->check(oneOf({"text", "json"}))
        ->type_name("text|json")
        ->capture_default_str()
        ->group(kCommonGroup);
    command
        .add_option("--log-level", options.logLevel,
                    "The least that is logged [info; warn of render and bench]")
        ->check(oneOf({"trace", "debug", "info", "warn", "error", "off"}))
        ->type_name("trace|debug|info|warn|error|off")
        ->group(kCommonGroup);
}

}  // namespace

void addCommonOptions(CLI::App& app, CommonOptions& options) {
    const auto inner = app.get_subcommands({});
    if (inner.empty() && app.get_parent() != nullptr)
        addTo(app, options);
    for (CLI::App* command : inner) addCommonOptions(*command, options);
}

}  // namespace eyrie::cli
