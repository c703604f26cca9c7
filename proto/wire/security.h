// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <absl/status/status.h>

#include "access/gate.h"
#include "access/tls_files.h"

namespace grpc {
class CallbackServerContext;
class ChannelArguments;
class ChannelCredentials;
class ClientContext;
class ServerCredentials;
}  // namespace grpc

/// How Eyrie's processes know each other over gRPC.
namespace eyrie::wire {

/// What a process shows, and asks of others. Unix sockets need none of it: the folder that they are
/// in says who can reach them. Copies share the gate.
struct Security {
    /// Who may call; null: whoever reaches the address.
    std::shared_ptr<access::Gate> gate = {};
    /// What to send with a call, asked for each, as it may change; null, or empty: none.
    std::function<std::string()> token = {};
    /// With an authority both ends show certificates of it; without, servers alone do, and clients
    /// believe the system's authorities. A client may have no certificate to show. Files that
    /// change are used within seconds.
    std::optional<access::TlsFiles> tls = {};
    /// What the certificates of others are for, where that is not the host they are reached at.
    std::string peerName = {};
};

std::shared_ptr<grpc::ServerCredentials> serverCredentials(const Security& security,
                                                           const std::string& address);
std::shared_ptr<grpc::ChannelCredentials> channelCredentials(const Security& security,
                                                             const std::string& address);

/// clientArguments() of transport.h, and whom to expect.
grpc::ChannelArguments clientArguments(const Security& security);

/// Has a call bring the token.
void present(const Security& security, grpc::ClientContext& context);

/// Whether who calls has a token of role `needed`; renderers and coordinators have admin's. Errors:
/// those of Gate::admit.
absl::Status admit(const Security& security, const grpc::CallbackServerContext& context,
                   access::Role needed = access::Role::Admin);

/// The role of a call that admit() let in.
access::Role roleOf(const Security& security, const grpc::CallbackServerContext& context);

/// "10.0.0.7" of gRPC's "ipv4:10.0.0.7:41234"; the peer as it is where it has another form.
std::string peerAddress(const std::string& peer);

}  // namespace eyrie::wire
