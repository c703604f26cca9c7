// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>
#include <fmt/format.h>

#include "access/tls_files.h"
#include "cli/commands.h"
#include "cli/values.h"
#include "coordinator/http/probe.h"
#include "fabric/status.h"
#include "wire/health_check.h"
#include "wire/security.h"

namespace eyrie::cli {
namespace {

constexpr std::string_view kHttp = "http://";
constexpr std::string_view kHttps = "https://";

struct Options {
    std::vector<std::string> addresses;
    access::TlsFiles tls;
    std::string tlsName;
    double limitSeconds = 2;
    bool quiet = false;
};

/// Whether who is asked without a scheme, or here, encrypts.
bool isEncrypted(const Options& options) { return options.tls != access::TlsFiles(); }

absl::Status checkTls(const Options& options) {
    if (options.tls.certificate.empty() != options.tls.key.empty())
        return absl::InvalidArgumentError("--tls-cert and --tls-key go together");
    const absl::Status files = access::checkTlsFiles(options.tls);
    return files.ok() ? files : absl::InvalidArgumentError(files.message());
}

absl::StatusOr<http::Probed> parseUrl(const std::string& url) {
    http::Probed probed;
    probed.isEncrypted = url.starts_with(kHttps);
    const std::string place = url.substr((probed.isEncrypted ? kHttps : kHttp).size());
    const std::size_t slash = std::min(place.find('/'), place.size());
    ASSIGN_OR_RETURN(const HostPort at, parseHostPort(place.substr(0, slash), "ADDRESS"));
    probed.host = at.host;
    probed.port = at.port;
    if (slash < place.size())
        probed.path = place.substr(slash);
    return probed;
}

absl::Status checkLimit(const Options& options) {
    if (std::isnan(options.limitSeconds))  // which passes every check of a range
        return absl::InvalidArgumentError("--limit is not a number; give seconds, such as 2");
    return absl::OkStatus();
}

absl::Status checkOne(const std::string& address, const Options& options) {
    const std::chrono::milliseconds limit(static_cast<int>(options.limitSeconds * 1000));
    if (address.starts_with(kHttp) || address.starts_with(kHttps)) {
        ASSIGN_OR_RETURN(const http::Probed probed, parseUrl(address));
        return http::probe(probed, limit, {options.tls.authority, options.tlsName});
    }
    wire::Security security;
    if (isEncrypted(options))
        security.tls = options.tls;
    security.peerName = options.tlsName;
    return wire::checkHealth(address, limit, security);
}

absl::Status check(const Options& options) {
    for (const std::string& address : options.addresses) {
        RETURN_IF_ERROR(checkOne(address, options));
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
    const std::string page =
        isEncrypted(options) ? "https://127.0.0.1:8080" : "http://127.0.0.1:8080";
    for (const std::string& address : {page, std::string("127.0.0.1:9090")}) {
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
                     "gRPC's, or of a page [whatever is at http://127.0.0.1:8080, with --tls-... "
                     "https://, and 127.0.0.1:9090, one at least]")
        ->type_name("HOST:PORT|unix:/PATH|http[s]://HOST:PORT[/PATH]");
    command
        ->add_option("--tls-ca", options->tls.authority,
                     "Believe certificates of this authority [those the system knows]; gRPC's "
                     "addresses are asked by TLS when this or --tls-cert is there")
        ->type_name("FILE");
    command
        ->add_option("--tls-cert", options->tls.certificate,
                     "Certificate to show to a coordinator or renderer that wants one")
        ->type_name("FILE");
    command->add_option("--tls-key", options->tls.key, "Its key")->type_name("FILE");
    command
        ->add_option("--tls-name", options->tlsName,
                     "Name that their certificates are for [the host of each address]")
        ->type_name("NAME");
    command->add_option("--limit", options->limitSeconds, "How long to wait for each answer")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.001, 3600.0))
        ->capture_default_str();
    command->add_flag("--quiet", options->quiet, "Say nothing but what is wrong");
    command->footer(
        "Examples:\n"
        "  eyrie health viz:9090\n"
        "  eyrie health http://viz:8080/readyz\n"
        "  eyrie health https://127.0.0.1:8080 --tls-ca ca.crt --tls-name viz\n"
        "Exit status 0: all of them serve.");
    command->callback([options, &run] {
        run = [options]() -> absl::Status {
            RETURN_IF_ERROR(checkLimit(*options));
            RETURN_IF_ERROR(checkTls(*options));
            return options->addresses.empty() ? checkHere(*options) : check(*options);
        };
    });
}

}  // namespace eyrie::cli
