// SPDX-License-Identifier: Apache-2.0
#include "wire/listen.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/impl/server_builder_plugin.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include "fabric/status.h"
#include "wire/grpc_runtime.h"
#include "wire/handshake_log.h"

namespace eyrie::wire {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr std::size_t kMaxUnixPathBytes = 107;  // sockaddr_un
constexpr std::size_t kMaxAddressBytes = 300;

absl::Status invalid(const std::string& address, std::string_view why) {
    return absl::InvalidArgumentError(
        fmt::format("address '{}' {}; it must be HOST:PORT or unix:/PATH",
                    address.substr(0, kMaxAddressBytes), why));
}

absl::Status checkUnixPath(const std::string& address) {
    const std::size_t size = address.size() - kUnix.size();
    if (size == 0)
        return invalid(address, "has no path");
    if (size > kMaxUnixPathBytes)
        return invalid(address, fmt::format("has a path of {} bytes, where the system allows {}",
                                            size, kMaxUnixPathBytes));
    return absl::OkStatus();
}

/// "host:0" listens on a port of the system's choice; a socket file has none to report.
std::string withPort(const std::string& address, int port) {
    if (address.starts_with(kUnix))
        return address;
    return fmt::format("{}:{}", address.substr(0, address.rfind(':')), port);
}

std::string notBound(const std::vector<std::string>& addresses, const std::vector<int>& ports) {
    for (std::size_t i = 0; i < addresses.size(); ++i)
        if (ports[i] == 0)
            return addresses[i];
    return fmt::format("{}", fmt::join(addresses, ", "));
}

/// A program that gRPC's reflection is linked to has it in every server, asked for or not.
class WithoutReflection final : public grpc::ServerBuilderOption {
public:
    void UpdateArguments(grpc::ChannelArguments* /*arguments*/) override {}
    void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
        std::erase_if(*plugins, [](const auto& plugin) {
            return plugin->name() == "proto_server_reflection";
        });
    }
};

}  // namespace

absl::Status checkAddress(const std::string& address) {
    if (address.size() > kMaxAddressBytes)
        return invalid(address, fmt::format("has {} bytes", address.size()));
    if (address.starts_with(kUnix))
        return checkUnixPath(address);
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos || colon == 0)
        return invalid(address, "lacks a host or a port");
    int port = -1;
    const char* end = address.data() + address.size();
    const auto [stop, error] = std::from_chars(address.data() + colon + 1, end, port);
    if (error != std::errc() || stop != end || port < 0 || port > 65535)
        return invalid(address, "has no port from 0 to 65535");
    return absl::OkStatus();
}

absl::StatusOr<Listening> listen(const std::vector<std::string>& addresses, grpc::Service& service,
                                 const Security& security) {
    return listen(addresses, std::vector<grpc::Service*>{&service}, security);
}

absl::StatusOr<Listening> listen(const std::vector<std::string>& addresses,
                                 const std::vector<grpc::Service*>& services,
                                 const Security& security, int mostSentBytes, bool withReflection) {
    grpc::ServerBuilder builder;
    configureServer(builder);
    builder.SetMaxSendMessageSize(mostSentBytes);
    if (!withReflection)
        builder.SetOption(std::make_unique<WithoutReflection>());
    for (grpc::Service* service : services) builder.RegisterService(service);
    std::vector<int> ports(addresses.size(), 0);
    for (std::size_t i = 0; i < addresses.size(); ++i) {
        RETURN_IF_ERROR(checkAddress(addresses[i]));
        builder.AddListeningPort(addresses[i], serverCredentials(security, addresses[i]),
                                 &ports[i]);
    }
    Listening listening{builder.BuildAndStart(), {}};
    if (listening.server == nullptr)
        return absl::UnavailableError(
            fmt::format("cannot listen on {}: it is in use, not an address of this machine, or not "
                        "permitted; choose another",
                        notBound(addresses, ports)));
    for (std::size_t i = 0; i < addresses.size(); ++i) {
        listening.addresses.push_back(withPort(addresses[i], ports[i]));
        if (security.tls && !addresses[i].starts_with(kUnix))
            handshakeLog().watch(ports[i]);
    }
    return listening;
}

}  // namespace eyrie::wire
