// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer.h"

#include <chrono>
#include <limits>
#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/viewer.pb.h"
#include "fabric/pixel_hash.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"
#include "tests/service/eventually.h"
#include "wire/png.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using coordinator::FrameRequest;
using std::chrono::milliseconds;
using testing::HasSubstr;

TEST(Viewer, StartsWithTheStateOfTheSession) {
    FakeFrameSource frames;
    Browser browser(frames);
    const auto response = browser.next();
    ASSERT_TRUE(response.has_value() && response->has_state());
    const v1::SessionState& state = response->state();
    EXPECT_EQ(state.renderers_size(), 1);
    EXPECT_TRUE(state.renderers(0).device().software());
    EXPECT_EQ(state.object_names(0), "hill");
    EXPECT_EQ(state.scene_triangles(), 1'000'000u);
    EXPECT_EQ(state.home().eye_size(), 3);
    EXPECT_EQ(state.problem(), "");
    EXPECT_TRUE(frames.requests().empty());
}

TEST(Viewer, IsToldWhatIsMissingThoughThereArePictures) {
    FakeFrameSource frames;
    Browser browser(frames, moving(1));
    frames.setDraw([](const FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {90, 120, 60, 255});
        frame.pictures.resize(1);
        frame.pictures[0].whyBlind = "the eye is not before the wall";
        return frame;
    });
    browser.look(1);
    const auto blind =
        browser.stateWhere([](const v1::SessionState& state) { return !state.note().empty(); });
    ASSERT_TRUE(blind.has_value());
    EXPECT_THAT(blind->note(), HasSubstr("not before the wall"));
    EXPECT_EQ(blind->problem(), "");
    coordinator::Status status = coordinator::readyStatus();
    status.note = "3 of the 4 renderers are ready";
    frames.setStatus(status);
    EXPECT_TRUE(browser.stateWhere(
        [&](const v1::SessionState& state) { return state.note() == status.note; }));
}

TEST(Viewer, DrawsTheNewestViewAndLeavesOutThoseBetween) {
    FakeFrameSource frames;
    frames.hold(true);
    Browser browser(frames, moving(1));
    browser.look(1);
    ASSERT_TRUE(frames.waitForRequests(1));
    for (std::uint64_t sequence = 2; sequence <= 50; ++sequence) browser.look(sequence);
    frames.hold(false);
    EXPECT_EQ(browser.nextFrame()->view_sequence(), 1u);
    browser.acknowledge(1);
    EXPECT_EQ(browser.nextFrame()->view_sequence(), 50u);
    EXPECT_EQ(frames.requests().size(), 2u);
}

TEST(Viewer, AnswersTheSameViewWithTheNextPictureOfIt) {
    FakeFrameSource frames;
    SessionOptions options = resting();
    options.framesInFlight = 1;  // so nothing follows before the acknowledgement
    Browser browser(frames, options);
    browser.send(viewMessage(1, 7));
    EXPECT_EQ(browser.nextFrame()->view_sequence(), 1u);
    browser.send(viewMessage(2, 7));
    browser.acknowledge(1);
    const auto still = browser.nextFrame();
    ASSERT_TRUE(still.has_value());
    EXPECT_TRUE(still->still());
    EXPECT_EQ(still->view_sequence(), 2u);
    EXPECT_EQ(frames.requests().size(), 1u);
}

TEST(Viewer, NeverHasMoreFramesUnderWayThanAllowed) {
    FakeFrameSource frames;
    for (const int window : {1, 2, 4}) {
        Browser browser(frames, moving(window));
        std::uint64_t sequence = 0;
        for (int i = 0; i < window; ++i) {
            browser.look(++sequence);
            ASSERT_TRUE(browser.nextFrame().has_value());
        }
        const std::size_t rendered = frames.requests().size();
        for (int i = 0; i < 20; ++i) browser.look(++sequence);
        EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
        EXPECT_EQ(frames.requests().size(), rendered)
            << "rendered for a browser that cannot take it";
        browser.acknowledge(1);
        EXPECT_EQ(browser.nextFrame()->view_sequence(), sequence);
    }
}

TEST(Viewer, RendersTheNextFrameWhileTheLastIsUnderWay) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    browser.look(2);
    EXPECT_EQ(browser.nextFrame()->view_sequence(), 2u) << "although frame 1 is not acknowledged";
}

TEST(Viewer, HasAsManyFramesDrawnAtOnceAsMayBeUnderWay) {
    FakeFrameSource frames;
    frames.hold(true);
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(frames.waitForRequests(1));
    browser.look(2);
    EXPECT_TRUE(frames.waitForRequests(2)) << "the source decides what it draws at once";
    browser.look(3);
    std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(frames.requests().size(), 2u);
    frames.hold(false);
    std::uint64_t last = 0;
    while (last < 3) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        EXPECT_GT(frame->view_sequence(), last) << "none after a newer one";
        last = frame->view_sequence();
        browser.acknowledge(frame->frame_number());
    }
}

TEST(Viewer, AcknowledgingAFrameAcknowledgesThoseBefore) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    for (std::uint64_t sequence = 1; sequence <= 2; ++sequence) {
        browser.look(sequence);
        ASSERT_TRUE(browser.nextFrame().has_value());
    }
    browser.acknowledge(99);  // never sent
    browser.look(3);
    EXPECT_FALSE(browser.nextFrame(milliseconds(50)).has_value());
    browser.acknowledge(2);
    for (std::uint64_t sequence = 3; sequence <= 4; ++sequence) {
        browser.look(sequence);
        EXPECT_EQ(browser.nextFrame()->view_sequence(), sequence);
    }
}

/// Some noise, whose PNG takes several messages.
coordinator::RenderedFrame noisyFrame(const FrameRequest& request) {
    coordinator::RenderedFrame frame = coordinator::plainFrame(request, {});
    std::uint32_t state = 1;
    for (fabric::Rgba& pixel : frame.image.colour) {
        state = state * 1664525u + 1013904223u;
        pixel = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                 static_cast<std::uint8_t>(state >> 8), 255};
    }
    return frame;
}

TEST(Viewer, SendsARestingViewNearlyExactAndThenExact) {
    FakeFrameSource frames;
    frames.setDraw(noisyFrame);
    SessionOptions options = resting();
    options.restDelay = milliseconds(1000);  // longer than a busy machine takes to draw
    Browser browser(frames, options);
    browser.look(1);
    const auto moved = browser.nextFrame();
    browser.acknowledge(moved->frame_number());
    const auto fine = browser.nextFrame();
    browser.acknowledge(fine->frame_number());
    const auto exact = browser.nextFrame();
    ASSERT_TRUE(moved && fine && exact);
    EXPECT_TRUE(!moved->still() && moved->quality() == 75) << moved->quality();
    EXPECT_TRUE(fine->still() && fine->has_jpeg() && fine->quality() == 95);
    EXPECT_TRUE(exact->still() && exact->has_png());
    EXPECT_EQ(exact->view_sequence(), 1u);
    FrameRequest request;
    request.width = 64;
    request.height = 48;
    EXPECT_EQ(exact->pixel_hash(), fabric::pixelHash(noisyFrame(request).image));
    EXPECT_EQ(exact->picture_bytes(), exact->png().size());
    EXPECT_EQ(frames.requests().size(), 1u) << "the same picture, encoded again";
}

/// A viewer whose exact picture, in several parts, has begun to arrive.
v1::Frame startOfExact(Browser& browser) {
    v1::ViewerRequest request = viewMessage(1, 5);
    request.mutable_view()->set_width(400);
    request.mutable_view()->set_height(300);
    browser.send(request);
    for (;;) {
        v1::Frame frame = *browser.nextFrame();
        if (frame.has_png())
            return frame;
        browser.receiveWhole(frame);
    }
}

TEST(Viewer, SendsAStillPictureInPartsAsTheyArrive) {
    FakeFrameSource frames;
    frames.setDraw(noisyFrame);
    Browser browser(frames, resting());
    v1::Frame exact = startOfExact(browser);
    EXPECT_LT(exact.png().size(), exact.picture_bytes());
    browser.receiveWhole(exact);
    FrameRequest request;
    request.width = 400;
    request.height = 300;
    const auto png = wire::encodePng(noisyFrame(request).image);
    EXPECT_EQ(exact.png(), std::string(reinterpret_cast<const char*>(png->data()), png->size()));
}

TEST(Viewer, SendsNoMoreOfAStillPictureOnceTheViewMoves) {
    FakeFrameSource frames;
    frames.setDraw(noisyFrame);
    Browser browser(frames, resting());
    const v1::Frame exact = startOfExact(browser);
    browser.look(2);
    const auto next = browser.next();
    ASSERT_TRUE(next && next->has_frame()) << "not a part";
    EXPECT_EQ(next->frame().view_sequence(), 2u);
    browser.acknowledge(next->frame().frame_number());
    EXPECT_TRUE(browser.next()->frame().still()) << "nor one later";
}

TEST(Viewer, SendsNoMoreOfAStillPictureOnceTheSceneChanges) {
    FakeFrameSource frames;
    frames.setDraw(noisyFrame);
    Browser browser(frames, resting());
    const v1::Frame exact = startOfExact(browser);
    frames.setDraw([](const FrameRequest& request) {
        return coordinator::plainFrame(request, {90, 120, 60, 255});
    });
    coordinator::Status status = coordinator::readyStatus();
    status.scene.objects[0].name = "dale";
    const std::size_t drawn = frames.requests().size();
    frames.setStatus(status);
    EXPECT_TRUE(eventually([&] { return frames.requests().size() > drawn; })) << "it is too late";
    std::optional<v1::ViewerResponse> next;
    do next = browser.next();
    while (next && next->has_state());
    ASSERT_TRUE(next && next->has_frame()) << "not a part";
    EXPECT_TRUE(next->frame().has_jpeg());
    EXPECT_LT(next->frame().picture_bytes(), exact.picture_bytes() / 10) << "of the new scene";
}

/// What `browser` is given up to the exact picture, all acknowledged; empty where it does not come.
std::vector<v1::Frame> framesUntilExact(Browser& browser) {
    std::vector<v1::Frame> given;
    while (given.empty() || !given.back().has_png()) {
        std::optional<v1::Frame> frame = browser.nextFrame();
        if (!frame)
            return {};
        browser.acknowledge(frame->frame_number());
        given.push_back(*std::move(frame));
    }
    return given;
}

TEST(Viewer, DoesNothingWhileNothingChanges) {
    FakeFrameSource frames;
    Browser browser(frames, resting());
    browser.look(1);
    ASSERT_FALSE(framesUntilExact(browser).empty());
    EXPECT_FALSE(browser.next(milliseconds(300)).has_value());
    EXPECT_EQ(frames.requests().size(), 1u);
    EXPECT_FALSE(browser.viewer().unacknowledgedFor().has_value());
}

TEST(Viewer, GivesThePictureOfAViewAtRestAgainWhenTheSameIsAskedFor) {
    FakeFrameSource frames;
    Browser browser(frames, resting());
    browser.look(1);
    ASSERT_FALSE(framesUntilExact(browser).empty());
    browser.send(viewMessage(2, 1));  // another number, the same view
    const std::vector<v1::Frame> again = framesUntilExact(browser);
    ASSERT_FALSE(again.empty());
    for (const v1::Frame& frame : again) EXPECT_EQ(frame.view_sequence(), 2u);
    EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
    EXPECT_EQ(frames.requests().size(), 1u) << "nothing is drawn for it";
}

TEST(Viewer, ComesToRestWithTwoEyesInOnePicture) {
    FakeFrameSource frames;
    frames.setDraw([](FrameRequest request) {
        using compound::Stereo;
        const Stereo stereo = request.shown.front().stereo;
        request.width *= stereo == Stereo::SideBySide ? 2 : 1;
        request.height *= stereo == Stereo::TopBottom ? 2 : 1;
        return coordinator::plainFrame(request, {90, 120, 60, 255});
    });
    for (const v1::ShownStereo stereo :
         {v1::SHOWN_STEREO_SIDE_BY_SIDE, v1::SHOWN_STEREO_TOP_BOTTOM}) {
        Browser browser(frames, resting());
        v1::ViewerRequest request = viewMessage(1, 1);
        request.mutable_view()->mutable_shown()->set_stereo(stereo);
        const std::size_t before = frames.requests().size();
        browser.send(request);
        bool isExact = false;
        for (int i = 0; i < 5 && !isExact; ++i) {
            const auto frame = browser.nextFrame();
            ASSERT_TRUE(frame.has_value());
            browser.acknowledge(frame->frame_number());
            isExact = frame->has_png();
        }
        EXPECT_TRUE(isExact);
        EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
        EXPECT_LE(frames.requests().size(), before + 1);
    }
}

/// A source whose first `count` frames lack pages, of which `failed` cannot be read.
void lackPages(FakeFrameSource& frames, std::size_t count, std::uint64_t failed) {
    frames.setDraw([&frames, count, failed](const FrameRequest& request) {
        coordinator::RenderedFrame frame = coordinator::plainFrame(request, {});
        frame.statistics.complete = frames.requests().size() > count;
        frame.statistics.pagesMissing = frame.statistics.complete ? 0 : 2;
        frame.statistics.pagesFailed = frame.statistics.complete ? 0 : failed;
        return frame;
    });
}

TEST(Viewer, AsksForFramesThatDoNotWait) {
    FakeFrameSource frames;
    Browser browser(frames, moving(1));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    EXPECT_EQ(frames.requests().front().completeness, fabric::Completeness::Interactive);
    EXPECT_FALSE(frames.requests().front().measuresStages);
}

TEST(Viewer, DrawsOnWhilePagesAreBeingLoadedAndThenRests) {
    FakeFrameSource frames;
    lackPages(frames, 5, 1);
    SessionOptions options = resting();
    options.loadingDelay = milliseconds(1);
    Browser browser(frames, options);
    browser.look(1);
    for (;;) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.acknowledge(frame->frame_number());
        EXPECT_EQ(frame->statistics().pages_missing(), frame->statistics().complete() ? 0u : 2u);
        EXPECT_FALSE(frame->still() && !frame->statistics().complete()) << "it is not its best";
        if (frame->has_png())
            break;
    }
    EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
    EXPECT_EQ(frames.requests().size(), 6u);
}

TEST(Viewer, LooksNowAndThenWhetherWhatCouldNotBeReadCanBe) {
    FakeFrameSource frames;
    lackPages(frames, 1, 2);
    SessionOptions options = resting();
    options.restDelay = milliseconds(1);
    options.loadingDelay = std::chrono::hours(1);
    options.missingDelay = milliseconds(100);
    Browser browser(frames, options);
    browser.look(1);
    bool hadStill = false;
    for (;;) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.acknowledge(frame->frame_number());
        hadStill = hadStill || frame->still();
        if (frame->statistics().complete())
            break;
    }
    EXPECT_TRUE(hadStill) << "what there is deserves its best, too";
}

TEST(Viewer, TellsWhichRenderersDoNotDrawSinceWhenAndWhy) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    coordinator::Status status = coordinator::readyStatus();
    status.renderers.push_back({"renderer-2",
                                {},
                                {},
                                coordinator::RendererCondition::Dead,
                                "no\nheartbeat",
                                std::chrono::system_clock::time_point(std::chrono::seconds(7))});
    frames.setStatus(status);
    EXPECT_TRUE(browser.stateWhere([](const v1::SessionState& state) {
        return state.renderers_size() == 2 &&
               state.renderers(0).condition() == v1::RENDERER_CONDITION_READY &&
               state.renderers(0).alive() && state.renderers(0).since_unix_milliseconds() == 0 &&
               state.renderers(1).condition() == v1::RENDERER_CONDITION_DEAD &&
               !state.renderers(1).alive() && state.renderers(1).why() == "no heartbeat" &&
               state.renderers(1).since_unix_milliseconds() == 7000;
    }));
}

TEST(Viewer, DrawsAgainWhenTheRenderersChange) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    coordinator::Status status = coordinator::readyStatus();
    status.renderers.push_back({"renderer-2", {}, {}});
    frames.setStatus(status);
    EXPECT_TRUE(browser.stateWhere([](const auto& s) { return s.renderers_size() == 2; }));
    EXPECT_TRUE(browser.nextFrame().has_value());
    EXPECT_EQ(frames.requests().size(), 2u);
}

TEST(Viewer, DrawsNothingForARendererThatOpensTheSceneUntilItIsReady) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    coordinator::Status status = coordinator::readyStatus();
    status.renderers.push_back({"renderer-2", {}, {}, coordinator::RendererCondition::Opening});
    frames.setStatus(status);
    EXPECT_TRUE(browser.stateWhere([](const auto& s) { return s.renderers_size() == 2; }));
    EXPECT_EQ(frames.requests().size(), 1u);
    status.renderers.back().condition = coordinator::RendererCondition::Ready;
    frames.setStatus(status);
    EXPECT_TRUE(browser.nextFrame().has_value());
    EXPECT_EQ(frames.requests().size(), 2u);
}

TEST(Viewer, DrawsAgainWhenTheSameSceneIsSetOrTheSameLayoutSeenOtherwise) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    coordinator::Status status = coordinator::readyStatus();
    ++status.displayRevision;
    frames.setStatus(status);
    const auto moved = browser.nextFrame();
    ASSERT_TRUE(moved.has_value()) << "the head has moved";
    browser.acknowledge(moved->frame_number());
    ++status.sceneRevision;
    frames.setStatus(status);
    EXPECT_TRUE(browser.nextFrame().has_value()) << "files were replaced";
    EXPECT_EQ(frames.requests().size(), 3u);
}

TEST(Viewer, TellsWhyThereIsNoFrameAndRecoversByItself) {
    FakeFrameSource frames;
    frames.setDraw([](const FrameRequest&) -> absl::StatusOr<coordinator::RenderedFrame> {
        return absl::UnavailableError("no renderer\x1b[31m\nleft");
    });
    SessionOptions options = moving(2);
    options.retryDelay = milliseconds(20);
    Browser browser(frames, options);
    browser.look(1);
    const auto failed = browser.stateWhere([](const auto& s) { return !s.problem().empty(); });
    ASSERT_TRUE(failed.has_value());
    EXPECT_EQ(failed->problem(), "no renderer [31m left");
    frames.setDraw(
        [](const FrameRequest& request) { return coordinator::plainFrame(request, {}); });
    EXPECT_TRUE(browser.stateWhere([](const auto& s) { return s.problem().empty(); }));
    EXPECT_EQ(browser.nextFrame()->view_sequence(), 1u);
}

TEST(Viewer, RefusesAViewWithoutAPictureAndKeepsTheLast) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.send(viewMessage(1, std::numeric_limits<double>::quiet_NaN()));
    const auto state = browser.stateWhere([](const auto& s) { return !s.problem().empty(); });
    ASSERT_TRUE(state.has_value());
    EXPECT_THAT(state->problem(), HasSubstr("eye"));
    EXPECT_TRUE(frames.requests().empty());
    browser.look(2);
    EXPECT_TRUE(browser.stateWhere([](const auto& s) { return s.problem().empty(); }));
}

TEST(Viewer, ClampsThePictureSize) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    v1::ViewerRequest request = viewMessage(1, 5);
    request.mutable_view()->set_width(-7);
    request.mutable_view()->set_height(1'000'000);
    browser.send(request);
    const auto frame = browser.nextFrame();
    EXPECT_EQ(frame->width(), kMinPictureSide);
    EXPECT_EQ(frame->height(), kMaxPictureSide);
}

TEST(Viewer, CallsForeignBytesAProtocolError) {
    FakeFrameSource frames;
    Browser browser(frames);
    EXPECT_TRUE(absl::IsDataLoss(browser.viewer().receive(bytesOf("\xff\xff\xff not protobuf"))));
    EXPECT_TRUE(absl::IsDataLoss(browser.viewer().receive({})));
}

TEST(Viewer, EndsWhileAFrameIsBeingRendered) {
    FakeFrameSource frames;
    frames.hold(true);
    auto browser = std::make_unique<Browser>(frames, moving(2));
    browser->look(1);
    ASSERT_TRUE(frames.waitForRequests(1));
    browser->viewer().stop();
    std::thread release([&] { frames.hold(false); });
    browser.reset();
    release.join();
    EXPECT_EQ(frames.listenerCount(), 0u);
}

TEST(Sanitised, LeavesOneLineOfValidText) {
    EXPECT_EQ(sanitised("tab\tand \xc3\xa9 and \xff and \xed\xa0\x80"), "tab and é and ? and ???");
    const std::string cut = sanitised(std::string(10'000, 'x'));
    EXPECT_LE(cut.size(), 400u);
    EXPECT_TRUE(cut.ends_with("…"));
}

}  // namespace
}  // namespace eyrie::stream
