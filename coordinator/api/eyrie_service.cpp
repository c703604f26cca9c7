// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/eyrie_service.h"

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

grpc::ServerUnaryReactor* EyrieService::call(const char* name,
                                             const google::protobuf::Message& request,
                                             google::protobuf::Message& answer) {
    auto* const reactor = new Reactor;
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
