// SPDX-License-Identifier: Apache-2.0
// Sessions and statistics, by both doors.
#include <future>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "coordinator/api/call_roles.h"
#include "coordinator/api/message_stream.h"
#include "coordinator/stream/session_book.h"
#include "tests/coordinator/api_fixture.h"
#include "tests/coordinator/viewer_browser.h"
#include "tests/service/eventually.h"

namespace eyrie::api {
namespace {

using stream::Browser;
using testing::HasSubstr;
using testing::StartsWith;

class ApiSessions : public BothDoors {
protected:
    ApiSessions() { makeApi(); }
};

TEST_F(ApiSessions, AreListedWithTheirViewersAndWhatTheySee) {
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    EXPECT_EQ(parsed<v1::ListSessionsResponse>(ask("GET", "/sessions")).sessions_size(), 0);
    Browser leader(sessions, {"tour"});
    leader.look(3);
    ASSERT_TRUE(leader.nextFrame());
    const auto list = parsed<v1::ListSessionsResponse>(ask("GET", "/sessions"));
    ASSERT_EQ(list.sessions_size(), 1);
    const v1::Session& told = list.sessions(0);
    EXPECT_EQ(told.id(), "tour");
    EXPECT_GT(told.created_unix_milliseconds(), 1'000'000'000'000);
    ASSERT_EQ(told.viewers_size(), 1);
    EXPECT_TRUE(told.viewers(0).leads());
    EXPECT_TRUE(told.viewers(0).may_control());
    EXPECT_EQ(told.viewers(0).codec(), v1::PICTURE_CODEC_JPEG);
    EXPECT_EQ(told.viewers(0).width(), 64);
    EXPECT_EQ(told.view().camera().eye(0), 3);
    EXPECT_EQ(told.statistics().triangles(), 1000U);
    EXPECT_EQ(told.frames_drawn(), 1U);

    v1::GetSessionRequest request;
    v1::GetSessionResponse response;
    request.set_id("tour");
    EXPECT_TRUE(
        call([&](auto& context) { return stub_->GetSession(&context, request, &response); }).ok());
    EXPECT_EQ(response.session().view().camera().eye(0), 3);
    request.set_id("none");
    EXPECT_EQ(call([&](auto& context) {
                  return stub_->GetSession(&context, request, &response);
              }).error_code(),
              grpc::StatusCode::NOT_FOUND);
    EXPECT_EQ(ask("GET", "/sessions/none").status, 404);
}

TEST_F(ApiSessions, AreMovedByPrograms) {
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    Browser leader(sessions, {"tour"});
    EXPECT_EQ(ask("PATCH", "/sessions/tour", R"({"tauPixels":2})").status, 409);
    const RestAnswer moved = ask("PATCH", "/sessions/tour",
                                 R"({"camera":{"eye":[5,-10,3],"target":[0,0,0]},"tauPixels":2,)"
                                 R"("shading":"SHADING_FLAT","underground":true})");
    const auto session = parsed<v1::Session>(moved);
    EXPECT_EQ(session.view().camera().eye(0), 5);
    EXPECT_TRUE(session.view().underground());
    ASSERT_TRUE(leader.nextFrame());
    EXPECT_EQ(frames_.requests().back().camera.eye.x, 5);
    EXPECT_EQ(frames_.requests().back().tauPixels, 2);
    EXPECT_EQ(frames_.requests().back().shading, fabric::Shading::Flat);
    // What is not named stays.
    const auto after = parsed<v1::Session>(ask("PATCH", "/sessions/tour", R"({"tauPixels":4})"));
    EXPECT_EQ(after.view().camera().eye(0), 5);
    EXPECT_EQ(after.view().tau_pixels(), 4);
    EXPECT_EQ(after.view().shading(), v1::SHADING_FLAT);
}

TEST_F(ApiSessions, AreNotMovedWhereNothingCanBeSeen) {
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    Browser leader(sessions, {"tour"});
    for (const char* wrong :
         {R"({"camera":{"eye":[0,0]}})", R"({"tauPixels":0})", R"({"tauPixels":"NaN"})",
          R"({"camera":{"eye":[0,0,0],"target":[0,0,0]}})", R"({"look":{"exaggeration":1e9}})"}) {
        const RestAnswer answer = ask("PATCH", "/sessions/tour", wrong);
        EXPECT_EQ(answer.status, 400) << wrong << *answer.body;
    }
    EXPECT_FALSE(api_->sessions()->find("tour")->facts().view);
}

TEST_F(ApiSessions, AreToldWhichFieldOfTheChangeIsWrong) {
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    Browser leader(sessions, {"tour"});
    for (const auto& [wrong, field, detail] :
         {std::tuple(R"({"tauPixels":5000})", "change.tauPixels", "change.tau_pixels is 5000;"),
          std::tuple(R"({"shading":99})", "change.shading", "change.shading is 99,"),
          std::tuple(R"({"camera":{"eye":[0,0]}})", "change.camera.eye", "change.camera.eye has 2"),
          std::tuple(R"({"look":{"exaggeration":1e9}})", "change.look.exaggeration",
                     "change.look.exaggeration is "),
          std::tuple(R"({"shown":{"eye":99}})", "change.shown.eye", "change.shown.eye is 99")}) {
        const RestAnswer answer = ask("PATCH", "/sessions/tour", wrong);
        EXPECT_EQ(answer.status, 400) << wrong;
        EXPECT_THAT(*answer.body, HasSubstr(fmt::format(R"("field":"{}")", field))) << wrong;
        EXPECT_THAT(*answer.body, HasSubstr(fmt::format(R"("detail":"{})", detail))) << wrong;
    }
}

TEST_F(ApiSessions, AreNotShownWhatTheConfigurationHasNot) {
    frames_.setSeen([](const coordinator::FrameRequest& request) {
        return request.shown.front().canvas == "nope"
                   ? absl::StatusOr<fabric::SeenAreas>(
                         absl::NotFoundError("there is no canvas 'nope'; there is 'wall'"))
                   : absl::FailedPreconditionError("there was no renderer yet");
    });
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    Browser leader(sessions, {"tour"});
    leader.look(3);
    const RestAnswer wrong = ask("PATCH", "/sessions/tour", R"({"shown":{"canvas":"nope"}})");
    EXPECT_EQ(wrong.status, 404);
    EXPECT_THAT(*wrong.body, HasSubstr("there is 'wall'"));
    EXPECT_EQ(ask("PATCH", "/sessions/tour", R"({"shown":{"canvas":"wall"}})").status, 200);
}

TEST_F(ApiSessions, AreClosedByPrograms) {
    stream::Sessions sessions(frames_, stream::moving(1), api_->sessions());
    Browser viewer(sessions, {"tour"});
    EXPECT_EQ(ask("DELETE", "/sessions/tour").status, 200);
    EXPECT_TRUE(viewer.viewer().isClosed());
    EXPECT_EQ(ask("DELETE", "/sessions/tour").status, 404);
}

TEST_F(ApiSessions, AreMovedByWhoMayControlAndClosedByAdministrators) {
    using access::Role;
    EXPECT_EQ(roleForRest("GET", "/sessions"), Role::View);
    EXPECT_EQ(roleForRest("GET", "/statistics"), Role::View);
    EXPECT_EQ(roleForRest("PATCH", "/sessions/a"), Role::Control);
    EXPECT_EQ(roleForRest("DELETE", "/sessions/a"), Role::Admin);
    EXPECT_EQ(roleForRest("POST", "/bench-runs"), Role::Admin);
    EXPECT_EQ(roleForRest("PUT", "/scene"), Role::Control);
    EXPECT_EQ(roleForRest("POST", "/image"), Role::View);
    EXPECT_EQ(roleForRest("POST", "/nothing"), Role::Admin);
    EXPECT_EQ(roleForRest("HEAD", "/nothing"), Role::View);
}

TEST_F(ApiSessions, StatisticsComeAsEventsOfJson) {
    ASSERT_EQ(ask("GET", "/image?width=20&height=10").status, 200);
    const RestAnswer answer = ask("GET", "/statistics?perSecond=100");
    ASSERT_EQ(answer.status, 200) << *answer.body;
    EXPECT_EQ(answer.contentType, "text/event-stream");
    ASSERT_NE(answer.events, nullptr);
    std::promise<std::string> event;
    answer.events->next([&](const auto& message) { event.set_value(eventOf(**message)); });
    const std::string text = event.get_future().get();
    ASSERT_THAT(text, StartsWith("data: {"));
    EXPECT_TRUE(text.ends_with("}\n\n"));
    EXPECT_EQ(text.find('\n'), text.size() - 2) << "an event is a line";
    v1::WatchStatisticsResponse told;
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(text.substr(6), &told).ok());
    EXPECT_EQ(told.statistics().width(), 20);
    EXPECT_EQ(told.session(), "");
    EXPECT_EQ(ask("HEAD", "/statistics").events, nullptr);
}

TEST_F(ApiSessions, StatisticsAreRefusedWhereTheyAreAskedForWrongly) {
    for (const char* wrong : {"?perSecond=0", "?perSecond=-1", "?perSecond=NaN", "?perSecond=1e9",
                              "?perSecond=x", "?other=1"}) {
        const RestAnswer answer = ask("GET", std::string("/statistics") + wrong);
        EXPECT_EQ(answer.status, 400) << wrong;
        EXPECT_EQ(answer.contentType, "application/problem+json");
        EXPECT_EQ(answer.events, nullptr);
    }
}

TEST_F(ApiSessions, StatisticsStreamOverGrpcUntilTheCallerHasGone) {
    grpc::ClientContext context;
    const auto stream = stub_->WatchStatistics(&context, {});
    v1::WatchStatisticsResponse told;
    std::jthread drawing([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) ask("GET", "/image?width=20&height=10");
    });
    for (std::uint64_t last = 0, i = 0; i < 20; ++i, last = told.frame()) {
        ASSERT_TRUE(stream->Read(&told));
        EXPECT_GT(told.frame(), last);
        EXPECT_TRUE(i == 0 || told.left_out() == told.frame() - last - 1)
            << "each frame is told of or counted";
    }
    context.TryCancel();
    while (stream->Read(&told)) {
    }
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::CANCELLED);
    drawing = {};  // it asks this API
    // Its place is free again.
    makeApi({.readers = 1});
    for (int i = 0; i < 3; ++i) {
        grpc::ClientContext again;
        const auto one = stub_->WatchStatistics(&again, {});
        EXPECT_TRUE(eventually([&] { return ask("HEAD", "/statistics").status == 200; }));
        again.TryCancel();
        one->Finish();
        EXPECT_TRUE(eventually([&] { return ask("GET", "/statistics").status == 200; }));
    }
}

TEST_F(ApiSessions, TracesHaveAsManyFramesAsAreAskedFor) {
    const auto now = observe::Clock::now();
    for (std::uint64_t frame = 1; frame <= 20; ++frame)
        telemetry_->traces.add({"coordinator", "frames", "frame", frame,
                                now + std::chrono::milliseconds(frame),
                                now + std::chrono::milliseconds(frame + 1)});
    const auto count = [](const std::string& text) {
        std::size_t spans = 0;
        for (auto at = text.find("\"ph\":\"X\""); at != std::string::npos;
             at = text.find("\"ph\":\"X\"", at + 1))
            ++spans;
        return spans;
    };
    const RestAnswer answer = ask("GET", "/trace");
    EXPECT_EQ(answer.contentType, "application/vnd.eyrie.trace+json");
    EXPECT_EQ(count(*answer.body), 10U);
    EXPECT_EQ(count(*ask("GET", "/trace?frames=3").body), 3U);
    EXPECT_EQ(count(*ask("GET", "/trace?frames=1000").body), 20U);
    for (const char* wrong : {"frames=0", "frames=-1", "frames=1001", "frames=x", "frame=3",
                              "frames=99999999999999999999"}) {
        const RestAnswer refused = ask("GET", std::string("/trace?") + wrong);
        EXPECT_EQ(refused.status, 400) << wrong;
        EXPECT_EQ(refused.contentType, "application/problem+json");
    }
    EXPECT_EQ(ask("POST", "/trace", "{}").status, 405);
    v1::GetTraceRequest request;
    request.set_frames(3);
    v1::GetTraceResponse response;
    ASSERT_TRUE(
        call([&](auto& context) { return stub_->GetTrace(&context, request, &response); }).ok());
    EXPECT_EQ(count(response.content()), 3U);
}

TEST_F(ApiSessions, ProfilesWaitForAScene) {
    coordinator::Status opening = coordinator::readyStatus();
    opening.sceneInfo = {};
    opening.problem = "opening the scene";
    frames_.setStatus(opening);
    EXPECT_EQ(ask("POST", "/profile", R"({"samples":2,"to":{"x":1}})").status, 503);
}

TEST_F(ApiSessions, StatisticsEndWithTheCallersDeadline) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
    v1::WatchStatisticsRequest request;
    request.set_session("nobody");
    const auto stream = stub_->WatchStatistics(&context, request);
    v1::WatchStatisticsResponse told;
    EXPECT_FALSE(stream->Read(&told));
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST_F(ApiSessions, StatisticsEndWhenTheServerDoes) {
    grpc::ClientContext context;
    v1::WatchStatisticsRequest request;
    const auto stream = stub_->WatchStatistics(&context, request);
    v1::WatchStatisticsResponse told;
    ask("GET", "/image?width=20&height=10");
    ASSERT_TRUE(stream->Read(&told));
    api_->endStreams();
    EXPECT_FALSE(stream->Read(&told));
    EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(ApiSessions, StatisticsWaitForNobodyWhoDoesNotRead) {
    grpc::ClientContext context;
    const auto stream = stub_->WatchStatistics(&context, {});
    v1::WatchStatisticsResponse told;
    ask("GET", "/image?width=2&height=1");
    ASSERT_TRUE(stream->Read(&told));
    // More than any buffer on the way holds, were each to be sent.
    const coordinator::RenderedFrame frame = [] {
        coordinator::FrameRequest request;
        request.width = request.height = 1;
        coordinator::RenderedFrame made = coordinator::plainFrame(request, {});
        coordinator::DrawnPart part;
        part.renderer = std::string(60, 'r');
        made.parts.resize(2000, part);
        return made;
    }();
    for (int i = 0; i < 500; ++i) api_->sessions()->statistics().drawn("", frame);
    v1::WatchStatisticsResponse last;
    std::uint64_t messages = 0;
    std::uint64_t frames = 1;
    while (frames < 501 && stream->Read(&last)) {
        ++messages;
        frames += 1 + last.left_out();
    }
    EXPECT_EQ(frames, 501U);
    EXPECT_EQ(last.frame(), 501U) << "the newest is told, however slow the reader";
    EXPECT_LT(messages, 400U) << "some 180 kB each: most are left out";
    context.TryCancel();
    stream->Finish();
}

}  // namespace
}  // namespace eyrie::api
