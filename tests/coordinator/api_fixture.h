// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/server.h>
#include <gtest/gtest.h>

#include "coordinator/api/api.h"
#include "coordinator/api/coordinator_service.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/temporary_folder.h"
#include "wire/listen.h"

namespace eyrie::api {

class NoConfigurationAtAll : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>&) override {
        return absl::FailedPreconditionError("there is none");
    }
};

/// An API, asked over REST and gRPC.
class BothDoors : public testing::Test {
protected:
    BothDoors() { std::filesystem::create_directory(data()); }
    ~BothDoors() override { closeGrpc(); }

    std::filesystem::path data() const { return folder_.path("data"); }

    void makeApi(const Quotas& quotas = {}, const Programs& programs = {}) {
        closeGrpc();
        api_ = std::make_unique<Api>(ApiParts{frames_, configuration_,
                                              [this](fabric::Scene scene) {
                                                  coordinator::Status status = frames_.status();
                                                  status.scene = std::move(scene);
                                                  frames_.setStatus(status);
                                              },
                                              access::DataFolder::open(data()).value(), programs,
                                              quotas, telemetry_});
        service_ = std::make_unique<CoordinatorService>(wire::Security(), patience_);
        service_->use(api_->handlers());
        const std::string address = "unix:" + folder_.path("s");
        listening_ = wire::listen({address}, std::vector<grpc::Service*>{service_.get()}).value();
        stub_ = v1::CoordinatorService::NewStub(
            grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
    }

    void closeGrpc() {
        if (service_ == nullptr)
            return;
        listening_.server->Shutdown();
        service_->stop();
        service_.reset();
    }

    RestAnswer ask(const std::string& method, const std::string& target,
                   const std::string& body = "", const std::string& accept = "") const {
        return api_->rest().answer(
            {method, "/api/v1" + target, body, body.empty() ? "" : "application/json", accept});
    }

    /// The answer's body as that message.
    template <typename Message>
    static Message parsed(const RestAnswer& answer) {
        Message message;
        EXPECT_EQ(answer.status, 200) << *answer.body;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(*answer.body, &message).ok())
            << *answer.body;
        return message;
    }

    /// How often a quota was reached, as /metrics says.
    int refusals(const std::string& quota) const {
        const std::string text = telemetry_->metrics.text({}, {});
        const std::string series = "eyrie_over_quota_total{quota=\"" + quota + "\"} ";
        const std::size_t at = text.find(series);
        EXPECT_NE(at, std::string::npos) << quota;
        return at == std::string::npos ? -1 : std::stoi(text.substr(at + series.size()));
    }

    /// A call over gRPC.
    template <typename Call>
    static grpc::Status call(const Call& make) {
        grpc::ClientContext context;
        context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
        return make(context);
    }

    test::TemporaryFolder folder_;
    coordinator::FakeFrameSource frames_;
    NoConfigurationAtAll configuration_;
    observe::SharedTelemetry telemetry_ = std::make_shared<observe::Telemetry>();
    std::chrono::milliseconds patience_ = wire::AnswerLimit::kPatience;  ///< of the next API
    std::unique_ptr<Api> api_;
    std::unique_ptr<CoordinatorService> service_;
    wire::Listening listening_;
    std::unique_ptr<v1::CoordinatorService::Stub> stub_;
};

}  // namespace eyrie::api
