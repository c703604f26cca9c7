// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer.h"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/stream/home_camera.h"
#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "wire/jpeg.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using coordinator::FrameRequest;
using std::chrono::milliseconds;
using testing::HasSubstr;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text));
}

v1::ViewerRequest viewMessage(std::uint64_t sequence, double eyeX) {
    v1::ViewerRequest request;
    v1::ViewRequest& view = *request.mutable_view();
    view.set_sequence(sequence);
    view.set_width(64);
    view.set_height(48);
    view.set_tau_pixels(1);
    for (const double value : {eyeX, -10.0, 3.0}) view.mutable_camera()->add_eye(value);
    for (int i = 0; i < 3; ++i) view.mutable_camera()->add_target(0);
    return request;
}

/// The browser's end of a viewer.
class Browser {
public:
    explicit Browser(FakeFrameSource& frames, const ViewerOptions& options = {})
        : viewer_(
              frames, [this] { ready(); }, options) {}

    void send(const v1::ViewerRequest& request) {
        ASSERT_TRUE(viewer_.receive(bytesOf(request.SerializeAsString())).ok());
    }

    void look(std::uint64_t sequence) {
        send(viewMessage(sequence, static_cast<double>(sequence)));
    }

    void acknowledge(std::uint64_t frameNumber) {
        v1::ViewerRequest request;
        request.mutable_frame_ack()->set_frame_number(frameNumber);
        send(request);
    }

    /// The next message within `patience`.
    std::optional<v1::ViewerResponse> next(milliseconds patience = milliseconds(10'000)) {
        const auto deadline = Clock::now() + patience;
        for (;;) {
            if (std::optional<std::string> bytes = viewer_.takeMessage(); bytes.has_value()) {
                v1::ViewerResponse response;
                EXPECT_TRUE(response.ParseFromString(*bytes));
                return response;
            }
            std::unique_lock lock(mutex_);
            if (!changed_.wait_until(lock, deadline, [this] { return isReady_; }))
                return std::nullopt;
            isReady_ = false;
        }
    }

    std::optional<v1::Frame> nextFrame(milliseconds patience = milliseconds(10'000)) {
        for (;;) {
            const std::optional<v1::ViewerResponse> response = next(patience);
            if (!response.has_value())
                return std::nullopt;
            if (response->has_frame())
                return response->frame();
        }
    }

    /// The next state for which `isWanted`; none after ten seconds.
    template <typename Predicate>
    std::optional<v1::SessionState> stateWhere(Predicate isWanted) {
        for (;;) {
            const std::optional<v1::ViewerResponse> response = next();
            if (!response.has_value())
                return std::nullopt;
            if (response->has_state() && isWanted(response->state()))
                return response->state();
        }
    }

    Viewer& viewer() { return viewer_; }

private:
    void ready() {
        {
            const std::lock_guard lock(mutex_);
            isReady_ = true;
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    bool isReady_ = false;
    Viewer viewer_;  // last: it calls ready() until it is gone
};

/// Never comes to rest, so that every frame is a moving one.
ViewerOptions moving(int framesInFlight) {
    ViewerOptions options;
    options.framesInFlight = framesInFlight;
    options.restDelay = std::chrono::hours(1);
    return options;
}

ViewerOptions resting() {
    ViewerOptions options;
    options.framesInFlight = 2;
    options.restDelay = milliseconds(50);
    return options;
}

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
    ViewerOptions options = resting();
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

TEST(Viewer, SendsARestingViewOnceMoreAtItsBest) {
    FakeFrameSource frames;
    Browser browser(frames, resting());
    browser.look(1);
    const auto moved = browser.nextFrame();
    const auto still = browser.nextFrame();
    ASSERT_TRUE(moved.has_value() && still.has_value());
    EXPECT_FALSE(moved->still());
    EXPECT_TRUE(still->still());
    EXPECT_EQ(still->view_sequence(), 1u);
    EXPECT_GT(still->frame_number(), moved->frame_number());
    EXPECT_EQ(frames.requests().size(), 1u) << "the same picture, encoded again";
}

TEST(Viewer, DoesNothingWhileNothingChanges) {
    FakeFrameSource frames;
    Browser browser(frames, resting());
    browser.look(1);
    browser.acknowledge(browser.nextFrame()->frame_number());
    browser.acknowledge(browser.nextFrame()->frame_number());
    browser.send(viewMessage(2, 1));  // another number, the same view
    EXPECT_FALSE(browser.next(milliseconds(300)).has_value());
    EXPECT_EQ(frames.requests().size(), 1u);
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
    ViewerOptions options = resting();
    options.loadingDelay = milliseconds(1);
    Browser browser(frames, options);
    browser.look(1);
    for (;;) {
        const auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.acknowledge(frame->frame_number());
        EXPECT_EQ(frame->statistics().pages_missing(), frame->statistics().complete() ? 0u : 2u);
        EXPECT_FALSE(frame->still() && !frame->statistics().complete()) << "it is not its best";
        if (frame->still())
            break;
    }
    EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
    EXPECT_EQ(frames.requests().size(), 6u);
}

TEST(Viewer, LooksNowAndThenWhetherWhatCouldNotBeReadCanBe) {
    FakeFrameSource frames;
    lackPages(frames, 1, 2);
    ViewerOptions options = resting();
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

TEST(Viewer, DrawsAgainWhenTheRenderersChange) {
    FakeFrameSource frames;
    Browser browser(frames, moving(2));
    browser.look(1);
    ASSERT_TRUE(browser.nextFrame().has_value());
    coordinator::Status status = coordinator::readyStatus();
    status.renderers.push_back({"renderer-2", {}, true});
    frames.setStatus(status);
    EXPECT_TRUE(browser.stateWhere([](const auto& s) { return s.renderers_size() == 2; }));
    EXPECT_TRUE(browser.nextFrame().has_value());
    EXPECT_EQ(frames.requests().size(), 2u);
}

TEST(Viewer, TellsWhyThereIsNoFrameAndRecoversByItself) {
    FakeFrameSource frames;
    frames.setDraw([](const FrameRequest&) -> absl::StatusOr<coordinator::RenderedFrame> {
        return absl::UnavailableError("no renderer\x1b[31m\nleft");
    });
    ViewerOptions options = moving(2);
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

/// A plateau of 100 m around the origin, under the cameras that viewMessage makes.
coordinator::Status plateauStatus() {
    fabric::GroundGrid plateau;
    plateau.worldFromGrid[0] = {200, 0, 0, 0};
    plateau.worldFromGrid[1] = {0, 200, 0, 0};
    plateau.worldFromGrid[3] = {-100, -100, 0, 1};
    plateau.columns = plateau.rows = 1;
    plateau.highest = {100};
    coordinator::Status status = coordinator::readyStatus();
    status.sceneInfo.ground = std::make_shared<const std::vector<fabric::GroundGrid>>(1, plateau);
    return status;
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
    EXPECT_FALSE(browser.nextFrame()->has_lifted_camera());
    EXPECT_EQ(frames.requests().back().look.exaggeration, -2);
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
    EXPECT_EQ(fast->statistics().tau_achieved(), 4);
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
    EXPECT_FALSE(browser.nextFrame(milliseconds(100)).has_value());
    ASSERT_EQ(frames.requests().size(), 2u);
    EXPECT_EQ(frames.requests()[0].budgetMilliseconds, 33);
    EXPECT_FALSE(frames.requests()[1].budgetMilliseconds.has_value());
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

TEST(HomeCamera, SeesEveryCornerOfTheSceneInA4By3Picture) {
    const fabric::Box boxes[] = {{{0, 0, 0}, {1, 1, 1}},
                                 {{-5000, -3000, 200}, {5000, 3000, 1400}},
                                 {{4e6, 5e6, 0}, {4e6 + 10, 5e6 + 1000, 1}},
                                 {{7, 7, 7}, {7, 7, 7}},
                                 {{0, 0, -1000}, {1, 1, 1000}}};
    for (const fabric::Box& box : boxes) {
        const fabric::Camera camera = homeCamera(box);
        ASSERT_TRUE(fabric::validate(camera).ok()) << fabric::validate(camera);
        EXPECT_LT(camera.eye.x, box.centre().x);  // from the west
        EXPECT_LT(camera.eye.y, box.centre().y);  // and south
        EXPECT_GT(camera.eye.z, box.centre().z);
        const double tan = std::tan(glm::radians(camera.fovYDegrees / 2));
        for (int i = 0; i < 8; ++i) {
            const fabric::Vec3 p =
                fabric::viewFromWorldRotation(camera) * (box.corner(i) - camera.eye);
            EXPECT_LE(std::abs(p.y), -p.z * tan);
            EXPECT_LE(std::abs(p.x), -p.z * tan * 4 / 3);
        }
    }
}

/// A link and a browser: frames are started as the pacer allows and each stage takes its time.
int windowAfter(milliseconds render, milliseconds transmit, milliseconds roundTrip) {
    Pacer pacer;
    Clock::time_point renderFree{};
    Clock::time_point linkFree{};
    std::deque<std::pair<std::uint64_t, Clock::time_point>> acks;
    Clock::time_point now{};
    for (std::uint64_t frame = 1; frame <= 200; ++frame) {
        while (static_cast<int>(acks.size()) >= pacer.window()) {
            now = std::max(now, acks.front().second);
            pacer.acknowledged(acks.front().first, acks.front().second);
            acks.pop_front();
        }
        const Clock::time_point started = std::max(now, renderFree);
        renderFree = started + render;
        now = renderFree;
        pacer.rendered(render);
        pacer.sent(frame, started, true);
        linkFree = std::max(linkFree, renderFree) + transmit;
        acks.emplace_back(frame, linkFree + roundTrip);
    }
    return pacer.window();
}

TEST(Pacer, LetsInAsManyFramesAsKeepTheSlowestStageBusy) {
    EXPECT_EQ(windowAfter(milliseconds(25), milliseconds(1), milliseconds(8)), 2);    // loopback
    EXPECT_EQ(windowAfter(milliseconds(30), milliseconds(20), milliseconds(50)), 4);  // 20 Mbit/s
    EXPECT_EQ(windowAfter(milliseconds(30), milliseconds(80), milliseconds(50)), 2);  // 5 Mbit/s
    EXPECT_EQ(windowAfter(milliseconds(5), milliseconds(1), milliseconds(300)), 4);   // the limit
}

}  // namespace
}  // namespace eyrie::stream
