// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/coordinator_service.h"

#include <stop_token>

#include "coordinator/api/handlers.h"
#include "wire/status.h"

namespace eyrie::api {
namespace {

/// One call; ends itself.
class Reactor final : public grpc::ServerUnaryReactor {
public:
    std::stop_token stop() const { return stop_.get_token(); }

private:
    void OnCancel() override { stop_.request_stop(); }
    void OnDone() override { delete this; }

    std::stop_source stop_;
};

}  // namespace

access::Role roleFor(std::string_view call) {
    const auto isOne = [call](auto... names) { return ((call == names) || ...); };
    if (call.starts_with("Get") || call.starts_with("List") ||
        isOne("RenderImage", "PickPoint", "MeasureProfile"))
        return access::Role::View;
    if (isOne("SetScene", "ChangeConfiguration", "PutFlight", "DeleteFlight"))
        return access::Role::Control;
    return access::Role::Admin;
}

grpc::ServerUnaryReactor* CoordinatorService::call(const char* name,
                                                   const grpc::CallbackServerContext& context,
                                                   const google::protobuf::Message& request,
                                                   google::protobuf::Message& answer) {
    auto* const reactor = new Reactor;
    if (const absl::Status status = wire::admit(security_, context, roleFor(name)); !status.ok()) {
        reactor->Finish(wire::toGrpc(status));
        return reactor;
    }
    const Handlers* const handlers = handlers_;
    if (handlers == nullptr) {
        reactor->Finish(wire::toGrpc(absl::UnavailableError("the server is starting; try again")));
        return reactor;
    }
    const bool isTaken = workers_.post([=, &request, &answer] {
        reactor->Finish(wire::toGrpc(handlers->handle(name, request, answer, {reactor->stop()})));
    });
    if (!isTaken)
        reactor->Finish(
            wire::toGrpc(absl::ResourceExhaustedError("too many calls wait; try again in a bit")));
    return reactor;
}

}  // namespace eyrie::api
