// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/exit_status.h"
#include "fabric/version.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <string>
#include <string_view>

namespace {

using eyrie::cli::ExitStatus;

/// Standard output is for facts and pictures; the log goes beside it.
void startLog() {
    auto logger = spdlog::stderr_color_mt("eyrie");
    logger->set_pattern("%H:%M:%S.%e %^%l%$ %v");
    spdlog::set_default_logger(std::move(logger));
}

void declare(CLI::App& app, eyrie::cli::Run& run) {
    app.set_version_flag("--version", std::string(eyrie::fabric::kVersion));
    app.require_subcommand(1);
    app.footer("`eyrie COMMAND --help` explains a command.\n"
               "Exit status: 0 done, 1 the work failed, 2 the command line or input is wrong.");
    eyrie::cli::addServe(app, run);
    eyrie::cli::addImport(app, run);
    eyrie::cli::addInfo(app, run);
    eyrie::cli::addRender(app, run);
    eyrie::cli::addSynth(app, run);
    eyrie::cli::addCoordinator(app, run);
    eyrie::cli::addRenderer(app, run);
}

}  // namespace

int main(int argc, char** argv) {
    startLog();
    eyrie::cli::Run run;
    CLI::App app("Eyrie shows terrain and massive meshes, drawn by headless renderer processes.",
                 "eyrie");
    declare(app, run);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool asked = app.exit(error) == 0;  // --help and --version
        return static_cast<int>(asked ? ExitStatus::Done : ExitStatus::WrongInput);
    }
    const absl::Status status = run();
    if (!status.ok())
        fmt::print(stderr, "eyrie: {}\n",
                   std::string_view(status.message().data(), status.message().size()));
    return static_cast<int>(eyrie::cli::exitStatusOf(status));
}
