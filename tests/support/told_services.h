// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>

namespace eyrie::test {

/// What a tool is told that asks for the list of services, and how that ends. Written by hand, as
/// grpc.reflection.v1alpha has it: Debian has no header of it.
inline std::pair<grpc::StatusCode, std::string> servicesToldAt(const std::string& address) {
    grpc::GenericStub stub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    grpc::CompletionQueue queue;
    void* tag = nullptr;
    bool isDone = false;
    const auto await = [&] { return queue.Next(&tag, &isDone) && isDone; };
    const auto call = stub.PrepareCall(
        &context, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", &queue);
    call->StartCall(nullptr);
    await();
    const grpc::Slice listServices(std::string("\x3a\x00", 2));  // field 7, ""
    call->WriteLast(grpc::ByteBuffer(&listServices, 1), grpc::WriteOptions(), nullptr);
    await();
    grpc::ByteBuffer answer;
    call->Read(&answer, nullptr);
    std::string told;
    std::vector<grpc::Slice> slices;
    if (await() && answer.Dump(&slices).ok())
        for (const grpc::Slice& slice : slices)
            told.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    grpc::Status status;
    call->Finish(&status, nullptr);
    await();
    return {status.error_code(), told};
}

}  // namespace eyrie::test
