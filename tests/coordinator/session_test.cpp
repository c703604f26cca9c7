// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/session.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/sessions.h"
#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using std::chrono::milliseconds;
using testing::HasSubstr;

const Joining kLead{"shared", Role::Lead};
const Joining kWatch{"shared", Role::Watch};

bool isPlace(const v1::SessionState& state, int viewers, bool leads, bool led = true) {
    const v1::ViewerPlace& place = state.place();
    return place.viewers() == viewers && place.leads() == leads && place.led() == led;
}

/// Whether it is told so.
bool comesToBe(Browser& browser, int viewers, bool leads, bool led = true) {
    return browser
        .stateWhere(
            [=](const v1::SessionState& state) { return isPlace(state, viewers, leads, led); })
        .has_value();
}

TEST(Session, IsOfOneViewerWhereNoneIsNamed) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser one(sessions, {});
    Browser other(sessions, {});
    const auto state = one.next();
    ASSERT_TRUE(state && state->has_state());
    EXPECT_EQ(state->state().place().session(), "");
    EXPECT_TRUE(isPlace(state->state(), 1, true));
    one.look(1);
    EXPECT_TRUE(one.nextFrame().has_value());
    EXPECT_FALSE(other.nextFrame(milliseconds(50)).has_value());
}

TEST(Session, ThatNobodySeesAnyMoreGivesItsFramesUp) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    frames.hold(true);
    {
        Browser only(sessions, {});
        only.look(1);
        ASSERT_TRUE(frames.waitForRequests(1));
        EXPECT_FALSE(frames.requests()[0].stop.stop_requested());
    }
    EXPECT_TRUE(frames.requests()[0].stop.stop_requested());
}

TEST(Session, ThatSomebodyStillSeesGoesOnWithItsFrames) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    frames.hold(true);
    Browser stays(sessions, kLead);
    {
        Browser goes(sessions, kLead);
        stays.look(1);
        ASSERT_TRUE(frames.waitForRequests(1));
    }
    EXPECT_FALSE(frames.requests()[0].stop.stop_requested());
    frames.hold(false);
    EXPECT_TRUE(stays.nextFrame().has_value());
}

TEST(Session, ShowsAllWhatItsLeaderMoves) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    Browser other(sessions, kLead);
    ASSERT_TRUE(comesToBe(leader, 2, true));
    ASSERT_TRUE(comesToBe(other, 2, false));
    leader.look(7);
    const auto led = leader.nextFrame();
    const auto seen = other.nextFrame();
    ASSERT_TRUE(led && seen);
    EXPECT_EQ(led->view_sequence(), 7u);
    EXPECT_FALSE(led->has_led_view());
    EXPECT_EQ(seen->view_sequence(), 0u);
    EXPECT_EQ(seen->led_view().camera().eye(0), 7);
    EXPECT_EQ(seen->led_view().width(), 64);
    EXPECT_EQ(seen->jpeg(), led->jpeg());
    EXPECT_EQ(frames.requests().size(), 1u);
}

TEST(Session, TellsWatchersTheWholeViewThatTheySee) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    Browser other(sessions, kWatch);
    v1::ViewerRequest request = viewMessage(3, 5);
    v1::ViewRequest& view = *request.mutable_view();
    view.set_shading(v1::SHADING_FLAT);
    view.set_underground(true);
    view.set_budget_milliseconds(20);
    view.mutable_look()->set_exaggeration(2);
    view.mutable_look()->set_saturation(0.5);
    view.mutable_shown()->set_canvas("wall");
    view.mutable_shown()->set_segment("left");
    view.mutable_shown()->set_eye(v1::SHOWN_EYE_RIGHT);
    view.mutable_shown()->set_stereo(v1::SHOWN_STEREO_TOP_BOTTOM);
    leader.send(request);
    const auto seen = other.nextFrame();
    ASSERT_TRUE(seen.has_value());
    // Sent back, it asks for the very same.
    v1::ViewerRequest again;
    *again.mutable_view() = seen->led_view();
    const auto asked = parseRequest(bytesOf(request.SerializeAsString()));
    const auto told = parseRequest(bytesOf(again.SerializeAsString()));
    ASSERT_TRUE(asked.ok() && told.ok());
    EXPECT_TRUE(std::get<ViewRequest>(*asked).frame == std::get<ViewRequest>(*told).frame);
    EXPECT_TRUE(std::get<ViewRequest>(*told).isUnderground);
}

TEST(Session, TakesNoViewsFromThoseWhoWatch) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser watcher(sessions, kWatch);
    ASSERT_TRUE(comesToBe(watcher, 1, false, false));
    watcher.look(1);
    EXPECT_FALSE(watcher.nextFrame(milliseconds(50)).has_value());
    EXPECT_TRUE(frames.requests().empty());
}

v1::ViewerRequest leadMessage() {
    v1::ViewerRequest request;
    request.mutable_lead();
    return request;
}

TEST(Session, IsMovedByWhoTakesTheLead) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser first(sessions, kLead);
    Browser second(sessions, kWatch);
    first.look(900);
    const auto seen = second.nextFrame();
    ASSERT_TRUE(seen.has_value());
    second.acknowledge(seen->frame_number());
    second.send(leadMessage());
    ASSERT_TRUE(comesToBe(first, 2, false));
    ASSERT_TRUE(comesToBe(second, 2, true));
    first.look(901);
    second.look(1);
    const auto own = second.nextFrame();
    ASSERT_TRUE(own.has_value());
    EXPECT_EQ(own->view_sequence(), 1u);
    EXPECT_FALSE(own->has_led_view());
    EXPECT_EQ(frames.requests().back().camera.eye.x, 1);
    EXPECT_EQ(frames.requests().size(), 2u) << "what who no longer leads asks for is not drawn";
}

TEST(Session, PassesTheLeadOnToWhoCameNextAndMayLead) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    auto first = std::make_unique<Browser>(sessions, kLead);
    Browser watcher(sessions, kWatch);
    auto second = std::make_unique<Browser>(sessions, kLead);
    first.reset();
    EXPECT_TRUE(comesToBe(*second, 2, true));
    second.reset();
    EXPECT_TRUE(comesToBe(watcher, 1, false, false)) << "it came to watch";
    Browser third(sessions, kLead);
    EXPECT_TRUE(comesToBe(third, 2, true));
}

TEST(Session, LetsOnlyItsLeaderSwitchLayouts) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    Browser watcher(sessions, kWatch);
    v1::ViewerRequest request;
    request.mutable_switch_layout()->set_layout("OFF");
    watcher.send(request);
    const auto refused =
        watcher.stateWhere([](const v1::SessionState& state) { return !state.note().empty(); });
    ASSERT_TRUE(refused.has_value());
    EXPECT_THAT(refused->note(), HasSubstr("leads"));
    EXPECT_EQ(refused->problem(), "") << "it goes on seeing pictures";
    watcher.send(leadMessage());
    EXPECT_TRUE(watcher.stateWhere([](const v1::SessionState& state) {
        return state.note().empty() && state.place().leads();
    }));
}

TEST(Session, IsOnlyWatchedByWhoMayNotControl) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser guest(sessions, {"shared", Role::Lead, false});
    ASSERT_TRUE(comesToBe(guest, 1, false, false));
    guest.send(leadMessage());
    const auto refused =
        guest.stateWhere([](const v1::SessionState& state) { return !state.note().empty(); });
    ASSERT_TRUE(refused.has_value());
    EXPECT_FALSE(refused->place().led());
    EXPECT_FALSE(refused->place().may_control());
    Browser leader(sessions, kLead);
    EXPECT_TRUE(leader.stateWhere([](const v1::SessionState& state) {
        return state.place().leads() && state.place().may_control();
    }));
    Browser alone(sessions, {"", Role::Lead, false});
    alone.look(1);
    EXPECT_TRUE(alone.nextFrame().has_value()) << "its own view is its own";
    v1::ViewerRequest request;
    request.mutable_switch_layout()->set_layout("OFF");
    alone.send(request);
    EXPECT_TRUE(alone.stateWhere([](const v1::SessionState& state) {
        return state.note().find("may not switch") != std::string::npos;
    }));
}

/// A connection that died without being closed is there for half a minute more.
TEST(Session, GivesWhoComesAgainItsPlaceAndTheLead) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    auto gone = std::make_unique<Browser>(sessions, Joining{"shared", Role::Lead, true, "a-page"});
    Browser other(sessions, kLead);
    ASSERT_TRUE(comesToBe(other, 2, false));
    Browser again(sessions, {"shared", Role::Watch, true, "a-page"});
    EXPECT_TRUE(comesToBe(again, 2, true));
    EXPECT_TRUE(gone->viewer().isReplaced());
    EXPECT_FALSE(again.viewer().isReplaced());
    gone->look(1);
    again.look(2);
    const auto frame = other.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->led_view().sequence(), 2U) << "and not what who is gone still asks for";
    gone.reset();
    Browser third(sessions, {"shared", Role::Lead, true, "another-page"});
    EXPECT_TRUE(comesToBe(third, 3, false));
    EXPECT_TRUE(isPlace(
        again.stateWhere([](const v1::SessionState& state) { return state.place().viewers() == 3; })
            .value_or(v1::SessionState()),
        3, true));
}

TEST(Session, GivesTheLeadBackToWhoLedUnlessSomebodyTookIt) {
    const Joining led{"shared", Role::Lead, true, "a-page"};
    for (const bool isTaken : {false, true}) {
        SCOPED_TRACE(isTaken);
        FakeFrameSource frames;
        Sessions sessions(frames, moving(2));
        auto gone = std::make_unique<Browser>(sessions, led);
        Browser heir(sessions, kLead);
        ASSERT_TRUE(comesToBe(heir, 2, false));
        gone.reset();
        ASSERT_TRUE(comesToBe(heir, 1, true));
        if (isTaken)
            heir.send(leadMessage());
        Browser again(sessions, led);
        EXPECT_TRUE(comesToBe(again, 2, !isTaken));
        EXPECT_TRUE(comesToBe(heir, 2, isTaken));
    }
}

TEST(Session, GivesNoLeadToWhoMayNotControlUnderTheSameName) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, {"shared", Role::Lead, true, "a-page"});
    Browser watcher(sessions, {"shared", Role::Lead, false, "a-page"});
    EXPECT_TRUE(comesToBe(watcher, 2, false));
    EXPECT_FALSE(leader.viewer().isReplaced());
}

TEST(Session, IsDrawnAndEncodedOnceForEightViewersOfOneClass) {
    constexpr std::uint64_t kViews = 20;
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    const Sessions::Joined counter = sessions.join(kLead, [] {});
    std::vector<std::unique_ptr<Browser>> browsers;
    for (int i = 0; i < 8; ++i) browsers.push_back(std::make_unique<Browser>(sessions, kWatch));
    browsers[0]->send(leadMessage());
    for (std::uint64_t view = 1; view <= kViews; ++view) {
        browsers[0]->look(view);
        for (const auto& browser : browsers) {
            const auto frame = browser->nextFrame();
            ASSERT_TRUE(frame.has_value());
            browser->acknowledge(frame->frame_number());
        }
    }
    const SessionCounts counts = counter.session->counts();
    EXPECT_EQ(frames.requests().size(), kViews);
    EXPECT_EQ(counts.drawn, kViews);
    EXPECT_EQ(counts.encoded, kViews);
    EXPECT_GE(counts.given, 8 * kViews);
    sessions.leave(counter);
}

TEST(Session, WaitsForNoViewerThatIsSlow) {
    constexpr std::uint64_t kViews = 30;
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser fast(sessions, kLead);
    Browser slow(sessions, kWatch);
    ASSERT_TRUE(comesToBe(fast, 2, true));
    std::optional<v1::Frame> last;
    for (std::uint64_t view = 1; view <= kViews; ++view) {
        fast.look(view);
        const auto frame = fast.nextFrame();
        ASSERT_TRUE(frame.has_value());
        ASSERT_EQ(frame->view_sequence(), view);
        fast.acknowledge(frame->frame_number());
        if (view <= 2) {
            last = slow.nextFrame();
            ASSERT_TRUE(last.has_value());
        }
    }
    EXPECT_FALSE(slow.nextFrame(milliseconds(50)).has_value()) << "it has two under way";
    slow.acknowledge(last->frame_number());
    const auto newest = slow.nextFrame();
    ASSERT_TRUE(newest.has_value());
    EXPECT_EQ(newest->led_view().sequence(), kViews) << "when it has room, the newest";
    EXPECT_EQ(frames.requests().size(), kViews);
}

TEST(Session, IsDrawnForWatchersWhileItsLeaderDoesNotRead) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    Browser watcher(sessions, kWatch);
    ASSERT_TRUE(comesToBe(watcher, 2, false));
    for (std::uint64_t view = 1; view <= 10; ++view) {
        leader.look(view);
        const auto frame = watcher.nextFrame();
        ASSERT_TRUE(frame.has_value());
        EXPECT_EQ(frame->led_view().sequence(), view);
        watcher.acknowledge(frame->frame_number());
    }
}

TEST(Session, GivesAViewAtRestToWhoComesLaterWithoutDrawingIt) {
    FakeFrameSource frames;
    Sessions sessions(frames, resting());
    Browser leader(sessions, kLead);
    leader.look(1);
    for (bool isExact = false; !isExact;) {
        const auto frame = leader.nextFrame();
        ASSERT_TRUE(frame.has_value());
        leader.acknowledge(frame->frame_number());
        isExact = frame->has_png();
    }
    Browser late(sessions, kWatch);
    const auto fine = late.nextFrame();
    ASSERT_TRUE(fine.has_value());
    EXPECT_TRUE(fine->still() && fine->has_jpeg());
    late.acknowledge(fine->frame_number());
    const auto exact = late.nextFrame();
    ASSERT_TRUE(exact.has_value());
    EXPECT_TRUE(exact->has_png());
    late.acknowledge(exact->frame_number());
    EXPECT_FALSE(late.nextFrame(milliseconds(100)).has_value());
    EXPECT_FALSE(leader.nextFrame(milliseconds(10)).has_value());
    EXPECT_EQ(frames.requests().size(), 1u);
}

TEST(Session, BeginsAnewUnderTheNameOfOneThatEnded) {
    FakeFrameSource frames;
    Sessions sessions(frames, moving(2));
    for (int i = 0; i < 3; ++i) {
        Browser leader(sessions, kLead);
        ASSERT_TRUE(comesToBe(leader, 1, true));
        leader.look(1);
        ASSERT_TRUE(leader.nextFrame().has_value());
    }
    EXPECT_EQ(frames.requests().size(), 3u);
    EXPECT_EQ(frames.listenerCount(), 0u);
}

TEST(Joining, IsReadFromTheAddress) {
    const auto named = joiningOf("/ws?role=watch&other=1&session=a-B_1.x&viewer=v.1");
    ASSERT_TRUE(named.ok());
    EXPECT_EQ(named->viewer, "v.1");
    EXPECT_EQ(named->session, "a-B_1.x");
    EXPECT_EQ(named->role, Role::Watch);
    const auto plain = joiningOf("/ws");
    ASSERT_TRUE(plain.ok());
    EXPECT_EQ(plain->session, "");
    EXPECT_EQ(plain->role, Role::Lead);
    EXPECT_TRUE(joiningOf("/ws?session=a&role=lead").ok());
    for (const std::string& target :
         {std::string("/ws?session="), std::string("/ws?session=a%20b"),
          std::string("/ws?session=\xc3\xa9"), "/ws?session=" + std::string(65, 'a'),
          std::string("/ws?session=a&role=king"), std::string("/ws?session=a/b"),
          std::string("/ws?session=a&session=b"), std::string("/ws?session=a&x=1&session=a"),
          std::string("/ws?role=lead&role=watch"), std::string("/ws?session=a&viewer="),
          std::string("/ws?session=a&viewer=b&viewer=b")})
        EXPECT_TRUE(absl::IsInvalidArgument(joiningOf(target).status())) << target;
}

}  // namespace
}  // namespace eyrie::stream
