// SPDX-License-Identifier: Apache-2.0
// What programs change of the scene and the configuration by REST.
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <gtest/gtest.h>

#include "coordinator/frame/active_configuration.h"
#include "tests/coordinator/rest_fixture.h"

namespace eyrie::api {
namespace {

using google::protobuf::Value;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(Rest, ConfigurationsChangeWhollyOrNotAtAll) {
    const RestAnswer before = get("/configuration");
    ASSERT_EQ(before.status, 200) << *before.body;
    EXPECT_THAT(*before.body, HasSubstr("\"compounds\""));

    const RestAnswer switched =
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"OFF"}]})");
    if (switched.status != 200)  // not all canvases can show nothing
        expectProblem(switched, 404, "NOT_FOUND");
    const std::string now = *get("/configuration").body;
    expectProblem(send("PATCH", "/configuration",
                       R"({"layouts":[{"canvas":"0","layout":"1"}],)"
                       R"("equalizers":[{"equalizer":999}]})"),
                  404, "NOT_FOUND");
    EXPECT_EQ(*get("/configuration").body, now);
    expectProblem(send("PATCH", "/configuration", R"({"heads":[{"roomFromHead":[1]}]})"), 400,
                  "INVALID_ARGUMENT");

    const RestAnswer layout =
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"1"}]})");
    ASSERT_EQ(layout.status, 200) << *layout.body;
    EXPECT_NE(*get("/configuration").body, now);
}

/// The one on show may be there in the place of another, for want of renderers.
TEST_F(Rest, ALayoutIsChosenThoughItIsOnShow) {
    const auto choices = [this] {
        std::uint64_t count = 0;
        EXPECT_TRUE(configuration_
                        .withConfiguration([&](coordinator::ActiveConfiguration& active) {
                            count = active.layoutChoices();
                            return absl::OkStatus();
                        })
                        .ok());
        return count;
    };
    const std::string change = R"({"layouts":[{"canvas":"0","layout":"1"}]})";
    for (std::uint64_t i = 1; i <= 2; ++i) {
        ASSERT_EQ(send("PATCH", "/configuration", change).status, 200);
        EXPECT_EQ(choices(), i);
    }
    ASSERT_EQ(send("PATCH", "/configuration", "{}").status, 200);
    EXPECT_EQ(choices(), 2U);
}

TEST_F(Rest, AWallBehindAnEyeIsRefusedAndNothingOfTheChangeIsDone) {
    const std::string before = *get("/configuration").body;
    expectProblem(
        send("PATCH", "/configuration",
             R"({"layouts":[{"canvas":"0","layout":"1"}],"views":[{"layout":"0","view":"0",)"
             R"("wall":{"bottomLeft":[-1,-1,1],"bottomRight":[1,-1,1],"topLeft":[-1,1,1]}}]})"),
        400, "INVALID_ARGUMENT");
    EXPECT_EQ(*get("/configuration").body, before);
}

/// So that a change that is held to what somebody has seen is not refused for each frame since.
TEST_F(Rest, ConfigurationsHaveWhatFramesChangeOnlyWhereItIsAskedFor) {
    const std::string tag = header(get("/configuration"), "ETag");
    ASSERT_TRUE(configuration_
                    .withConfiguration([](coordinator::ActiveConfiguration& active) {
                        const compound::Plan plan = active.plan({}, 1, {}).value();
                        std::vector<coordinator::ActiveConfiguration::Taken> taken;
                        for (const compound::PlannedDraw& draw : plan.draws) {
                            auto& one = taken.emplace_back();
                            one.covered = draw.task.pixelViewport;
                            one.milliseconds = one.stages.total =
                                static_cast<double>(10 * taken.size());
                        }
                        active.record(0, plan, 1, taken);
                        return absl::OkStatus();
                    })
                    .ok());
    EXPECT_EQ(header(get("/configuration"), "ETag"), tag);
    EXPECT_THAT(*get("/configuration").body, testing::Not(HasSubstr("imbalance")));
    EXPECT_THAT(*get("/configuration?measured=true").body, HasSubstr("imbalance"));
}

TEST_F(Rest, EqualizersAreFrozenAndSwitchedOff) {
    const RestAnswer answer =
        send("PATCH", "/configuration", R"({"equalizers":[{"equalizer":0,"frozen":true}]})");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    const Value now = json(get("/configuration"));
    const Value first = member(now, "equalizers").list_value().values(0);
    EXPECT_TRUE(member(first, "frozen").bool_value());
    EXPECT_TRUE(member(first, "on").bool_value());
}

TEST_F(Rest, ScenesThatWereAnsweredCanBeShownAgain) {
    const fabric::Scene shown = frames_.status().scene;
    api_->begin(shown, shown);
    std::ofstream(folder_.path("data/other.eyt")) << "x";
    const RestAnswer scene = get("/scene");
    ASSERT_EQ(scene.status, 200);
    EXPECT_EQ(send("PUT", "/scene", *scene.body).status, 200);

    const RestAnswer other = send("PUT", "/scene", R"({"objects":[{"terrain":"other.eyt"}]})");
    ASSERT_EQ(other.status, 200) << *other.body;
    EXPECT_EQ(frames_.status().scene.objects[0].path,
              std::filesystem::canonical(folder_.path("data/other.eyt")).string());
    EXPECT_THAT(*other.body, HasSubstr("\"other.eyt\""));
    EXPECT_EQ(send("PUT", "/scene", *scene.body).status, 200);
}

TEST_F(Rest, AddressesInScenesAreWholeForThoseAloneWhoMayShowThemAgain) {
    const std::string address = "https://joe:sekret@host/a.eyt?sig=S";
    fabric::Scene scene;
    scene.objects.push_back({"a", fabric::ObjectKind::Terrain, address});
    api_->begin(scene, scene);
    const auto asked = [&](const std::string& method, access::Role role) {
        RestRequest request{method, "/scene"};
        request.role = role;
        return ask(request);
    };
    EXPECT_THAT(*asked("GET", access::Role::View).body, HasSubstr("\"https://…@host/a.eyt?…\""));
    const RestAnswer whole = asked("GET", access::Role::Control);
    EXPECT_THAT(*whole.body, HasSubstr(address));
    EXPECT_THAT(*asked("GET", access::Role::Admin).body, HasSubstr(address));

    RestRequest again{"PUT", "/scene", *whole.body, "application/json"};
    again.role = access::Role::Control;
    again.ifMatch = header(whole, "ETag");
    const RestAnswer shown = ask(again);
    ASSERT_EQ(shown.status, 200) << *shown.body;
    EXPECT_THAT(*shown.body, HasSubstr(address));
    EXPECT_EQ(header(shown, "ETag"), again.ifMatch);

    again.body = R"({"objects":[{"terrain":")" + address + R"("}]})";
    ASSERT_EQ(ask(again).status, 200);
    EXPECT_EQ(frames_.status().scene.objects[0].name, "a.eyt?…") << "all see it";
}

TEST_F(Rest, ScenesNameNothingOutsideTheDataFolder) {
    std::ofstream(folder_.path("secret.eyt")) << "x";
    std::ofstream(folder_.path("data/source.tif")) << "x";
    std::filesystem::create_symlink(folder_.path("secret.eyt"), folder_.path("data/link.eyt"));
    for (const std::string name : {"../secret.eyt", "link.eyt", "none.eyt", "source.tif", "", "/",
                                   "a/../../secret.eyt", "https://host/a.eyt"}) {
        const RestAnswer answer =
            send("PUT", "/scene", R"({"objects":[{"terrain":")" + name + "\"}]}");
        EXPECT_GE(answer.status, 400) << name;
        EXPECT_LT(answer.status, 500) << name;
    }
    const RestAnswer whole =
        send("PUT", "/scene", R"({"objects":[{"terrain":")" + folder_.path("secret.eyt") + "\"}]}");
    EXPECT_EQ(whole.status, 400);
    expectProblem(send("PUT", "/scene", "{}"), 400, "INVALID_ARGUMENT");
    EXPECT_EQ(frames_.status().scene, coordinator::readyStatus().scene);
}

TEST_F(Rest, ScenesAreToldWhichOfTheirFieldsIsWrong) {
    std::ofstream(folder_.path("data/a.eyt")) << "x";
    for (const auto& [more, field] :
         {std::pair(R"("transform":{"scale":0}}])", "scene.objects[0].transform.scale"),
          std::pair(R"("colour":[1,2]}])", "scene.objects[0].colour"),
          std::pair(R"(}],"pointLights":[{"colour":[1,1,-1],"position":[0,0,0],"reach":1}])",
                    "scene.pointLights[0].colour[2]"),
          std::pair(R"(}],"ambient":2)", "scene.ambient")}) {
        const std::string separator = more[0] == '}' ? "" : ",";
        const RestAnswer refused =
            send("PUT", "/scene", R"({"objects":[{"terrain":"a.eyt")" + separator + more + "}");
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field) << *refused.body;
    }
}

TEST_F(Rest, ChangesAreMadeToWhatTheyWereMeantForOrNotAtAll) {
    const auto flight = [](const std::string& name) {
        return R"({"name":")" + name +
               R"(","keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    };
    const auto put = [&](const std::string& name, const std::string& ifMatch,
                         const std::string& ifNoneMatch = "") {
        RestRequest request{"PUT", "/flights/a", flight(name), "application/json"};
        request.ifMatch = ifMatch;
        request.ifNoneMatch = ifNoneMatch;
        return ask(request);
    };
    EXPECT_EQ(put("none", "*").status, 412);
    EXPECT_EQ(put("none", "\"0123456789abcdef\"").status, 412);
    const RestAnswer first = put("first", "", "*");
    ASSERT_EQ(first.status, 200) << *first.body;
    const std::string tag = header(first, "ETag");
    EXPECT_EQ(tag, header(get("/flights/a"), "ETag"));
    expectProblem(put("again", "", "*"), 412, "FAILED_PRECONDITION");
    EXPECT_EQ(put("second", "\"0123456789abcdef\", " + tag).status, 200);
    const RestAnswer stale = put("third", tag);
    expectProblem(stale, 412, "FAILED_PRECONDITION");
    EXPECT_THAT(text(stale, "remedy"), StartsWith("ask for it again"));
    EXPECT_THAT(*get("/flights/a").body, HasSubstr("second"));
    const std::string now = header(get("/flights/a"), "ETag");
    EXPECT_EQ(put("weak", "W/" + now).status, 412);
    EXPECT_EQ(put("fourth", "W/" + now + ", " + now).status, 200) << "the strong one counts";
    EXPECT_EQ(put("fifth", "", "W/" + header(get("/flights/a"), "ETag")).status, 412)
        << "the weak one counts where there is to be none such";
    RestRequest remove{"DELETE", "/flights/a"};
    remove.ifMatch = tag;
    EXPECT_EQ(ask(remove).status, 412);
    remove.ifMatch = "*";
    EXPECT_EQ(ask(remove).status, 200);
}

TEST_F(Rest, WhatIsThereAndCannotBeReadIsNotTakenForNothing) {
    std::filesystem::create_directory(folder_.path("data/flights"));
    std::ofstream(folder_.path("data/flights/a.json")) << "damaged";
    RestRequest request{"PUT", "/flights/a",
                        R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})",
                        "application/json"};
    request.ifNoneMatch = "*";
    expectProblem(ask(request), 500, "DATA_LOSS");
    EXPECT_EQ(std::filesystem::file_size(folder_.path("data/flights/a.json")), 7U);
    request.ifNoneMatch = "";
    EXPECT_EQ(ask(request).status, 200);
}

TEST_F(Rest, OfManyChangesOfTheSameOnlyOneIsMade) {
    ASSERT_EQ(
        send("PATCH", "/configuration", R"({"layouts":[{"canvas":"0","layout":"1"}]})").status,
        200);
    const std::string tag = header(get("/configuration"), "ETag");
    std::atomic<int> made{0};
    std::vector<std::jthread> clients;
    for (int i = 0; i < 4; ++i)
        clients.emplace_back([&, i] {
            RestRequest change{"PATCH", "/configuration",
                               fmt::format(R"({{"layouts":[{{"canvas":"0","layout":"{}"}}]}})",
                                           i % 2 == 0 ? 0 : 2),
                               "application/json"};
            change.ifMatch = tag;
            const RestAnswer answer = ask(change);
            EXPECT_TRUE(answer.status == 200 || answer.status == 412) << *answer.body;
            EXPECT_TRUE(answer.status == 412 || header(answer, "ETag") != tag);
            made += answer.status == 200;
        });
    clients.clear();
    EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace eyrie::api
