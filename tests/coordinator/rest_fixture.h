// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "coordinator/api/api.h"
#include "coordinator/config/default_config.h"
#include "coordinator/frame/active_configuration.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::api {

/// The configuration of two renderers.
class FakeConfiguration : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>& use) override {
        return use(active_);
    }

private:
    coordinator::ActiveConfiguration active_{config::defaultConfiguration(
        std::vector<config::RendererFacts>{{"a", "", "fake"}, {"b", "", "fake"}})};
};

/// CoordinatorService without the network, with a data folder.
class Rest : public testing::Test {
protected:
    Rest() {
        std::filesystem::create_directory(folder_.path("data"));
        makeApi(access::DataFolder::open(folder_.path("data")).value());
    }

    void makeApi(std::optional<access::DataFolder> data) {
        api_ = std::make_unique<Api>(ApiParts{frames_, configuration_,
                                              [this](fabric::Scene scene) {
                                                  coordinator::Status status = frames_.status();
                                                  status.scene = std::move(scene);
                                                  frames_.setStatus(status);
                                              },
                                              std::move(data)});
    }

    RestAnswer ask(RestRequest request) const {
        request.target = "/api/v1" + request.target;
        return api_->rest().answer(request);
    }
    RestAnswer get(const std::string& target, const std::string& accept = "") const {
        return ask({"GET", target, "", "", accept});
    }
    RestAnswer send(const std::string& method, const std::string& target, const std::string& body,
                    const std::string& accept = "") const {
        return ask({method, target, body, "application/json", accept});
    }

    static google::protobuf::Value json(const RestAnswer& answer) {
        google::protobuf::Value value;
        EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(*answer.body, &value).ok())
            << *answer.body;
        return value;
    }
    static google::protobuf::Value member(const google::protobuf::Value& value,
                                          const std::string& name) {
        const auto& fields = value.struct_value().fields();
        EXPECT_TRUE(fields.contains(name)) << name;
        return fields.contains(name) ? fields.at(name) : google::protobuf::Value();
    }
    static std::string text(const RestAnswer& answer, const std::string& name) {
        return member(json(answer), name).string_value();
    }
    static std::string header(const RestAnswer& answer, const std::string& name) {
        for (const auto& [key, value] : answer.headers)
            if (key == name)
                return value;
        return "";
    }
    static void expectProblem(const RestAnswer& answer, int status, const std::string& code) {
        EXPECT_EQ(answer.status, status) << *answer.body;
        EXPECT_EQ(answer.contentType, "application/problem+json");
        EXPECT_EQ(text(answer, "code"), code);
        EXPECT_EQ(member(json(answer), "status").number_value(), status);
    }

    test::TemporaryFolder folder_;
    coordinator::FakeFrameSource frames_;
    FakeConfiguration configuration_;
    std::unique_ptr<Api> api_;
};

}  // namespace eyrie::api
