// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/values.h"
#include "coordinator/http/probe.h"
#include "fabric/status.h"
#include "wire/health_check.h"

namespace eyrie::cli {
namespace {

constexpr std::string_view kHttp = "http://";

struct Options {
    std::vector<std::string> addresses;
    double limitSeconds = 2;
    bool quiet = false;
};

absl::Status checkOne(const std::string& address, std::chrono::milliseconds limit) {
    if (!address.starts_with(kHttp))
        return wire::checkHealth(address, limit);
    const std::string place = address.substr(kHttp.size());
    const std::size_t slash = std::min(place.find('/'), place.size());
    ASSIGN_OR_RETURN(const HostPort at, parseHostPort(place.substr(0, slash), "ADDRESS"));
    return http::probe(at.host, at.port, slash == place.size() ? "/healthz" : place.substr(slash),
                       limit);
}

absl::Status check(const Options& options) {
    const std::chrono::milliseconds limit(static_cast<int>(options.limitSeconds * 1000));
    for (const std::string& address : options.addresses) {
        RETURN_IF_ERROR(checkOne(address, limit));
        if (!options.quiet)
            fmt::print("{}: healthy\n", address);
    }
    return absl::OkStatus();
}

/// What this machine runs, of a coordinator or `eyrie serve` (the page's port) and a coordinator or
/// renderer (gRPC's): whatever is there is to be healthy, and one of the two is to be there.
absl::Status checkHere(Options options) {
    absl::Status missing;
    bool found = false;
    for (const char* const address : {"http://127.0.0.1:8080", "127.0.0.1:9090"}) {
        options.addresses = {address};
        const absl::Status status = check(options);
        if (!status.ok() && !absl::IsUnavailable(status))
            return status;
        found |= status.ok();
        missing.Update(status);
    }
    return found ? absl::OkStatus() : missing;
}

}  // namespace

void addHealth(CLI::App& app, Run& run) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("health", "Ask a coordinator or renderer whether it serves");
    command
        ->add_option("addresses", options->addresses,
                     "gRPC's, or of a page [whatever is at http://127.0.0.1:8080 and "
                     "127.0.0.1:9090, one at least]")
        ->type_name("HOST:PORT|unix:/PATH|http://HOST:PORT[/PATH]");
    command->add_option("--limit", options->limitSeconds, "How long to wait for each answer")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.001, 3600.0))
        ->capture_default_str();
    command->add_flag("--quiet", options->quiet, "Say nothing but what is wrong");
    command->footer(
        "Examples:\n"
        "  eyrie health viz:9090\n"
        "  eyrie health http://viz:8080/readyz\n"
        "Exit status 0: all of them serve.");
    command->callback([options, &run] {
        run = [options] {
            return options->addresses.empty() ? checkHere(*options) : check(*options);
        };
    });
}

}  // namespace eyrie::cli
