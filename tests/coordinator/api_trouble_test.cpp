// SPDX-License-Identifier: Apache-2.0
// What of calls that fail is counted and logged, whichever door they come by.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/coordinator/api_fixture.h"
#include "tests/service/eventually.h"
#include "tests/support/captured_log.h"

namespace eyrie::api {
namespace {

using testing::HasSubstr;

constexpr const char* kFlight = R"({"keys":[{"camera":{"eye":[0,-10,3],"target":[0,0,0]}}]})";

class ApiTrouble : public BothDoors {
protected:
    /// Of a counter, as /metrics says.
    int count(const std::string& series) const {
        const std::string text = telemetry_->metrics.text({}, {});
        const std::size_t at = text.find(series + " ");
        EXPECT_NE(at, std::string::npos) << series;
        return at == std::string::npos ? -1 : std::stoi(text.substr(at + series.size()));
    }
    int failed(const std::string& code) const {
        return count("eyrie_calls_failed_total{code=\"" + code + "\"}");
    }
};

TEST_F(ApiTrouble, OfTheServerIsToldOnceAndCountedEachTime) {
    makeApi();
    const test::CapturedLog log;
    std::filesystem::rename(data(), folder_.path("elsewhere"));
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(ask("GET", "/flights").status, 503);
        v1::ListFlightsRequest request;
        v1::ListFlightsResponse response;
        EXPECT_EQ(call([&](auto& context) {
                      return stub_->ListFlights(&context, request, &response);
                  }).error_code(),
                  grpc::StatusCode::UNAVAILABLE);
    }
    EXPECT_EQ(failed("UNAVAILABLE"), 6);
    EXPECT_EQ(log.lines(), 1) << log.text();
    EXPECT_THAT(log.text(), HasSubstr("ListFlights cannot be answered: the data folder cannot be"));
    EXPECT_EQ(ask("PUT", "/flights/a", kFlight).status, 503);
    EXPECT_EQ(log.lines(), 2) << log.text();
}

TEST_F(ApiTrouble, OfCallersIsToldToThemAndCounted) {
    makeApi();
    const test::CapturedLog log;
    EXPECT_EQ(ask("GET", "/image?strange=1").status, 400);
    EXPECT_EQ(ask("GET", "/statistics?strange=1").status, 400);
    EXPECT_EQ(ask("POST", "/image", R"({"width":"wide"})").status, 400);
    v1::GetTraceRequest request;
    request.set_frames(5000);
    v1::GetTraceResponse response;
    EXPECT_EQ(call([&](auto& context) {
                  return stub_->GetTrace(&context, request, &response);
              }).error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(failed("INVALID_ARGUMENT"), 4);
    EXPECT_EQ(ask("GET", "/flights/none").status, 404);
    EXPECT_EQ(failed("NOT_FOUND"), 1);
    EXPECT_EQ(log.lines(), 0) << log.text();
}

TEST_F(ApiTrouble, IsNotWhatADoorAsksByItself) {
    makeApi();
    RestRequest put{"PUT", "/api/v1/flights/new", kFlight, "application/json"};
    put.ifNoneMatch = "*";
    EXPECT_EQ(api_->rest().answer(put).status, 200);
    EXPECT_EQ(failed("NOT_FOUND"), 0);
}

TEST_F(ApiTrouble, OfOperationsIsToldAndCounted) {
    Programs programs;
    programs.importsAtOnce = 1;
    programs.run = [](const auto&, const auto&, const auto& heard, const auto&) {
        heard("eyrie: ./a.eyt: cannot be written: No space left on device");
        return ProgramEnd{false, 1, ""};
    };
    makeApi({}, programs);
    std::ofstream(data() / "a.tif") << "heights";
    const test::CapturedLog log;
    EXPECT_EQ(ask("POST", "/imports", R"({"sources":["a.tif"],"output":"a.eyt","requestId":"one"})")
                  .status,
              200);
    EXPECT_TRUE(eventually(
        [&] { return ask("GET", "/operations/one").body->find("FAILED") != std::string::npos; }));
    EXPECT_EQ(count(R"(eyrie_operations_total{result="failed"})"), 1);
    EXPECT_EQ(count(R"(eyrie_operations_total{result="done"})"), 0);
    EXPECT_EQ(log.lines(), 1) << log.text();
    EXPECT_THAT(log.text(), HasSubstr("operation one, of a.eyt, has failed: ./a.eyt: cannot be "
                                      "written: No space left on device"));
}

TEST_F(ApiTrouble, BeyondAQuotaIsToldOnceOfEach) {
    makeApi({.imagePixels = 100});
    const test::CapturedLog log;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(ask("GET", "/image?width=20&height=10").status, 400);
    EXPECT_EQ(refusals("image"), 3);
    EXPECT_EQ(log.lines(), 1) << log.text();
    EXPECT_THAT(log.text(), HasSubstr("is refused by the quota 'image': "));
}

}  // namespace
}  // namespace eyrie::api
