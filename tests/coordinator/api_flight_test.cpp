// SPDX-License-Identifier: Apache-2.0
// Flights, kept in the data folder by REST, and a folder that has gone or cannot be written.
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/coordinator/rest_fixture.h"
#include "tests/support/without_rights.h"

namespace eyrie::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(Rest, FlightsAreKept) {
    constexpr const char* kFlight =
        R"({"name":"round","keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
    const RestAnswer put = send("PUT", "/flights/a-b_1", kFlight);
    ASSERT_EQ(put.status, 200) << *put.body;
    const RestAnswer kept = get("/flights/a-b_1");
    ASSERT_EQ(kept.status, 200);
    EXPECT_EQ(*kept.body, *put.body);
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"a-b_1\""));
    makeApi(access::DataFolder::open(folder_.path("data")).value());
    EXPECT_EQ(*get("/flights/a-b_1").body, *put.body);
    EXPECT_EQ(send("DELETE", "/flights/a-b_1", "").status, 200);
    expectProblem(get("/flights/a-b_1"), 404, "NOT_FOUND");
    expectProblem(send("DELETE", "/flights/a-b_1", ""), 404, "NOT_FOUND");
}

TEST_F(Rest, ListsOfNumbersInAnswersAreOnOneLine) {
    ASSERT_EQ(
        send("PUT", "/flights/a", R"({"keys":[{"camera":{"eye":[0,-10.5,3],"target":[0,0,0]}}]})")
            .status,
        200);
    EXPECT_THAT(*get("/flights/a").body, HasSubstr("\n    \"eye\": [0, -10.5, 3],\n"));
}

TEST_F(Rest, AFlightThatManyWriteIsAlwaysOneOfTheirs) {
    const auto flight = [](int writer) {
        return fmt::format(
            R"({{"name":"{:0>2000}","keys":[{{"camera":{{"eye":[0,-10,3],"target":[0,0,0]}}}}]}})",
            writer);
    };
    ASSERT_EQ(send("PUT", "/flights/race", flight(0)).status, 200);
    std::vector<std::jthread> clients;
    for (int writer = 0; writer < 4; ++writer)
        clients.emplace_back([this, &flight, writer] {
            for (int i = 0; i < 25; ++i) {
                const RestAnswer put = send("PUT", "/flights/race", flight(writer));
                EXPECT_EQ(put.status, 200) << *put.body;
                const RestAnswer got = get("/flights/race");
                EXPECT_EQ(got.status, 200) << *got.body;
            }
        });
    clients.clear();
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"race\""));
    std::vector<std::string> left;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path("data/flights")))
        left.push_back(entry.path().filename().string());
    EXPECT_THAT(left, ElementsAre("race.json"));
}

TEST_F(Rest, ADataFolderThatHasGoneDoesNotLookEmpty) {
    constexpr const char* kFlight = R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    ASSERT_EQ(send("PUT", "/flights/a", kFlight).status, 200);
    std::filesystem::rename(folder_.path("data"), folder_.path("elsewhere"));
    for (const char* path : {"/flights", "/flights/a", "/reports/a.bench"}) {
        const RestAnswer answer = get(path);
        expectProblem(answer, 503, "UNAVAILABLE");
        EXPECT_THAT(text(answer, "remedy"), StartsWith("see that it is mounted")) << path;
    }
    expectProblem(send("PUT", "/flights/b", kFlight), 503, "UNAVAILABLE");
    expectProblem(send("DELETE", "/flights/a", ""), 503, "UNAVAILABLE");
    expectProblem(send("PUT", "/scene", R"({"objects":[{"terrain":"a.eyt"}]})"), 503,
                  "UNAVAILABLE");
    std::filesystem::rename(folder_.path("elsewhere"), folder_.path("data"));
    EXPECT_EQ(get("/flights/a").status, 200);
}

TEST_F(Rest, AFolderThatCannotBeWrittenIsNamedAsTheCause) {
    using std::filesystem::perms;
    constexpr perms kReadOnly = perms::owner_read | perms::owner_exec | perms::group_read |
                                perms::group_exec | perms::others_read | perms::others_exec;
    std::filesystem::permissions(folder_.path(), kReadOnly);
    std::filesystem::permissions(folder_.path("data"), kReadOnly);
    {
        const test::WithoutRights other;
        const RestAnswer put = send("PUT", "/flights/a",
                                    R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})");
        expectProblem(put, 503, "UNAVAILABLE");
        EXPECT_EQ(text(put, "remedy"), "see that the data folder is writable and not full");
        expectProblem(get("/flights/a"), 404, "NOT_FOUND");
        EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
    }
    std::filesystem::permissions(folder_.path(), perms::owner_all);
    std::filesystem::permissions(folder_.path("data"), perms::owner_all);
}

TEST_F(Rest, AFlightThatIsDamagedOnTheServerIsNotTheCallersFault) {
    std::filesystem::create_directory(folder_.path("data/flights"));
    std::ofstream(folder_.path("data/flights/a.json")) << R"({"keys":[{"cam)";
    expectProblem(get("/flights/a"), 500, "DATA_LOSS");
    std::filesystem::remove_all(folder_.path("data/flights"));
    std::ofstream(folder_.path("data/flights")) << "no folder";
    expectProblem(get("/flights"), 503, "UNAVAILABLE");
}

TEST_F(Rest, FlightsThatCannotBeFlownAreNotKept) {
    expectProblem(send("PUT", "/flights/a", R"({"keys":[]})"), 400, "INVALID_ARGUMENT");
    for (const char* name : {"..%2fa", "a%00", "a.b", "%", "a%2Fb"})
        EXPECT_EQ(send("PUT", "/flights/" + std::string(name),
                       R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})")
                          .status /
                      100,
                  4)
            << name;
    EXPECT_THAT(*get("/flights").body, HasSubstr("\"names\": []"));
}

TEST_F(Rest, FlightsAreNotKeptUnderTheNamesOfThoseThatAreBuiltIn) {
    constexpr const char* kFlight = R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";
    for (const char* name : {"orbit", "walkthrough", "worst"}) {
        const RestAnswer refused = send("PUT", fmt::format("/flights/{}", name), kFlight);
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), "name");
    }
    EXPECT_EQ(send("PUT", "/flights/orbits", kFlight).status, 200);
}

TEST_F(Rest, WithoutADataFolderNothingIsKept) {
    makeApi(std::nullopt);
    expectProblem(get("/flights"), 409, "FAILED_PRECONDITION");
    EXPECT_EQ(text(get("/flights"), "remedy"), "start it with --data DIR");
}

}  // namespace
}  // namespace eyrie::api
