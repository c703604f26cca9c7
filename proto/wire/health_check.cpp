// SPDX-License-Identifier: Apache-2.0
#include "wire/health_check.h"

#include <future>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/byte_buffer.h>

#include "fabric/status.h"
#include "wire/listen.h"
#include "wire/status.h"

namespace eyrie::wire {
namespace {

/// grpc.health.v1.HealthCheckResponse with nothing but `status = SERVING`: field 1, a varint, 1.
/// The message is not worth a schema of our own, and gRPC's is not installed with it.
constexpr char kServing[] = {0x08, 0x01};

std::string textOf(const grpc::ByteBuffer& buffer) {
    grpc::Slice bytes;
    if (!buffer.DumpToSingleSlice(&bytes).ok())
        return {};
    return {reinterpret_cast<const char*>(bytes.begin()), bytes.size()};
}

}  // namespace

absl::Status checkHealth(const std::string& address, std::chrono::milliseconds limit,
                         const Security& security) {
    RETURN_IF_ERROR(checkAddress(address));
    grpc::GenericStub stub(grpc::CreateCustomChannel(address, channelCredentials(security, address),
                                                     clientArguments(security)));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + limit);
    const grpc::Slice nothing;  // an empty request asks for the whole server
    const grpc::ByteBuffer request(&nothing, 1);
    grpc::ByteBuffer response;
    std::promise<grpc::Status> done;
    stub.UnaryCall(&context, "/grpc.health.v1.Health/Check", grpc::StubOptions(), &request,
                   &response, [&done](const grpc::Status& status) { done.set_value(status); });
    RETURN_IF_ERROR(fromGrpc(done.get_future().get(), address));
    if (textOf(response) != std::string(kServing, sizeof kServing))
        return absl::FailedPreconditionError(fmt::format("{}: it does not serve now", address));
    return absl::OkStatus();
}

}  // namespace eyrie::wire
