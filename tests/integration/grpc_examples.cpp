// SPDX-License-Identifier: Apache-2.0
#include "tests/integration/grpc_examples.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>

#include "coordinator/api/operations.h"
#include "coordinator/api/rest_request.h"
#include "coordinator/api/rest_routes.h"
#include "eyrie/v1/coordinator_service.grpc.pb.h"
#include "fabric/status.h"
#include "wire/status.h"

namespace eyrie::test {
namespace {

using api::Route;
using google::protobuf::Message;
using google::protobuf::MessageFactory;

constexpr std::chrono::seconds kPatience{120};

std::unique_ptr<Message> newMessage(const google::protobuf::Descriptor* type) {
    return std::unique_ptr<Message>(MessageFactory::generated_factory()->GetPrototype(type)->New());
}

std::chrono::system_clock::time_point deadline() {
    return std::chrono::system_clock::now() + kPatience;
}

/// What is read or removed has been put before.
std::size_t turnOf(const Route& route) {
    constexpr std::array<std::string_view, 5> kOrder = {"PUT", "POST", "PATCH", "GET", "DELETE"};
    return static_cast<std::size_t>(std::ranges::find(kOrder, route.rest.method()) -
                                    kOrder.begin());
}

/// Of each call the way by HTTP that is the one to use.
std::vector<Route> firstWays() {
    std::vector<Route> ways;
    for (const Route& route : api::restRoutes())
        if (ways.empty() || ways.back().call != route.call)
            ways.push_back(route);
    std::ranges::stable_sort(ways, {}, turnOf);
    return ways;
}

class Caller {
public:
    explicit Caller(const std::string& address)
        : address_(address),
          channel_(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())),
          stub_(v1::CoordinatorService::NewStub(channel_)),
          anyStub_(channel_) {}

    absl::Status make(const Route& route) {
        const std::unique_ptr<Message> request = newMessage(route.call->input_type());
        RETURN_IF_ERROR(fill(route.rest, *request));
        return route.call->server_streaming()
                   ? firstOf(static_cast<const v1::WatchStatisticsRequest&>(*request))
                   : unary(*route.call, *request);
    }

    /// Their ends.
    void awaitOperations() {
        const auto end = std::chrono::steady_clock::now() + kPatience;
        while (std::chrono::steady_clock::now() < end && areRunning())
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }

    /// Until renderers have open what was put.
    void awaitScene() {
        const auto end = std::chrono::steady_clock::now() + kPatience;
        while (std::chrono::steady_clock::now() < end && !isReady())
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }

private:
    absl::Status fill(const v1::Rest& rest, Message& request) {
        const bool isQuery = rest.method() == "GET" || rest.method() == "DELETE";
        if (isQuery)
            RETURN_IF_ERROR(api::setFromQuery(rest.example(), request));
        else if (!rest.example().empty())
            RETURN_IF_ERROR(api::setFromBody(rest.example(), rest.body(), request));
        else if (auto* const scene = dynamic_cast<v1::SetSceneRequest*>(&request))
            RETURN_IF_ERROR(takeScene(*scene));
        const std::size_t begin = rest.path().find('{');
        if (begin == std::string::npos)
            return absl::OkStatus();
        const std::string name = rest.path().substr(begin + 1, rest.path().find('}') - begin - 1);
        return api::setField(name, rest.example_name(), request);
    }

    absl::Status takeScene(v1::SetSceneRequest& request) {
        grpc::ClientContext context;
        v1::GetSceneResponse answer;
        context.set_deadline(deadline());
        const grpc::Status status = stub_->GetScene(&context, {}, &answer);
        *request.mutable_scene() = answer.scene();
        return wire::fromGrpc(status, address_);
    }

    absl::Status unary(const google::protobuf::MethodDescriptor& call, const Message& request) {
        grpc::ClientContext context;
        context.set_deadline(deadline());
        const std::unique_ptr<Message> answer = newMessage(call.output_type());
        std::promise<grpc::Status> status;
        anyStub_.UnaryCall(&context, "/" + call.service()->full_name() + "/" + call.name(), {},
                           &request, answer.get(),
                           [&](const grpc::Status& end) { status.set_value(end); });
        return wire::fromGrpc(status.get_future().get(), address_);
    }

    absl::Status firstOf(const v1::WatchStatisticsRequest& request) {
        grpc::ClientContext context;
        context.set_deadline(deadline());
        const auto messages = stub_->WatchStatistics(&context, request);
        v1::WatchStatisticsResponse message;
        if (!messages->Read(&message))
            return wire::fromGrpc(messages->Finish(), address_);
        context.TryCancel();
        (void)messages->Finish();
        return absl::OkStatus();
    }

    bool areRunning() {
        grpc::ClientContext context;
        v1::ListOperationsResponse answer;
        context.set_deadline(deadline());
        return stub_->ListOperations(&context, {}, &answer).ok() &&
               !std::ranges::all_of(answer.operations(), [](const v1::Operation& operation) {
                   return api::hasEnded(operation.state());
               });
    }

    bool isReady() {
        grpc::ClientContext context;
        v1::GetStatusResponse answer;
        context.set_deadline(deadline());
        return stub_->GetStatus(&context, {}, &answer).ok() && answer.ready();
    }

    const std::string address_;
    const std::shared_ptr<grpc::Channel> channel_;
    const std::unique_ptr<v1::CoordinatorService::Stub> stub_;
    grpc::TemplatedGenericStub<Message, Message> anyStub_;
};

}  // namespace

std::map<std::string, absl::Status> makeExamples(const std::string& address) {
    Caller caller(address);
    std::map<std::string, absl::Status> made;
    std::string before;
    for (const Route& route : firstWays()) {
        if (before == "PUT" && route.rest.method() != before)
            caller.awaitScene();
        if (before == "POST" && route.rest.method() != before)
            caller.awaitOperations();
        before = route.rest.method();
        made[route.call->name()] = caller.make(route);
    }
    return made;
}

}  // namespace eyrie::test
