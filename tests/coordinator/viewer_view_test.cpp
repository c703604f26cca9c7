// SPDX-License-Identifier: Apache-2.0
// Views that are drawn otherwise than they were asked for.

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/drawing.h"
#include "coordinator/stream/view_message.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using coordinator::FrameRequest;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A plateau of 100 m around the origin, under the cameras that viewMessage makes.
coordinator::Status plateauStatus() {
    fabric::GroundGrid plateau;
    plateau.worldFromGrid[0] = {200, 0, 0, 0};
    plateau.worldFromGrid[1] = {0, 200, 0, 0};
    plateau.worldFromGrid[3] = {-100, -100, 0, 1};
    plateau.columns = plateau.rows = 1;
    plateau.highest = {100};
    plateau.lowest = {0};
    coordinator::Status status = coordinator::readyStatus();
    status.sceneInfo.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, plateau);
    return status;
}

TEST(DrawnSides, AreOneEyesWhereAPictureHasBoth) {
    FrameRequest request;
    request.budgetMilliseconds = 33;
    const auto sides = [&](const fabric::PixelViewport& drawn) {
        const fabric::PictureSides found = drawnSides(request, drawn);
        return std::pair(found.width, found.height);
    };
    EXPECT_EQ(sides({0, 0, 640, 360}), std::pair(640, 360));
    request.shown.front().stereo = compound::Stereo::SideBySide;
    EXPECT_EQ(sides({0, 0, 1280, 360}), std::pair(640, 360));
    request.shown.front().stereo = compound::Stereo::TopBottom;
    EXPECT_EQ(sides({0, 0, 640, 720}), std::pair(640, 360));
    request.shown.front().eye = compound::Eye::Left;
    EXPECT_EQ(sides({0, 0, 640, 360}), std::pair(640, 360));
}

TEST(Viewer, HasPicturesOfAtMost4096PixelsASideOfAnEye) {
    v1::ViewRequest message = viewMessage(1, 1).view();
    message.set_width(1'000'000'000);
    message.set_height(4097);
    const absl::StatusOr<ViewRequest> view = viewFromMessage(message);
    ASSERT_TRUE(view.ok()) << view.status();
    EXPECT_EQ(view->frame.width, 4096);
    EXPECT_EQ(view->frame.height, 4096);
}

TEST(SessionState, SaysWhichHeightsAreExaggerated) {
    coordinator::Status status = plateauStatus();
    EXPECT_EQ(sessionState(status, "").objects(0).heights().max().z(), 100);
    fabric::GroundGrid turned = status.sceneInfo.ground->front();
    turned.worldFromGrid[2] = {0, -2, 0, 0};
    turned.lowest = {30};
    status.sceneInfo.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, turned);
    const v1::Box heights = sessionState(status, "").objects(0).heights();
    EXPECT_EQ(heights.min().y(), -200);
    EXPECT_EQ(heights.max().y(), -60);
    EXPECT_EQ(heights.max().z(), 0);
    status.sceneInfo.ground.reset();
    EXPECT_FALSE(sessionState(status, "").objects(0).has_heights());
}

TEST(Viewer, LiftsACameraOutOfTheGroundAndSaysSo) {
    FakeFrameSource frames;
    frames.setStatus(plateauStatus());
    Browser browser(frames, moving(2));
    ASSERT_TRUE(browser.stateWhere([](const auto&) { return true; }));
    browser.look(1);
    const auto frame = browser.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frames.requests().back().camera.eye.z, 102);
    EXPECT_EQ(frames.requests().back().camera.eye.x, 1);
    ASSERT_TRUE(frame->has_lifted_camera());
    EXPECT_EQ(frame->lifted_camera().eye(2), 102);
}

TEST(Viewer, LetsACameraUnderGroundThatIsMeantToBeThere) {
    FakeFrameSource frames;
    frames.setStatus(plateauStatus());
    Browser browser(frames, moving(2));
    ASSERT_TRUE(browser.stateWhere([](const auto&) { return true; }));
    v1::ViewerRequest request = viewMessage(1, 1);
    request.mutable_view()->set_underground(true);
    browser.send(request);
    const auto frame = browser.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_FALSE(frame->has_lifted_camera());
    EXPECT_EQ(frames.requests().back().camera.eye.z, 3);
    ASSERT_TRUE(frame->has_lift());
    EXPECT_EQ(frame->lift().x(), 0);
    EXPECT_EQ(frame->lift().z(), 99);
    browser.acknowledge(frame->frame_number());
    request.mutable_view()->set_underground(false);
    browser.send(request);
    EXPECT_TRUE(browser.nextFrame()->has_lifted_camera()) << "the same view, above ground again";
}

TEST(Viewer, LeavesACameraAboveGroundAsItIs) {
    FakeFrameSource frames;
    frames.setStatus(plateauStatus());
    Browser browser(frames, moving(2));
    ASSERT_TRUE(browser.stateWhere([](const auto&) { return true; }));
    v1::ViewerRequest request = viewMessage(1, 1);
    request.mutable_view()->mutable_camera()->set_eye(2, 103);
    request.mutable_view()->mutable_look()->set_exaggeration(-2);
    browser.send(request);
    const auto frame = browser.nextFrame();
    EXPECT_FALSE(frame->has_lifted_camera());
    EXPECT_EQ(frames.requests().back().look.exaggeration, -2);
    browser.acknowledge(frame->frame_number());
    request.mutable_view()->set_underground(true);
    browser.send(request);
    EXPECT_FALSE(browser.nextFrame()->has_lift());
}

v1::ViewerRequest viewIn(double time) {
    v1::ViewerRequest request = viewMessage(1, 1);
    request.mutable_view()->set_budget_milliseconds(time);
    return request;
}

/// As renderers do that keep a time by drawing at `tau`, half as wide and high.
FakeFrameSource::Draw drawnAt(double tau) {
    return [tau](const FrameRequest& request) {
        FrameRequest made = request;
        if (request.budgetMilliseconds) {
            made.width /= 2;
            made.height /= 2;
        }
        coordinator::RenderedFrame frame = coordinator::plainFrame(made, {90, 120, 60, 255});
        if (request.budgetMilliseconds) {
            frame.statistics.tauAchievedPixels = tau;
            frame.statistics.budget =
                fabric::BudgetUse{*request.budgetMilliseconds, 30, tau, 1000, 1};
        }
        return frame;
    };
}

TEST(Viewer, KeepsAFrameTimeUntilTheViewRestsAndThenDrawsWhatWasAskedFor) {
    FakeFrameSource frames;
    frames.setDraw(drawnAt(4));
    Browser browser(frames, resting());
    browser.send(viewIn(33));
    const auto fast = browser.nextFrame();
    ASSERT_TRUE(fast.has_value());
    EXPECT_FALSE(fast->still());
    EXPECT_EQ(fast->width(), 32);
    EXPECT_EQ(fast->statistics().tau_asked(), 1);
    EXPECT_EQ(fast->statistics().tau_achieved(), 8) << "in pixels of the view, half as large";
    EXPECT_EQ(fast->statistics().budget().milliseconds(), 33);
    EXPECT_EQ(fast->statistics().budget().predicted_milliseconds(), 30);
    browser.acknowledge(fast->frame_number());
    const auto still = browser.nextFrame();
    ASSERT_TRUE(still.has_value());
    EXPECT_TRUE(still->still());
    EXPECT_EQ(still->width(), 64);
    EXPECT_EQ(still->statistics().tau_achieved(), 1);
    EXPECT_FALSE(still->statistics().has_budget());
    browser.acknowledge(still->frame_number());
    const auto exact = browser.nextFrame();
    EXPECT_TRUE(exact.has_value() && exact->has_png());
    browser.acknowledge(exact->frame_number());
    EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
    ASSERT_EQ(frames.requests().size(), 2u);
    EXPECT_EQ(frames.requests()[0].budgetMilliseconds, 33);
    EXPECT_FALSE(frames.requests()[1].budgetMilliseconds.has_value());
}

TEST(Viewer, KeepsAFrameTimeWhileAHeadMovesBeforeAViewAtRest) {
    FakeFrameSource frames;
    frames.setDraw(drawnAt(4));
    Browser browser(frames, resting());
    browser.send(viewIn(33));
    for (int i = 0; i < 3; ++i) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.acknowledge(frame->frame_number());
    }
    ASSERT_EQ(frames.requests().size(), 2U);
    coordinator::Status status = coordinator::readyStatus();
    ++status.displayRevision;
    frames.setStatus(status);
    for (int i = 0; i < 2; ++i) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        EXPECT_EQ(frame->width(), i == 0 ? 32 : 64);
        browser.acknowledge(frame->frame_number());
    }
    EXPECT_EQ(frames.requests()[2].budgetMilliseconds, 33);
    EXPECT_FALSE(frames.requests()[3].budgetMilliseconds.has_value());
}

/// Or it would follow the time that frames take.
TEST(Viewer, KeepsNoFrameTimeWhereTheCutIsFrozen) {
    FakeFrameSource frames;
    frames.setDraw(drawnAt(4));
    Browser browser(frames, resting());
    v1::ViewerRequest request = viewIn(33);
    v1::Camera& frozen = *request.mutable_view()->mutable_look()->mutable_cut_camera();
    frozen = request.view().camera();
    browser.send(request);
    const auto frame = browser.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->width(), 64);
    EXPECT_FALSE(frame->statistics().has_budget());
    EXPECT_FALSE(frames.requests().at(0).budgetMilliseconds.has_value());
}

/// As of a segment beside its canvas: it is its share of the size that is asked for.
TEST(Viewer, RestsWherePicturesAreSmallerThanAskedFor) {
    FakeFrameSource frames;
    frames.setDraw([](FrameRequest request) {
        request.width /= 2;
        return coordinator::plainFrame(request, {90, 120, 60, 255});
    });
    Browser browser(frames, resting());
    browser.send(viewMessage(1, 1));
    while (const auto frame = browser.nextFrame(milliseconds(300)))
        browser.acknowledge(frame->frame_number());
    EXPECT_LE(frames.requests().size(), 2u);
}

TEST(Viewer, DrawsOnceWhatFitsItsTimeAsAskedFor) {
    FakeFrameSource frames;
    frames.setDraw([](const FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {90, 120, 60, 255});
        frame.statistics.budget = fabric::BudgetUse{33, 5, request.tauPixels, 1000, 1};
        return frame;
    });
    Browser browser(frames, resting());
    browser.send(viewIn(33));
    for (;;) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.acknowledge(frame->frame_number());
        if (frame->still())
            break;
    }
    EXPECT_EQ(frames.requests().size(), 1u);
}

/// The fake renderer says that it is one.
TEST(Viewer, DrawsFewerPixelsOnACpuWhileTheViewMovesAndAllAtRest) {
    FakeFrameSource frames;
    frames.setDraw([](const FrameRequest& request) {
        return coordinator::plainFrame(request, {90, 120, 60, 255});
    });
    SessionOptions options = resting();
    options.restDelay = milliseconds(1000);  // in which a busy machine begins a frame
    Browser browser(frames, options);
    v1::ViewerRequest wide = viewMessage(1, 1);
    wide.mutable_view()->set_width(1920);
    wide.mutable_view()->set_height(1080);
    browser.send(wide);
    const auto moving = browser.nextFrame();
    ASSERT_TRUE(moving.has_value());
    EXPECT_EQ(moving->width(), 1456);
    EXPECT_EQ(moving->height(), 819);
    browser.acknowledge(moving->frame_number());
    const auto still = browser.nextFrame();
    ASSERT_TRUE(still.has_value());
    EXPECT_TRUE(still->still());
    EXPECT_EQ(still->width(), 1920);
    EXPECT_EQ(still->height(), 1080);
}

TEST(Viewer, RefusesATimeThatIsNone) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        browser.send(viewIn(wrong));
        EXPECT_TRUE(browser.stateWhere([](const v1::SessionState& state) {
            return state.problem().find("frame time") != std::string::npos;
        })) << wrong;
        browser.look(2);  // which takes the problem away
        EXPECT_TRUE(browser.stateWhere([](const auto& state) { return state.problem().empty(); }));
    }
    for (const FrameRequest& request : frames.requests())
        EXPECT_FALSE(request.budgetMilliseconds.has_value());
}

TEST(Viewer, AsksForThePictureOfTheConfigurationThatTheViewNames) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    v1::ViewerRequest request = viewMessage(1, 1);
    v1::ShownPicture& shown = *request.mutable_view()->mutable_shown();
    shown.set_canvas("cave");
    shown.set_segment("2");
    shown.set_eye(v1::SHOWN_EYE_RIGHT);
    shown.set_stereo(v1::SHOWN_STEREO_TOP_BOTTOM);
    browser.send(request);
    ASSERT_TRUE(browser.nextFrame().has_value());
    EXPECT_EQ(frames.requests().back().shown,
              (std::vector<coordinator::Shown>{
                  {"cave", "2", compound::Eye::Right, compound::Stereo::TopBottom}}));
}

void haveAWall(FakeFrameSource& frames) {
    coordinator::Status status = coordinator::readyStatus();
    status.canvases = {{"wall", {"left", "right"}, {"2D", "DB", "OFF"}, "2D"}};
    frames.setStatus(status);
}

v1::ViewerRequest switchTo(const std::string& layout) {
    v1::ViewerRequest request;
    request.mutable_switch_layout()->set_canvas("wall");
    request.mutable_switch_layout()->set_layout(layout);
    return request;
}

TEST(Viewer, SwitchesLayoutsAndDrawsWhatThenIsShown) {
    FakeFrameSource frames;
    haveAWall(frames);
    Browser browser(frames, moving(2));
    ASSERT_TRUE(browser.stateWhere([](const v1::SessionState& state) {
        return state.canvases_size() == 1 && state.canvases(0).layouts_size() == 3 &&
               state.canvases(0).segments(1) == "right" && state.canvases(0).layout() == "2D";
    }));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    browser.send(switchTo("DB"));
    EXPECT_TRUE(browser.stateWhere(
        [](const v1::SessionState& state) { return state.canvases(0).layout() == "DB"; }));
    browser.send(switchTo("attic"));
    EXPECT_TRUE(browser.stateWhere([](const v1::SessionState& state) {
        return state.note() == "there is no layout attic" && state.problem().empty();
    }));
}

TEST(Viewer, SwitchesOneLayoutAfterTheOther) {
    FakeFrameSource frames;
    haveAWall(frames);
    Browser browser(frames, moving(2));
    frames.holdSwitches(true);
    browser.send(switchTo("DB"));
    ASSERT_TRUE(browser.stateWhere([](const v1::SessionState& state) {
        return state.canvases_size() == 1 && state.canvases(0).layout() == "DB";
    }));
    browser.send(switchTo("attic"));
    std::this_thread::sleep_for(milliseconds(30));
    frames.holdSwitches(false);
    const auto isTold = [](const v1::SessionState& state) {
        return state.note() == "there is no layout attic";
    };
    EXPECT_TRUE(browser.stateWhere(isTold));
    while (const auto response = browser.next(milliseconds(300)))
        EXPECT_TRUE(!response->has_state() || isTold(response->state()))
            << "the first ended after the second";
}

}  // namespace
}  // namespace eyrie::stream
