// SPDX-License-Identifier: Apache-2.0
#include "wire/security.h"

#include <string_view>

#include <fmt/format.h>
#include <grpc/grpc_security_constants.h>
#include <grpcpp/client_context.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/channel_arguments.h>

#include "wire/grpc_runtime.h"
#include "wire/transport.h"

namespace eyrie::wire {
namespace {

namespace tls = grpc::experimental;

constexpr unsigned kReloadSeconds = 1;
constexpr char kAuthorization[] = "authorization";

bool isUnix(std::string_view address) { return address.starts_with("unix:"); }

bool isForAnybody(const Security& security, std::string_view peer) {
    return security.gate == nullptr || isUnix(peer);
}

access::Credentials credentialsOf(const grpc::CallbackServerContext& context) {
    const auto found = context.client_metadata().find(kAuthorization);
    const std::string_view authorization =
        found == context.client_metadata().end()
            ? std::string_view()
            : std::string_view(found->second.data(), found->second.size());
    return {authorization, {}, access::Door::Grpc};
}

std::shared_ptr<tls::FileWatcherCertificateProvider> watch(const access::TlsFiles& files) {
    return std::make_shared<tls::FileWatcherCertificateProvider>(files.key, files.certificate,
                                                                 files.authority, kReloadSeconds);
}

}  // namespace

std::shared_ptr<grpc::ServerCredentials> serverCredentials(const Security& security,
                                                           const std::string& address) {
    startGrpc();
    if (!security.tls || isUnix(address))
        return grpc::InsecureServerCredentials();
    tls::TlsServerCredentialsOptions options(watch(*security.tls));
    options.watch_identity_key_cert_pairs();
    if (security.tls->authority.empty()) {
        options.set_cert_request_type(GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
    } else {
        options.watch_root_certs();
        options.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
    }
    return tls::TlsServerCredentials(options);
}

std::shared_ptr<grpc::ChannelCredentials> channelCredentials(const Security& security,
                                                             const std::string& address) {
    startGrpc();
    if (!security.tls || isUnix(address))
        return grpc::InsecureChannelCredentials();
    tls::TlsChannelCredentialsOptions options;
    if (*security.tls != access::TlsFiles())
        options.set_certificate_provider(watch(*security.tls));
    if (!security.tls->certificate.empty())
        options.watch_identity_key_cert_pairs();
    if (!security.tls->authority.empty())
        options.watch_root_certs();
    return tls::TlsCredentials(options);
}

grpc::ChannelArguments clientArguments(const Security& security) {
    grpc::ChannelArguments arguments = clientArguments();
    if (security.tls && !security.peerName.empty())
        arguments.SetSslTargetNameOverride(security.peerName);
    return arguments;
}

void present(const Security& security, grpc::ClientContext& context) {
    const std::string token = security.token ? security.token() : std::string();
    if (!token.empty())
        context.AddMetadata(kAuthorization, fmt::format("Bearer {}", token));
}

absl::Status admit(const Security& security, const grpc::CallbackServerContext& context,
                   access::Role needed) {
    const std::string peer = context.peer();
    if (isForAnybody(security, peer))
        return absl::OkStatus();
    return security.gate->admit(credentialsOf(context), peerAddress(peer), needed).status();
}

access::Role roleOf(const Security& security, const grpc::CallbackServerContext& context) {
    if (isForAnybody(security, context.peer()))
        return access::Role::Admin;
    return security.gate->roleOf(credentialsOf(context)).value_or(access::Role::View);
}

std::string peerAddress(const std::string& peer) {
    constexpr std::string_view kIpv4 = "ipv4:";
    constexpr std::string_view kIpv6 = "ipv6:%5B";  // gRPC escapes the brackets
    std::string_view text = peer;
    if (text.starts_with(kIpv4)) {
        text.remove_prefix(kIpv4.size());
        return std::string(text.substr(0, text.find(':')));
    }
    if (text.starts_with(kIpv6)) {
        text.remove_prefix(kIpv6.size());
        return std::string(text.substr(0, text.find("%5D")));
    }
    return peer;
}

}  // namespace eyrie::wire
