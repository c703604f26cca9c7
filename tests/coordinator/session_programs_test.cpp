// SPDX-License-Identifier: Apache-2.0
// What programs see of sessions, and do to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/session_book.h"
#include "coordinator/stream/sessions.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "tests/coordinator/viewer_browser.h"
#include "tests/service/eventually.h"

namespace eyrie::stream {
namespace {

using testing::ElementsAre;
using testing::SizeIs;
using testing::StartsWith;

class SessionPrograms : public testing::Test {
protected:
    std::shared_ptr<Session> session(const std::string& id) const { return book_->find(id); }
    std::vector<std::string> ids() const {
        std::vector<std::string> ids;
        for (const auto& each : book_->all()) ids.push_back(each->id());
        return ids;
    }
    static ViewChange cameraAt(double x) {
        ViewChange change;
        change.camera = fabric::Camera();
        change.camera->eye = {x, -20, 5};
        return change;
    }

    coordinator::FakeFrameSource frames_;
    std::shared_ptr<SessionBook> book_ = std::make_shared<SessionBook>();
    Sessions sessions_{frames_, moving(1), book_};
};

TEST_F(SessionPrograms, AreToldOfEachWhileItHasViewers) {
    EXPECT_THAT(book_->all(), SizeIs(0));
    {
        const Browser named(sessions_, {"tour"});
        const Browser alone(sessions_, {});
        const Browser other(sessions_, {"tour", Role::Watch});
        EXPECT_THAT(ids(), ElementsAre("tour", StartsWith("@")));
        EXPECT_THAT(session("tour")->facts().viewers, SizeIs(2));
        EXPECT_THAT(session(ids().back())->facts().viewers, SizeIs(1));
        EXPECT_EQ(session("else"), nullptr);
    }
    EXPECT_THAT(book_->all(), SizeIs(0));
    const Browser again(sessions_, {"tour"});
    EXPECT_THAT(ids(), ElementsAre("tour"));
}

TEST_F(SessionPrograms, SeeWhoLeadsAndWhatEachWasGiven) {
    Browser leader(sessions_, {"tour"});
    Browser watcher(sessions_, {"tour", Role::Watch, false});
    const SessionFacts before = session("tour")->facts();
    EXPECT_FALSE(before.view);
    EXPECT_EQ(before.frame, nullptr);
    EXPECT_EQ(before.viewers[0].last.as, SentAs::Nothing);
    leader.look(1);
    ASSERT_TRUE(leader.nextFrame());
    ASSERT_TRUE(watcher.nextFrame());
    const SessionFacts facts = session("tour")->facts();
    ASSERT_THAT(facts.viewers, SizeIs(2));
    EXPECT_TRUE(facts.viewers[0].leads);
    EXPECT_TRUE(facts.viewers[0].mayControl);
    EXPECT_FALSE(facts.viewers[1].leads);
    EXPECT_FALSE(facts.viewers[1].mayControl);
    EXPECT_EQ(facts.viewers[1].role, Role::Watch);
    EXPECT_EQ(facts.viewers[0].last.width, 64);
    EXPECT_EQ(facts.viewers[0].last.height, 48);
    EXPECT_EQ(facts.viewers[0].last.as, SentAs::Jpeg);
    EXPECT_EQ(facts.viewers[0].given, 1U);
    EXPECT_EQ(facts.counts.drawn, 1U);
    EXPECT_EQ(facts.view->frame.camera.eye.x, 1);
    EXPECT_EQ(facts.frame->statistics.triangles, 1000U);
}

TEST_F(SessionPrograms, SeeThatAPictureAtRestIsAPng) {
    Sessions resting(frames_, stream::resting(), book_);
    Browser viewer(resting, {"rest"});
    viewer.look(1);
    while (session("rest")->facts().viewers[0].last.as != SentAs::Png) {
        std::optional<v1::Frame> frame = viewer.nextFrame();
        ASSERT_TRUE(frame);
        viewer.receiveWhole(*frame);
    }
}

TEST_F(SessionPrograms, MoveTheCameraForAllAndItsLeaderIsToldWhereTo) {
    Browser leader(sessions_, {"tour"});
    Browser watcher(sessions_, {"tour", Role::Watch});
    leader.look(1);
    const std::optional<v1::Frame> own = leader.nextFrame();
    ASSERT_TRUE(own);
    EXPECT_EQ(own->view_sequence(), 1U);
    leader.acknowledge(own->frame_number());
    const std::optional<v1::Frame> led = watcher.nextFrame();
    ASSERT_TRUE(led);
    watcher.acknowledge(led->frame_number());

    ViewChange change = cameraAt(42);
    change.tauPixels = 3;
    ASSERT_TRUE(session("tour")->change(change).ok());
    for (Browser* const browser : {&leader, &watcher}) {
        const std::optional<v1::Frame> moved = browser->nextFrame();
        ASSERT_TRUE(moved);
        EXPECT_EQ(moved->view_sequence(), 0U);
        ASSERT_TRUE(moved->has_led_view());
        EXPECT_EQ(moved->led_view().camera().eye(0), 42);
        EXPECT_EQ(moved->led_view().tau_pixels(), 3);
        EXPECT_EQ(moved->width(), 64) << "the size stays the leader's";
        browser->acknowledge(moved->frame_number());
    }
    EXPECT_EQ(frames_.requests().back().camera.eye.x, 42);

    leader.look(2);
    const std::optional<v1::Frame> after = leader.nextFrame();
    ASSERT_TRUE(after);
    EXPECT_EQ(after->view_sequence(), 2U) << "who leads still does";
}

TEST_F(SessionPrograms, LeadWhereNobodyDoes) {
    Browser watcher(sessions_, {"wall", Role::Watch});
    ViewChange change;
    change.tauPixels = 2;
    EXPECT_TRUE(absl::IsFailedPrecondition(session("wall")->change(change)));
    ASSERT_TRUE(session("wall")->change(cameraAt(7)).ok());
    const std::optional<v1::Frame> frame = watcher.nextFrame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->led_view().camera().eye(0), 7);
    EXPECT_EQ(frames_.requests().back().width, 1280);
}

TEST_F(SessionPrograms, SendViewersAwayAndOthersMayComeUnderTheSameName) {
    Browser viewer(sessions_, {"tour"});
    Browser other(sessions_, {});
    EXPECT_FALSE(viewer.viewer().isClosed());
    const std::shared_ptr<Session> closed = session("tour");
    closed->close();
    EXPECT_TRUE(viewer.viewer().isClosed());
    EXPECT_FALSE(other.viewer().isClosed());
    EXPECT_THAT(ids(), ElementsAre(StartsWith("@")));
    EXPECT_TRUE(absl::IsNotFound(closed->change(cameraAt(1))));
    Browser next(sessions_, {"tour"});
    EXPECT_FALSE(next.viewer().isClosed());
    viewer.viewer().stop();
    Browser second(sessions_, {"tour", Role::Watch});
    EXPECT_THAT(session("tour")->facts().viewers, SizeIs(2))
        << "the end of the closed one leaves the new one's name alone";
}

TEST_F(SessionPrograms, HearOfItsFrames) {
    Browser viewer(sessions_, {"tour"});
    std::atomic<std::uint64_t> triangles = 0;
    const auto reader = book_->statistics().read({"tour", {}}).value();
    reader->next([&](const auto& message) { triangles = (*message)->statistics().triangles(); });
    viewer.look(1);
    EXPECT_TRUE(eventually([&] { return triangles == 1000; }));
}

}  // namespace
}  // namespace eyrie::stream
