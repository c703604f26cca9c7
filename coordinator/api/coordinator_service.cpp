// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/coordinator_service.h"

#include <memory>
#include <stop_token>

#include "coordinator/api/call_roles.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/stream_reactor.h"
#include "fabric/status.h"
#include "wire/status.h"

namespace eyrie::api {
namespace {

/// One call; ends itself.
class Reactor final : public grpc::ServerUnaryReactor {
public:
    Reactor(grpc::CallbackServerContext& context, std::chrono::milliseconds patience)
        : limit_(context, patience) {}

    /// What its handler is given beside the request.
    Call call(access::Role role) { return {stop_.get_token(), role, false, &room_}; }

    /// `answer` is empty where `status` is an error.
    void finish(const absl::Status& status, const google::protobuf::Message& answer) {
        limit_.sends(answer.ByteSizeLong());
        Finish(wire::toGrpc(status));
    }

private:
    void OnCancel() override { stop_.request_stop(); }
    void OnDone() override { delete this; }

    wire::AnswerLimit limit_;
    std::stop_source stop_;
    std::shared_ptr<void> room_;  ///< until the answer has been sent
};

}  // namespace

absl::Status CoordinatorService::admit(const char* name,
                                       const grpc::CallbackServerContext& context) const {
    RETURN_IF_ERROR(wire::admit(security_, context, roleFor(name)));
    if (isDraining_)
        return absl::UnavailableError("this server is stopping; ask again in a bit");
    const Handlers* const handlers = handlers_;
    if (handlers == nullptr)
        return absl::UnavailableError("the server is starting; try again");
    return handlers->admit(wire::peerAddress(context.peer()));
}

grpc::ServerWriteReactor<v1::WatchStatisticsResponse>* CoordinatorService::WatchStatistics(
    grpc::CallbackServerContext* context, const v1::WatchStatisticsRequest* request) {
    auto* const reactor = new StreamReactor<v1::WatchStatisticsResponse>(*context, patience_);
    if (const absl::Status status = admit("WatchStatistics", *context); !status.ok()) {
        reactor->begin(status);
    } else {
        const Handlers& handlers = *handlers_.load();
        absl::StatusOr<std::unique_ptr<MessageStream>> stream =
            handlers.open("WatchStatistics", *request);
        handlers.note("WatchStatistics", stream.status());
        reactor->begin(std::move(stream));
    }
    return reactor;
}

grpc::ServerUnaryReactor* CoordinatorService::call(const char* name,
                                                   grpc::CallbackServerContext& context,
                                                   const google::protobuf::Message& request,
                                                   google::protobuf::Message& answer) {
    auto* const reactor = new Reactor(context, patience_);
    if (const absl::Status status = admit(name, context); !status.ok()) {
        reactor->finish(status, answer);
        return reactor;
    }
    const access::Role role = wire::roleOf(security_, context);
    const bool isTaken = workers_.post([=, handlers = handlers_.load(), &request, &answer] {
        const absl::Status status = handlers->handle(name, request, answer, reactor->call(role));
        handlers->note(name, status);
        reactor->finish(status, answer);
    });
    if (isTaken)
        return reactor;
    const absl::Status busy =
        absl::ResourceExhaustedError("too many calls wait; try again in a bit");
    handlers_.load()->note(name, busy);
    reactor->finish(busy, answer);
    return reactor;
}

}  // namespace eyrie::api
