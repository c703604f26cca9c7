// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "access/gate.h"
#include "access/tls_files.h"
#include "wire/security.h"

/// Who may come in where a process listens.
namespace eyrie::cli {

struct DoorOptions {
    std::string tokenFile;
    access::TlsFiles tls;
    std::string tlsName;  ///< of the other processes' certificates
    bool insecure = false;
    bool localNamesOnly = false;
};

/// --token-file, --tls-cert, --tls-key, --insecure.
void addDoorOptions(CLI::App& command, DoorOptions& options);

/// Between processes: --tls-ca, --tls-name.
void addPeerOptions(CLI::App& command, DoorOptions& options);

/// Of the door for browsers: --local-names-only.
void addLocalNamesOption(CLI::App& command, DoorOptions& options);

/// --grpc-reflection.
CLI::Option* addReflectionOption(CLI::App& command, bool& reflection);

/// What the options come to, read and checked.
struct Doors {
    std::shared_ptr<access::Gate> gate;   ///< null: no token file
    std::optional<access::TlsFiles> tls;  ///< nothing: not encrypted
    wire::Security security;              ///< of the gRPC door
    bool insecure = false;
    bool localNamesOnly = false;  ///< http::ServerOptions::localNamesOnly
};

/// Errors: InvalidArgument, naming the option.
absl::StatusOr<Doors> doorsOf(const DoorOptions& options);

/// Whether browsers may be let in at `listen` as the options have it: on an address that only this
/// machine reaches, with tokens, or with --insecure. Warns of what is sent in the clear.
/// InvalidArgument with the remedy.
absl::Status checkWebDoor(const Doors& doors, const std::string& listen, std::string_view option);

/// The same of a gRPC address, where certificates of an authority do, too.
absl::Status checkGrpcDoor(const Doors& doors, const std::string& listen, std::string_view option);

}  // namespace eyrie::cli
