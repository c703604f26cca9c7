// SPDX-License-Identifier: Apache-2.0
#include "service/peers.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include "eyrie/v1/render_service.grpc.pb.h"
#include "wire/deadline.h"
#include "wire/picture_header.h"
#include "wire/status.h"
#include "wire/transport.h"

namespace eyrie::service {

struct Peers::Connection {
    Connection(std::string to, const wire::Security& security)
        : address(std::move(to)),
          stub(v1::RenderService::NewStub(
              grpc::CreateCustomChannel(address, wire::channelCredentials(security, address),
                                        wire::clientArguments(security)))) {}

    const std::string address;
    const std::unique_ptr<v1::RenderService::Stub> stub;
};

namespace {

/// Stops early where the peer has ended the call; Finish then says why.
void write(grpc::ClientWriter<v1::PutFrameRequest>& writer, const std::string& address,
           const FrameKey& key, const fabric::Image& image) {
    const wire::PixelEncoding encoding = wire::encodingFor(address, image.hasDepth());
    v1::PutFrameRequest message;
    v1::FrameHeader& header = *message.mutable_header();
    header.set_session(key.session);
    header.set_frame_number(key.frameNumber);
    header.set_frame(key.frame);
    header.set_to(address);
    wire::describe(image, encoding, header);
    bool goesOn = writer.Write(message);
    for (wire::PictureWriter pixels(image, encoding); goesOn && !pixels.isDone();) {
        pixels.next(*message.mutable_chunk());
        goesOn = writer.Write(message);
    }
    if (goesOn)
        writer.WritesDone();
}

}  // namespace

Peers::Peers(wire::Security security) : security_(std::move(security)) {}
Peers::~Peers() = default;

absl::Status Peers::send(const std::string& address, const FrameKey& key,
                         const fabric::Image& image, Clock::time_point deadline,
                         const std::stop_token& stop) {
    const std::shared_ptr<Connection> connection = connectionTo(address);
    grpc::ClientContext context;
    wire::present(security_, context);
    context.set_deadline(wire::deadlineIn(deadline - Clock::now()));
    const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
    v1::PutFrameResponse response;
    const auto writer = connection->stub->PutFrame(&context, &response);
    write(*writer, address, key, image);
    return wire::fromGrpc(writer->Finish(), fmt::format("renderer at {}", address));
}

std::shared_ptr<Peers::Connection> Peers::connectionTo(const std::string& address) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(
        connections_.begin(), connections_.end(),
        [&](const std::shared_ptr<Connection>& known) { return known->address == address; });
    if (found != connections_.end()) {
        connections_.splice(connections_.begin(), connections_, found);
        return connections_.front();
    }
    connections_.push_front(std::make_shared<Connection>(address, security_));
    if (connections_.size() > kMaxConnections)
        connections_.pop_back();
    return connections_.front();
}

}  // namespace eyrie::service
