// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <malloc.h>

#include "cli/commands.h"
#include "cli/exit_status.h"
#include "cli/log.h"
#include "cli/lost_bytes.h"
#include "cli/options/common_options.h"
#include "cli/options/completed_line.h"
#include "cli/options/options_file.h"
#include "cli/options/print_config.h"
#include "cli/options/unplaced_word.h"
#include "fabric/version.h"

namespace {

using eyrie::cli::CompletedLine;
using eyrie::cli::ExitStatus;

/// Pictures are megabytes that come and go every frame. By default each would be mapped anew and
/// faulted in page by page, which costs more than filling it.
void keepFreedPictures() {
    mallopt(M_MMAP_THRESHOLD, 64 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

void declare(CLI::App& app, eyrie::cli::Run& run, eyrie::cli::CommonOptions& common) {
    app.set_version_flag("--version", std::string(eyrie::fabric::kVersion));
    app.require_subcommand(1);
    app.footer(
        "`eyrie COMMAND --help` explains a command.\n"
        "Exit status: 0 done, 1 the work failed, 2 the command line or input is wrong.");
    eyrie::cli::addServe(app, run);
    eyrie::cli::addImport(app, run);
    eyrie::cli::addInfo(app, run);
    eyrie::cli::addCheck(app, run);
    eyrie::cli::addRender(app, run);
    eyrie::cli::addPick(app, run);
    eyrie::cli::addBench(app, run);
    eyrie::cli::addSynth(app, run);
    eyrie::cli::addCoordinator(app, run);
    eyrie::cli::addRenderer(app, run);
    eyrie::cli::addHealth(app, run);
    eyrie::cli::addCommonOptions(app, common);
}

/// Says what is wrong with the command line and where to read on. CLI11 complains of a missing
/// subcommand even where it is one too many that it does not know.
void explain(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const std::string name = eyrie::cli::nameOfCommand(app);
    const std::string unplaced = eyrie::cli::aboutUnplacedWord(app);
    fmt::print(stderr, "eyrie: {}\n", unplaced.empty() ? error.what() : unplaced);
    const bool lacksCommand = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
                              command->get_require_subcommand_min() > 0;
    const std::size_t parents = name.rfind(' ');
    if (lacksCommand)
        fmt::print(stderr, "{}",
                   command->help(parents == std::string::npos ? "" : name.substr(0, parents)));
    else
        fmt::print(stderr, "`{} --help` explains it\n", name);
}

std::optional<std::string> variable(const std::string& name) {
    const char* value = std::getenv(name.c_str());
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

void parse(CLI::App& app, const CompletedLine& line) {
    std::vector<std::string> backwards(line.arguments.rbegin(), line.arguments.rend());
    app.parse(std::move(backwards));
}

std::string textOf(const absl::Status& status) {
    return {status.message().data(), status.message().size()};
}

/// "--cache-size" does not name --cache.
bool namesOption(std::string_view text, const std::string& option) {
    const std::string name = "--" + option;
    for (std::size_t at = text.find(name); at != std::string_view::npos;
         at = text.find(name, at + 1)) {
        const std::string_view rest = text.substr(at + name.size());
        if (rest.empty() ||
            (rest[0] != '-' && std::isalnum(static_cast<unsigned char>(rest[0])) == 0))
            return true;
    }
    return false;
}

/// Which option that the error may be about was not on the command line.
void tellOrigins(const CompletedLine& line, std::string_view error) {
    for (const auto& [option, origin] : line.origins)
        if (namesOption(error, option))
            eyrie::cli::logFailure(fmt::format("--{} comes from {}", option, origin));
}

ExitStatus runCommandLine(int argc, char** argv) {
    eyrie::cli::startLog();
    keepFreedPictures();
    eyrie::cli::Run run;
    eyrie::cli::CommonOptions common;
    CLI::App app("Eyrie shows terrain and massive meshes, drawn by headless renderer processes.",
                 "eyrie");
    declare(app, run, common);
    const auto line = eyrie::cli::completed(app, {argv + 1, argv + argc}, variable);
    if (!line.ok()) {
        fmt::print(stderr, "eyrie: {}\n", textOf(line.status()));
        return ExitStatus::WrongInput;
    }
    try {
        parse(app, *line);
    } catch (const CLI::Success& asked) {  // --help and --version
        std::ostringstream text;
        app.exit(asked, text);
        fmt::print("{}", text.str());
        return ExitStatus::Done;
    } catch (const CLI::ParseError& error) {
        explain(app, error);
        tellOrigins(*line, error.what());
        return ExitStatus::WrongInput;
    }
    if (common.printsConfig) {
        fmt::print("{}", eyrie::cli::printedConfig(*line));
        return ExitStatus::Done;
    }
    eyrie::cli::startLog(
        {common.logFormat == "json", common.logLevel, eyrie::cli::pathOf(*line->command)});
    const absl::Status status = run();
    if (!status.ok()) {
        eyrie::cli::logFailure(textOf(status));
        tellOrigins(*line, textOf(status));
    }
    return eyrie::cli::exitStatusOf(status);
}

/// What was printed and is lost, as on a full disk, is no success. Until now buffers may hold it.
ExitStatus afterPrinting(ExitStatus status, const std::optional<std::error_code>& known) {
    const bool isFlushed = std::fflush(stdout) == 0;
    const std::string flushError = std::strerror(errno);
    if (isFlushed && std::ferror(stdout) == 0)
        return status;
    const std::string reason = known       ? known->message()
                               : isFlushed ? "bytes were lost"
                                           : flushError;
    eyrie::cli::logFailure("standard output cannot be written: " + reason);
    return ExitStatus::Failed;
}

}  // namespace

int main(int argc, char** argv) {
    // A file larger than is allowed (ulimit -f, systemd's LimitFSIZE) is an error like a full disk,
    // and ends neither a server nor leaves half of a file behind.
    std::signal(SIGXFSZ, SIG_IGN);
    eyrie::cli::sayWhereBytesAreLost();
    ExitStatus status = ExitStatus::Failed;
    std::optional<std::error_code> whyNotPrinted;
    try {
        status = runCommandLine(argc, argv);
    } catch (const std::exception& error) {  // such as too little memory
        const auto* ofSystem = dynamic_cast<const std::system_error*>(&error);
        if (ofSystem != nullptr && std::ferror(stdout) != 0) {
            whyNotPrinted = ofSystem->code();
        } else {
            std::fputs("eyrie: ", stderr);
            std::fputs(error.what(), stderr);
            std::fputs("\n", stderr);
        }
    }
    return static_cast<int>(afterPrinting(status, whyNotPrinted));
}
