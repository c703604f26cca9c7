// SPDX-License-Identifier: Apache-2.0
#include "cli/door_options.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "fabric/log.h"
#include "fabric/status.h"
#include "wire/local_address.h"

namespace eyrie::cli {
namespace {

/// The error that the command line is answered with, whatever it was for the file.
absl::Status ofOption(const absl::Status& status, std::string_view option) {
    return fabric::withContext(absl::InvalidArgumentError(status.message()), option);
}

absl::StatusOr<std::optional<access::TlsFiles>> tlsOf(const access::TlsFiles& files) {
    if (files == access::TlsFiles())
        return std::nullopt;
    if (files.certificate.empty() || files.key.empty())
        return absl::InvalidArgumentError(
            "--tls-cert and --tls-key go together, also with --tls-ca");
    if (absl::Status status = access::checkTlsFiles(files); !status.ok())
        return ofOption(status, "--tls-cert, --tls-key, --tls-ca");
    return files;
}

absl::Status refuse(std::string_view option, const std::string& listen, std::string_view remedy) {
    return absl::InvalidArgumentError(fmt::format(
        "{} {}: others than this machine reach that address; {}, or say --insecure if everybody "
        "who reaches it may use it",
        option, listen, remedy));
}

}  // namespace

void addDoorOptions(CLI::App& command, DoorOptions& options) {
    command
        .add_option("--token-file", options.tokenFile,
                    "Who may come in: a role (view, control or admin) and a token a line; for "
                    "nobody else to read. Read again when it changes")
        ->type_name("FILE");
    command
        .add_option("--tls-cert", options.tls.certificate,
                    "Encrypts: the certificate, in PEM form; read again when it changes")
        ->type_name("FILE");
    command.add_option("--tls-key", options.tls.key, "Its key")->type_name("FILE");
    command.add_flag("--insecure", options.insecure,
                     "Let in everybody who reaches an address, also from other machines");
}

void addPeerOptions(CLI::App& command, DoorOptions& options) {
    command
        .add_option("--tls-ca", options.tls.authority,
                    "Coordinator and renderers have to show each other certificates of this "
                    "authority")
        ->type_name("FILE");
    command
        .add_option("--tls-name", options.tlsName,
                    "Name that their certificates are for [the host that each is reached at]")
        ->type_name("NAME");
}

void addLocalNamesOption(CLI::App& command, DoorOptions& options) {
    command.add_flag("--local-names-only", options.localNamesOnly,
                     "Answer browsers that ask for an address or localhost, not for another name: "
                     "for a port that is published to one machine alone, as a container's");
}

CLI::Option* addReflectionOption(CLI::App& command, bool& reflection) {
    return command.add_flag("--grpc-reflection", reflection,
                            "Let gRPC tools ask which calls there are, without a token");
}

absl::StatusOr<Doors> doorsOf(const DoorOptions& options) {
    Doors doors;
    doors.insecure = options.insecure;
    doors.localNamesOnly = options.localNamesOnly;
    ASSIGN_OR_RETURN(doors.tls, tlsOf(options.tls));
    if (!options.tlsName.empty() && !doors.tls)
        return absl::InvalidArgumentError("--tls-name goes with --tls-cert and --tls-key");
    doors.security.tls = doors.tls;
    doors.security.peerName = options.tlsName;
    if (options.tokenFile.empty())
        return doors;
    absl::StatusOr<std::shared_ptr<access::TokenFile>> tokens =
        access::TokenFile::open(options.tokenFile);
    if (!tokens.ok())
        return ofOption(tokens.status(), "--token-file");
    doors.gate = std::make_shared<access::Gate>(*std::move(tokens));
    doors.security.gate = doors.gate;
    doors.security.token = [gate = doors.gate] { return gate->tokenOf(access::Role::Admin); };
    return doors;
}

absl::Status checkWebDoor(const Doors& doors, const std::string& listen, std::string_view option) {
    if (wire::isLocal(listen))
        return absl::OkStatus();
    if (doors.gate == nullptr && !doors.insecure)
        return refuse(option, listen, "give tokens with --token-file FILE");
    if (doors.gate == nullptr)
        spdlog::warn("{} {}: everybody who reaches this address may see and change all", option,
                     listen);
    else if (!doors.tls)
        spdlog::warn(
            "{} {}: tokens and pictures cross the network in the clear; encrypt with "
            "--tls-cert and --tls-key, or by a proxy on this machine",
            option, listen);
    return absl::OkStatus();
}

absl::Status checkGrpcDoor(const Doors& doors, const std::string& listen, std::string_view option) {
    if (doors.gate != nullptr && doors.gate->tokenOf(access::Role::Admin).empty())
        return absl::InvalidArgumentError(
            "--token-file: coordinator and renderers need a token of role admin in it");
    if (wire::isLocal(listen))
        return absl::OkStatus();
    const bool isMutual = doors.tls && !doors.tls->authority.empty();
    if (doors.gate == nullptr && !isMutual && !doors.insecure)
        return refuse(option, listen,
                      "give coordinator and renderers the same --token-file FILE, or certificates "
                      "of one authority with --tls-cert, --tls-key and --tls-ca");
    if (doors.gate == nullptr && !isMutual)
        spdlog::warn("{} {}: everybody who reaches this address may use it", option, listen);
    else if (!doors.tls)
        spdlog::warn(
            "{} {}: tokens and pictures cross the network in the clear; encrypt with "
            "--tls-cert, --tls-key and --tls-ca",
            option, listen);
    return absl::OkStatus();
}

}  // namespace eyrie::cli
