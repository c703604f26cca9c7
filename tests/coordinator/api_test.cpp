// SPDX-License-Identifier: Apache-2.0
// CoordinatorService without the network: what REST requests become, and what comes back.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <gtest/gtest.h>

#include "coordinator/api/openapi.h"
#include "coordinator/api/rest_routes.h"
#include "tests/coordinator/rest_fixture.h"

namespace eyrie::api {
namespace {

using google::protobuf::Value;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST_F(Rest, TellsWhatThereIs) {
    const RestAnswer answer = get("/status");
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.contentType, "application/json");
    EXPECT_TRUE(member(json(answer), "ready").bool_value());
    EXPECT_THAT(*answer.body, HasSubstr("\"renderer-1\""));

    coordinator::Status status = coordinator::readyStatus();
    status.problem = "no renderer";
    frames_.setStatus(status);
    EXPECT_FALSE(member(json(get("/status")), "ready").bool_value());
}

TEST_F(Rest, AnswersThatHaveNotChangedAreNotSentAgain) {
    const std::string tag = header(get("/status"), "ETag");
    ASSERT_FALSE(tag.empty());
    RestRequest again{"GET", "/status"};
    again.ifNoneMatch = tag;
    EXPECT_EQ(ask(again).status, 304);
    EXPECT_TRUE(ask(again).body->empty());
    EXPECT_EQ(header(ask(again), "ETag"), tag);
    again.ifNoneMatch = "W/" + tag;
    EXPECT_EQ(ask(again).status, 304);
    coordinator::Status status = coordinator::readyStatus();
    status.problem = "other";
    frames_.setStatus(status);
    EXPECT_EQ(ask(again).status, 200);
}

TEST_F(Rest, SaysWhichFieldIsWrongAndWhatToDo) {
    const RestAnswer tau = send("POST", "/image", R"({"tauPixels":0})");
    expectProblem(tau, 400, "INVALID_ARGUMENT");
    EXPECT_EQ(text(tau, "field"), "tauPixels");
    EXPECT_THAT(text(tau, "detail"), StartsWith("tau_pixels is 0;"));
    EXPECT_THAT(text(send("POST", "/image", R"({"shading":99})"), "detail"),
                StartsWith("shading is 99,"));
    const RestAnswer width = send("POST", "/image", R"({"width":8193})");
    expectProblem(width, 400, "INVALID_ARGUMENT");
    EXPECT_EQ(text(width, "field"), "width");
    EXPECT_EQ(text(width, "remedy"), "it must be from 1 to 8192");
    expectProblem(send("POST", "/image", R"({"width":8192,"height":8192})"), 400,
                  "INVALID_ARGUMENT");
    const RestAnswer eye = send("POST", "/image", R"({"camera":{"eye":[0,0]}})");
    expectProblem(eye, 400, "INVALID_ARGUMENT");
    EXPECT_EQ(text(eye, "field"), "camera.eye");
    EXPECT_THAT(text(eye, "detail"), StartsWith("camera.eye has 2 numbers"));
    expectProblem(send("POST", "/image", R"({"format":99})"), 400, "INVALID_ARGUMENT");
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, NamesTheFieldThatIsOfAnotherKindOrNotThere) {
    const auto expectField = [&](const RestAnswer& refused, const std::string& field) {
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field) << *refused.body;
        EXPECT_THAT(text(refused, "remedy"), StartsWith("see /api")) << *refused.body;
    };
    expectField(send("POST", "/image", R"({"width":"wide"})"), "width");
    expectField(send("POST", "/image", R"({"withDepth":3})"), "withDepth");
    expectField(send("POST", "/image", R"({"camera":{"eye":[1,"x",2]}})"), "camera.eye[1]");
    expectField(send("POST", "/image", R"({"witdh":20})"), "witdh");
    expectField(send("POST", "/image", R"({"camera":{"eyes":1}})"), "camera.eyes");
    expectField(get("/image?witdh=20"), "witdh");
    expectField(send("PUT", "/scene", R"({"objects":[{"terrain":"a.eyt","x":1}]})"),
                "scene.objects[0].x");
    const RestAnswer neither = send("POST", "/image", R"({"a b":1})");
    expectProblem(neither, 400, "INVALID_ARGUMENT");
    EXPECT_FALSE(json(neither).struct_value().fields().contains("field"));
}

TEST_F(Rest, RefusesWhatItDoesNotKnow) {
    expectProblem(send("POST", "/image", R"({"witdh":20})"), 400, "INVALID_ARGUMENT");
    expectProblem(send("POST", "/image", "{"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?witdh=20"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=a"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=20&width=30"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?width=%2"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/image?camera=1"), 400, "INVALID_ARGUMENT");
    expectProblem(get("/nothing"), 404, "NOT_FOUND");
    expectProblem(get("/status/more"), 404, "NOT_FOUND");
    expectProblem(get("/operations/one/more"), 404, "NOT_FOUND");
    const RestAnswer cancel = get("/operations/one/cancel");
    expectProblem(cancel, 405, "UNIMPLEMENTED");
    EXPECT_EQ(header(cancel, "Allow"), "POST");
    expectProblem(ask({"GET", "/status", "{}", "application/json"}), 400, "INVALID_ARGUMENT");
    const RestAnswer method = send("DELETE", "/image", "");
    expectProblem(method, 405, "UNIMPLEMENTED");
    EXPECT_EQ(header(method, "Allow"), "POST, GET");
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, RefusesAFieldThatIsGivenTwiceAndDiffers) {
    const auto expectRefused = [&](const RestAnswer& refused, const std::string& field) {
        expectProblem(refused, 400, "INVALID_ARGUMENT");
        EXPECT_EQ(text(refused, "field"), field);
        EXPECT_EQ(text(refused, "remedy"), "give it once");
    };
    expectRefused(send("POST", "/image?width=64", R"({"width":32})"), "width");
    expectRefused(get("/image?jpegQuality=5&jpeg_quality=6"), "jpegQuality");
    expectRefused(send("PATCH", "/sessions/a?id=b", R"({"tauPixels":2})"), "id");
    expectRefused(send("POST", "/operations/a/cancel", R"({"id":"b"})"), "id");
    EXPECT_THAT(frames_.requests(), IsEmpty());
    EXPECT_EQ(send("POST", "/image?width=64", R"({"width":64})").status, 200);
}

TEST_F(Rest, RefusesPathsAndQueriesThatAreNotUtf8AndLogsNothingOfThem) {
    testing::internal::CaptureStderr();
    for (const char* target : {"/flights/%ff%fe", "/image?width=%c0%80"}) {
        const RestAnswer answer = get(target);
        expectProblem(answer, 400, "INVALID_ARGUMENT");
        EXPECT_THAT(text(answer, "detail"), HasSubstr("which is not UTF-8")) << target;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Rest, TakesNoFormsOfOtherSitesPages) {
    for (const char* type :
         {"text/plain", "", "application/json-seq", "text/plain;application/json"})
        expectProblem(ask({"POST", "/image", R"({"width":20})", type}), 400, "INVALID_ARGUMENT");
    EXPECT_THAT(frames_.requests(), IsEmpty());
}

TEST_F(Rest, TakesJsonHoweverItsTypeIsWritten) {
    for (const char* type :
         {"application/json", "Application/JSON", "application/json ;charset=UTF-8"})
        EXPECT_EQ(ask({"POST", "/image", R"({"width":20})", type}).status, 200) << type;
}

TEST_F(Rest, ThePageFindsItsStyleBelowAnyPathOfAProxy) {
    const auto has = [&](std::string path) { return *api_->rest().answer({"GET", path}).body; };
    EXPECT_THAT(has("/api"), HasSubstr("href=\"api/style.css\""));
    EXPECT_THAT(has("/api/"), HasSubstr("href=\"style.css\""));
    EXPECT_THAT(has("/api"), Not(HasSubstr("href=\"/")));
}

TEST_F(Rest, ThePageAndTheDocumentHaveEveryCall) {
    const RestAnswer page = api_->rest().answer({"GET", "/api"});
    EXPECT_EQ(page.contentType, "text/html; charset=utf-8");
    EXPECT_EQ(api_->rest().answer({"GET", "/api/style.css"}).status, 200);
    EXPECT_EQ(api_->rest().answer({"GET", "/api/else"}).status, 404);
    const Value document = json(get("/openapi.json"));
    EXPECT_EQ(member(document, "openapi").string_value(), "3.1.0");
    for (const Route& route : restRoutes()) {
        EXPECT_THAT(*page.body, HasSubstr("id=\"" + route.call->name() + "\""));
        const Value path = member(member(document, "paths"), route.rest.path());
        std::string method = route.rest.method();
        std::ranges::transform(method, method.begin(),
                               [](char c) { return static_cast<char>(c - 'A' + 'a'); });
        EXPECT_TRUE(path.struct_value().fields().contains(method)) << route.rest.path();
    }
}

TEST_F(Rest, ThePageSaysWhichFieldIsTheWholeBodyOrAnswer) {
    const std::string page = *api_->rest().answer({"GET", "/api"}).body;
    const auto sectionOf = [&](const std::string& call) {
        const std::size_t from = page.find("<h2 id=\"" + call + "\"");
        return page.substr(from, page.find("<h2", from + 1) - from);
    };
    for (const Route& route : restRoutes()) {
        const std::string section = sectionOf(route.call->name());
        for (const auto& [what, field] : {std::pair("the body", route.rest.body()),
                                          std::pair("the answer", route.rest.answer())})
            EXPECT_THAT(
                section,
                HasSubstr(field.empty() ? "" : fmt::format("{} is <code>{}</code>", what, field)));
    }
    EXPECT_THAT(sectionOf("GetStatus"), Not(HasSubstr("By HTTP")));
}

TEST_F(Rest, ThePageHasAPlaceForEachErrorThatNamesOne) {
    const std::string page = *api_->rest().answer({"GET", "/api"}).body;
    for (const auto code : {absl::StatusCode::kAborted, absl::StatusCode::kAlreadyExists,
                            absl::StatusCode::kCancelled, absl::StatusCode::kFailedPrecondition,
                            absl::StatusCode::kInvalidArgument, absl::StatusCode::kNotFound,
                            absl::StatusCode::kOutOfRange, absl::StatusCode::kUnknown})
        EXPECT_THAT(page, HasSubstr("<tr id=\"" + absl::StatusCodeToString(code) + "\">"));
    EXPECT_THAT(page, HasSubstr("<code>UNIMPLEMENTED</code><td>501; 405 of"));
    EXPECT_THAT(page, HasSubstr("<code>RESOURCE_EXHAUSTED</code><td>429; 413 of"));
}

TEST_F(Rest, ThePageAsksForPicturesAndNotForJsonOfThem) {
    const std::string page = *api_->rest().answer({"GET", "/api"}).body;
    const std::size_t from = page.find("curl -o picture.png -X POST");
    ASSERT_NE(from, std::string::npos);
    EXPECT_THAT(page.substr(from, page.find('\n', from) - from),
                HasSubstr("--header 'Accept: image/png'"));
}

TEST_F(Rest, TheDocumentTellsOfTokensAndHeaders) {
    const Value document = json(get("/openapi.json"));
    const Value token = member(member(member(document, "components"), "securitySchemes"), "token");
    EXPECT_EQ(member(token, "scheme").string_value(), "bearer");
    const Value uses = member(document, "security").list_value().values(0);
    EXPECT_TRUE(uses.struct_value().fields().contains("token"));
    const auto operation = [&](const std::string& path, const std::string& method) {
        return member(member(member(document, "paths"), path), method);
    };
    const auto parameters = [&](const std::string& path, const std::string& method) {
        std::vector<std::string> names;
        const Value all = member(operation(path, method), "parameters");
        for (const Value& parameter : all.list_value().values())
            if (member(parameter, "in").string_value() == "header")
                names.push_back(member(parameter, "name").string_value());
        return names;
    };
    EXPECT_THAT(parameters("/scene", "get"), ElementsAre("If-None-Match"));
    EXPECT_THAT(parameters("/flights/{name}", "put"), ElementsAre("If-Match", "If-None-Match"));
    EXPECT_THAT(parameters("/configuration", "patch"), ElementsAre("If-Match"));
    EXPECT_THAT(parameters("/imports", "post"), ElementsAre("Idempotency-Key"));
    const Value responses = member(operation("/image", "post"), "responses");
    const Value headers = member(member(responses, "200"), "headers");
    EXPECT_TRUE(headers.struct_value().fields().contains("Eyrie-Tau-Achieved"));
    EXPECT_TRUE(headers.struct_value().fields().contains("Eyrie-Complete"));
    EXPECT_TRUE(member(member(responses, "default"), "headers")
                    .struct_value()
                    .fields()
                    .contains("Retry-After"));
    const Value unchanged = member(member(operation("/scene", "get"), "responses"), "304");
    EXPECT_TRUE(member(unchanged, "headers").struct_value().fields().contains("ETag"));
    EXPECT_THAT(member(operation("/scene", "put"), "description").string_value(),
                HasSubstr("For tokens of role control."));
    EXPECT_THAT(*api_->rest().answer({"GET", "/api"}).body,
                HasSubstr("Authorization: Bearer TOKEN"));
}

TEST(OpenApi, LeavesNothingUndocumented) { EXPECT_THAT(undocumented(), IsEmpty()); }

TEST(OpenApi, RefersOnlyToWhatItHas) {
    const std::string& document = openApiJson();
    constexpr std::string_view kRef = "\"$ref\":\"#/components/schemas/";
    int found = 0;
    for (std::size_t at = document.find(kRef); at != std::string::npos;
         at = document.find(kRef, at + 1)) {
        const std::size_t from = at + kRef.size();
        const std::string name = document.substr(from, document.find('"', from) - from);
        EXPECT_THAT(document, HasSubstr("\"" + name + "\":{\"type\":")) << name;
        ++found;
    }
    EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace eyrie::api
