// SPDX-License-Identifier: Apache-2.0
// What is asked for beyond the quotas: refused at once, by both doors, and counted.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/coordinator/api_fixture.h"

namespace eyrie::api {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;

class ApiQuotas : public BothDoors {
protected:
    /// 4xx, problem+json, and what it says.
    static void expectRefused(const RestAnswer& answer, int status, const std::string& detail) {
        EXPECT_EQ(answer.status, status) << *answer.body;
        EXPECT_EQ(answer.contentType, "application/problem+json");
        EXPECT_THAT(*answer.body, HasSubstr(detail));
    }

    grpc::Status render(int width, int height) {
        v1::RenderImageRequest request;
        v1::RenderImageResponse response;
        request.set_width(width);
        request.set_height(height);
        return call(
            [&](auto& context) { return stub_->RenderImage(&context, request, &response); });
    }

    static std::string scene(int objects) {
        std::string list;
        for (int i = 0; i < objects; ++i)
            list += fmt::format(R"({}{{"name":"{}","terrain":"a.eyt"}})", i == 0 ? "" : ",", i);
        return R"({"objects":[)" + list + "]}";
    }

    grpc::Status show(int objects) {
        v1::SetSceneRequest request;
        v1::SetSceneResponse response;
        EXPECT_TRUE(
            google::protobuf::util::JsonStringToMessage(scene(objects), request.mutable_scene())
                .ok());
        return call([&](auto& context) { return stub_->SetScene(&context, request, &response); });
    }
};

TEST_F(ApiQuotas, OfAPicturesPixels) {
    makeApi();
    const std::string largest = "/image?width=8192&height=8192";
    expectRefused(ask("GET", largest), 400, "at most 33554432 are drawn at once");
    expectRefused(ask("GET", "/image?width=8193&height=1"), 400, "from 1 to 8192");
    expectRefused(ask("POST", "/image",
                      R"({"width":16384,"height":16384,"part":{"width":8192,"height":8192}})"),
                  400, "at most 33554432");
    EXPECT_EQ(render(8192, 8192).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(render(1 << 30, 1 << 30).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(refusals("image"), 5);
    EXPECT_THAT(frames_.requests(), IsEmpty()) << "nothing was drawn";
    makeApi({.imagePixels = 200});
    EXPECT_EQ(ask("GET", "/image?width=20&height=10").status, 200);
    EXPECT_EQ(render(20, 10).error_code(), grpc::StatusCode::OK);
    expectRefused(ask("GET", "/image?width=67&height=3"), 400, "at most 200");
    EXPECT_EQ(render(67, 3).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(ApiQuotas, HaveNothingToDoWithMistakesInAPicturesSize) {
    makeApi();
    expectRefused(ask("GET", "/image?width=0"), 400, "width makes 0 pixels");
    expectRefused(ask("GET", "/image?height=-3"), 400, "height makes -3 pixels");
    expectRefused(ask("POST", "/image", R"({"part":{"x":9000,"width":8,"height":8}})"), 400,
                  "must lie in the picture");
    EXPECT_EQ(refusals("image"), 0);
}

TEST_F(ApiQuotas, OfThePixelsOfTwoEyesInOnePicture) {
    makeApi({.imagePixels = 200});
    const auto image = [&](const char* request) { return ask("POST", "/image", request); };
    expectRefused(image(R"({"width":101,"height":1,"shown":{"stereo":2}})"), 400, "makes 202x1");
    expectRefused(image(R"({"width":1,"height":101,"shown":{"stereo":3}})"), 400, "makes 1x202");
    expectRefused(image(R"({"width":4097,"height":1,"shown":{"stereo":2}})"), 400, "8194");
    expectRefused(image(R"({"width":2147483647,"height":1,"shown":{"stereo":2}})"), 400, "width");
    expectRefused(
        image(R"({"width":300,"height":9,"part":{"width":101,"height":1},"shown":{"stereo":2}})"),
        400, "part: height makes 202x1");
    EXPECT_THAT(frames_.requests(), IsEmpty()) << "nothing was drawn";
    EXPECT_EQ(image(R"({"width":100,"height":1,"shown":{"stereo":2}})").status, 200);
    EXPECT_EQ(image(R"({"width":200,"height":1,"shown":{"stereo":1}})").status, 200);
    EXPECT_EQ(image(R"({"width":200,"height":1,"shown":{"stereo":2,"eye":2}})").status, 200);
}

TEST_F(ApiQuotas, OfPixelsInTheMaking) {
    makeApi({.imagePixels = 200});
    frames_.hold(true);
    std::vector<std::jthread> two;
    for (int i = 0; i < 2; ++i)
        two.emplace_back(
            [this] { EXPECT_EQ(ask("GET", "/image?width=20&height=10").status, 200); });
    ASSERT_TRUE(frames_.waitForRequests(2));
    expectRefused(ask("GET", "/image?width=1&height=1"), 429, "too many large pictures");
    EXPECT_EQ(render(1, 1).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_EQ(refusals("image"), 2);
    frames_.hold(false);
}

TEST_F(ApiQuotas, OfPixelsUntilTheyHaveBeenSent) {
    makeApi({.imagePixels = 200});
    const std::string picture = "/image?width=20&height=10";
    RestAnswer one = ask("GET", picture);
    RestAnswer two = ask("GET", picture + "&format=IMAGE_FORMAT_RAW");
    ASSERT_EQ(two.status, 200);
    expectRefused(ask("GET", picture), 429, "being drawn or sent");
    one = {};
    RestAnswer text = ask("GET", picture, "", "application/json");
    EXPECT_EQ(text.status, 429) << "text takes more";
    two = {};
    text = ask("GET", picture, "", "application/json");
    EXPECT_EQ(text.status, 200) << *text.body;
    expectRefused(ask("GET", picture), 429, "being drawn or sent");
    text = {};
    EXPECT_EQ(ask("GET", picture).status, 200);
    EXPECT_EQ(render(20, 10).error_code(), grpc::StatusCode::OK);
}

TEST_F(ApiQuotas, OfPixelsInText) {
    makeApi();
    frames_.setDraw([](const coordinator::FrameRequest&) {
        coordinator::FrameRequest small;
        small.width = small.height = 2;
        return coordinator::plainFrame(small, {1, 2, 3, 255});
    });
    const std::string large = R"({"width":4096,"height":2049)";
    const std::string json = "application/json";
    expectRefused(ask("POST", "/image", large + "}", json), 400, "JSON has at most 8388608");
    expectRefused(ask("POST", "/image", large + R"(,"withDepth":true})", json), 400,
                  "for depths by IMAGE_FORMAT_DEPTH");
    expectRefused(ask("POST", "/image",
                      R"({"width":8192,"height":8192,"part":{"width":4096,"height":2049}})", json),
                  400, "part makes 4096x2049 pixels");
    expectRefused(
        ask("POST", "/image", R"({"width":4096,"height":1025,"shown":{"stereo":3}})", json), 400,
        "height makes 4096x2050 pixels");
    EXPECT_THAT(frames_.requests(), IsEmpty()) << "nothing was drawn";
    EXPECT_EQ(refusals("image"), 4);
    EXPECT_EQ(ask("POST", "/image", R"({"width":4096,"height":2048})", json).status, 200);
    EXPECT_EQ(ask("POST", "/image", large + "}").status, 200);
}

TEST_F(ApiQuotas, OfASceneByObjectsBytesAndTriangles) {
    std::ofstream(data() / "a.eyt") << std::string(1000, 'x');
    Programs programs;
    int runs = 0;
    programs.run = [&](const auto&, const auto&, const auto&, const auto&) {
        ++runs;
        return ProgramEnd{false, 0, R"({"kind":"terrain","triangles":50})"};
    };
    Quotas quotas{.sceneObjects = 3, .sceneBytes = 2000, .sceneTriangles = 100};
    makeApi(quotas, programs);
    EXPECT_EQ(ask("PUT", "/scene", scene(2)).status, 200);
    expectRefused(ask("PUT", "/scene", scene(4)), 400, "it must have 1 to 3");
    expectRefused(ask("PUT", "/scene", scene(3)), 400, "files of 3000 bytes; at most 2000");
    EXPECT_EQ(show(3).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(show(2).error_code(), grpc::StatusCode::OK);
    quotas.sceneBytes = 1 << 20;
    makeApi(quotas, programs);
    expectRefused(ask("PUT", "/scene", scene(3)), 400, "150 triangles; at most 100");
    EXPECT_EQ(show(3).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(ask("PUT", "/scene", scene(2)).status, 200);
    EXPECT_EQ(runs, 2) << "a file is looked into once for each server";
    EXPECT_EQ(refusals("scene"), 5);
    quotas.sceneTriangles = 0;
    makeApi(quotas, programs);
    EXPECT_EQ(ask("PUT", "/scene", scene(3)).status, 200);
    EXPECT_EQ(runs, 3) << "whether it can be opened, though its triangles do not count";
}

TEST_F(ApiQuotas, OfCallsASecondOfAnAddress) {
    makeApi({.callsPerSecond = 1});
    int refused = 0;
    for (int i = 0; i < 20; ++i)
        if (const auto answer = api_->rest().refusal("10.0.0.1")) {
            ++refused;
            expectRefused(*answer, 429, "more than 1 calls a second");
            EXPECT_THAT(answer->headers, testing::Contains(testing::Pair("Retry-After", "1")));
        }
    EXPECT_GE(refused, 10);
    EXPECT_FALSE(api_->rest().refusal("10.0.0.2")) << "others may go on";
    int over = 0;
    for (int i = 0; i < 20; ++i) {
        v1::GetStatusRequest request;
        v1::GetStatusResponse response;
        if (call([&](auto& context) {
                return stub_->GetStatus(&context, request, &response);
            }).error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED)
            ++over;
    }
    EXPECT_GE(over, 1);
    EXPECT_EQ(refusals("rate"), refused + over);
}

TEST_F(ApiQuotas, OfReadersOfStatistics) {
    makeApi({.readers = 1});
    const RestAnswer one = ask("GET", "/statistics");
    ASSERT_EQ(one.status, 200);
    expectRefused(ask("GET", "/statistics"), 429, "watch already");
    grpc::ClientContext context;
    const auto stream = stub_->WatchStatistics(&context, {});
    v1::WatchStatisticsResponse told;
    EXPECT_FALSE(stream->Read(&told));
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_EQ(refusals("readers"), 2);
}

TEST(CallRate, LetsAnAddressMakeSoManyCallsASecondAndAsManyAtOnce) {
    CallRate rate(4);
    const CallRate::Clock::time_point start{};
    const auto take = [&](int ms) { return rate.take("a", start + milliseconds(ms)).ok(); };
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(take(10'000)) << i;
    EXPECT_FALSE(take(10'000));
    EXPECT_FALSE(take(10'200));
    EXPECT_TRUE(take(10'250));
    EXPECT_FALSE(take(10'250)) << "those that were refused do not count";
    EXPECT_TRUE(rate.take("b", start + milliseconds(10'250)).ok());
    EXPECT_TRUE(take(20'000));
}

TEST(CallRate, OfNoneIsNoLimit) {
    CallRate rate(0);
    for (int i = 0; i < 10'000; ++i) ASSERT_TRUE(rate.take("a").ok());
}

TEST(CallRate, ForgetsAddressesThatAreSilent) {
    CallRate rate(1);
    const CallRate::Clock::time_point start{};
    for (int i = 0; i < 5'000; ++i)
        EXPECT_TRUE(rate.take(std::to_string(i), start + milliseconds(10'000 + 2 * i)).ok());
    EXPECT_FALSE(rate.take("4999", start + milliseconds(10'000 + 2 * 4999)).ok());
}

}  // namespace
}  // namespace eyrie::api
