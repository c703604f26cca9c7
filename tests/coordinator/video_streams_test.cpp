// SPDX-License-Identifier: Apache-2.0
// H.264 for slow links: when it is chosen, and that whoever is shown a picture of a stream has the
// one that it is made from.
#include "coordinator/stream/video_streams.h"

#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "coordinator/stream/quality.h"
#include "coordinator/stream/sessions.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/fake_video.h"
#include "tests/coordinator/viewer_browser.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using std::chrono::milliseconds;

constexpr double kPixels = 1280 * 720;

Clock::time_point at(int ms) { return Clock::time_point(milliseconds(ms)); }

/// One that knows what frames take.
QualityControl informed() {
    QualityControl quality;
    quality.encoded(0, 52'000, kPixels);
    return quality;
}

TEST(CodecChoice, IsVideoOnceTheLinkHasBeenSlowForAWhile) {
    QualityControl quality = informed();
    for (int time = 0; time < 500; time += 50) {
        quality.adapt(1e6, kPixels, at(time), true);
        EXPECT_EQ(quality.codec(), Codec::Jpeg) << time;
    }
    quality.adapt(1e6, kPixels, at(500), true);
    EXPECT_EQ(quality.codec(), Codec::H264);
    EXPECT_EQ(quality.index(), QualityControl::streamLevel(quality.index()));
}

TEST(CodecChoice, IsNotChangedByAHiccup) {
    QualityControl quality = informed();
    for (int time = 0; time < 5000; time += 50)
        quality.adapt(time % 400 == 0 ? 5e6 : 1e6, kPixels, at(time), true);
    EXPECT_EQ(quality.codec(), Codec::Jpeg);
}

TEST(CodecChoice, StaysBetweenTheTwoRates) {
    QualityControl quality = informed();
    for (int time = 0; time < 5000; time += 50) quality.adapt(25e6 / 8, kPixels, at(time), true);
    EXPECT_EQ(quality.codec(), Codec::Jpeg);
    for (int time = 5000; time < 6000; time += 50) quality.adapt(1e6, kPixels, at(time), true);
    ASSERT_EQ(quality.codec(), Codec::H264);
    for (int time = 6000; time < 12000; time += 50)
        quality.adapt(25e6 / 8, kPixels, at(time), true);
    EXPECT_EQ(quality.codec(), Codec::H264);
    for (int time = 12000; time < 14000; time += 50) {
        quality.adapt(40e6 / 8, kPixels, at(time), true);
        EXPECT_EQ(quality.codec(), Codec::H264) << time;
    }
    quality.adapt(40e6 / 8, kPixels, at(14000), true);
    EXPECT_EQ(quality.codec(), Codec::Jpeg);
}

TEST(CodecChoice, IsJpegForWhoCannotShowVideo) {
    QualityControl quality = informed();
    for (int time = 0; time < 2000; time += 50) quality.adapt(1e6, kPixels, at(time), false);
    EXPECT_EQ(quality.codec(), Codec::Jpeg);
    for (int time = 2000; time < 4000; time += 50) quality.adapt(1e6, kPixels, at(time), true);
    ASSERT_EQ(quality.codec(), Codec::H264);
    quality.adapt(1e6, kPixels, at(4000), false);
    EXPECT_EQ(quality.codec(), Codec::Jpeg);
}

TEST(CodecChoice, ShowsMoreOfAPictureByVideo) {
    QualityControl jpeg = informed();
    QualityControl video = informed();
    for (int time = 0; time < 10'000; time += 50) {
        jpeg.adapt(5e6 / 8, kPixels, at(time), false);
        video.adapt(5e6 / 8, kPixels, at(time), true);
    }
    EXPECT_LT(QualityControl::level(jpeg.index()).scale, 1);
    EXPECT_EQ(QualityControl::level(video.index()).scale, 1);
    EXPECT_EQ(video.jpegIndex(), jpeg.index());
}

fabric::Image picture(int width, int height) {
    return fabric::makeImage({0, 0, width, height}, {}, false);
}

TEST(VideoStreams, GoOnForWhoHasTheLastPicture) {
    FakeVideo module;
    VideoStreams streams(&module);
    EXPECT_TRUE(streams.mayFollow(0, std::nullopt, 1, at(0)));
    const auto first = streams.encode(0, picture(64, 48), 26, true, at(0));
    ASSERT_TRUE(first.ok() && *first);
    EXPECT_TRUE((*first)->place.isKey);
    streams.coded(0, (*first)->place, 1, at(0));
    EXPECT_TRUE(streams.mayFollow(0, std::nullopt, 1, at(1))) << "a key is for everybody";
    EXPECT_TRUE(streams.mayFollow(0, (*first)->place, 2, at(1)));
    EXPECT_FALSE(streams.needsKey(0, (*first)->place));
    const auto second = streams.encode(0, picture(64, 48), 26, false, at(1));
    ASSERT_TRUE(second.ok() && *second);
    EXPECT_FALSE((*second)->place.isKey);
    EXPECT_EQ((*second)->place.picture, 2u);
    streams.coded(0, (*second)->place, 2, at(1));
    EXPECT_TRUE(streams.mayFollow(0, (*first)->place, 2, at(2))) << "it is the next one";
    EXPECT_FALSE(streams.mayFollow(0, (*second)->place, 2, at(2))) << "it has that";
    EXPECT_FALSE(streams.mayFollow(0, std::nullopt, 2, at(2)));
}

TEST(VideoStreams, GiveAKeyToWhoMissedOneAfterASecond) {
    FakeVideo module;
    VideoStreams streams(&module);
    const auto first = streams.encode(0, picture(64, 48), 26, true, at(0));
    ASSERT_TRUE(first.ok() && *first);
    streams.coded(0, (*first)->place, 1, at(0));
    EXPECT_FALSE(streams.mayFollow(0, std::nullopt, 2, at(999)));
    EXPECT_TRUE(streams.needsKey(0, std::nullopt));
    const auto tooSoon = streams.encode(0, picture(64, 48), 26, true, at(999));
    ASSERT_TRUE(tooSoon.ok());
    EXPECT_FALSE(*tooSoon);
    EXPECT_TRUE(streams.mayFollow(0, std::nullopt, 2, at(1000)));
    const auto key = streams.encode(0, picture(64, 48), 26, true, at(1000));
    ASSERT_TRUE(key.ok() && *key);
    EXPECT_TRUE((*key)->place.isKey);
    EXPECT_EQ((*key)->place.stream, (*first)->place.stream);
}

TEST(VideoStreams, BeginAnewWithAnotherSize) {
    FakeVideo module;
    VideoStreams streams(&module);
    const auto first = streams.encode(0, picture(64, 48), 26, true, at(0));
    ASSERT_TRUE(first.ok() && *first);
    const auto tooSoon = streams.encode(0, picture(80, 48), 26, false, at(500));
    EXPECT_TRUE(tooSoon.ok() && !*tooSoon);
    const auto other = streams.encode(0, picture(80, 48), 26, false, at(1500));
    ASSERT_TRUE(other.ok() && *other);
    EXPECT_TRUE((*other)->place.isKey);
    EXPECT_NE((*other)->place.stream, (*first)->place.stream);
}

TEST(VideoStreams, CodeNothingOfASizeThatIsNotForThem) {
    FakeVideo module;
    const VideoStreams streams(&module);
    EXPECT_TRUE(streams.canCode(1280, 720));
    EXPECT_FALSE(streams.canCode(1280, 16));
    EXPECT_FALSE(streams.canCode(4096, 4096));
    EXPECT_FALSE(VideoStreams(nullptr).canCode(1280, 720));
}

/// Of sessions whose every frame is a moving one.
SessionOptions withVideo(const video::Module& module) {
    SessionOptions options = moving(1);
    options.video = &module;
    return options;
}

void tellAbility(Browser& browser, bool h264) {
    v1::ViewerRequest request;
    request.mutable_abilities()->set_h264(h264);
    browser.send(request);
}

/// What comes of a view over a link that holds each message for long enough to look slow, however
/// fast or slow this machine is.
std::optional<v1::Frame> frameOverSlowLink(Browser& browser) {
    auto frame = browser.nextFrame();
    if (!frame)
        return frame;
    std::this_thread::sleep_for(milliseconds(40));
    browser.acknowledge(frame->frame_number());
    return frame;
}

/// Whether a picture can be shown after those that the same browser was sent before.
class Follower {
public:
    bool canShow(const v1::Frame& frame) {
        if (!frame.has_h264())
            return frame.has_jpeg();
        const v1::VideoPlace& place = frame.video();
        const bool isNext =
            place.stream() == last_.stream() && place.picture() == last_.picture() + 1;
        last_ = place;
        return place.key() || isNext;
    }

private:
    v1::VideoPlace last_;
};

constexpr std::uint64_t kManyViews = 400;

/// Views until a picture comes as H.264; the last view's number, or 0 where none does.
std::uint64_t lookUntilVideo(Browser& browser, Follower& follower) {
    for (std::uint64_t view = 1; view <= kManyViews; ++view) {
        browser.look(view);
        const auto frame = frameOverSlowLink(browser);
        if (!frame || !follower.canShow(*frame))
            return 0;
        if (frame->has_h264())
            return view;
    }
    return 0;
}

TEST(SessionVideo, IsSentOverASlowLinkToWhoShowsIt) {
    FakeFrameSource frames;
    const FakeVideo module;
    Browser browser(frames, withVideo(module));
    tellAbility(browser, true);
    Follower follower;
    const std::uint64_t view = lookUntilVideo(browser, follower);
    ASSERT_GT(view, 0u);
    for (std::uint64_t next = view + 1; next < view + 6; ++next) {
        browser.look(next);
        const auto frame = frameOverSlowLink(browser);
        ASSERT_TRUE(frame && frame->has_h264());
        EXPECT_TRUE(follower.canShow(*frame));
        EXPECT_FALSE(frame->video().key());
        EXPECT_EQ(frame->quality(), 0);
        EXPECT_EQ(frame->width(), 64);
    }
    EXPECT_EQ(module.streams, 1);
}

TEST(SessionVideo, IsNotSentToWhoHasNotSaidThatItShowsIt) {
    FakeFrameSource frames;
    const FakeVideo module;
    Browser browser(frames, withVideo(module));
    for (std::uint64_t view = 1; view <= 30; ++view) {
        browser.look(view);
        const auto frame = frameOverSlowLink(browser);
        ASSERT_TRUE(frame && frame->has_jpeg());
    }
    EXPECT_EQ(module.streams, 0);
}

TEST(SessionVideo, IsNotSentToABusyBrowserNearby) {
    FakeFrameSource frames;
    const FakeVideo module;
    Browser browser(frames, withVideo(module));
    tellAbility(browser, true);
    for (std::uint64_t view = 1; view <= 30; ++view) {
        browser.viewer().roundTrip(milliseconds(1));
        browser.look(view);
        const auto frame = frameOverSlowLink(browser);
        ASSERT_TRUE(frame && frame->has_jpeg());
    }
    EXPECT_EQ(module.streams, 0);
}

TEST(SessionVideo, EndsWithThePictureAfterWhichABrowserSaysThatItFailed) {
    FakeFrameSource frames;
    const FakeVideo module;
    Browser browser(frames, withVideo(module));
    tellAbility(browser, true);
    Follower follower;
    const std::uint64_t view = lookUntilVideo(browser, follower);
    ASSERT_GT(view, 0u);
    tellAbility(browser, false);
    for (std::uint64_t next = view + 1; next < view + 6; ++next) {
        browser.look(next);
        const auto frame = frameOverSlowLink(browser);
        ASSERT_TRUE(frame && frame->has_jpeg());
        EXPECT_GT(frame->quality(), 0);
    }
}

TEST(SessionVideo, EndsWhereTheEncoderFails) {
    FakeFrameSource frames;
    FakeVideo module;
    Browser browser(frames, withVideo(module));
    tellAbility(browser, true);
    Follower follower;
    const std::uint64_t view = lookUntilVideo(browser, follower);
    ASSERT_GT(view, 0u);
    module.isBroken = true;
    for (std::uint64_t next = view + 1; next < view + 6; ++next) {
        browser.look(next);
        const auto frame = frameOverSlowLink(browser);
        ASSERT_TRUE(frame && frame->has_jpeg());
    }
}

TEST(SessionVideo, IsOneStreamForViewersOfOnePace) {
    FakeFrameSource frames;
    const FakeVideo module;
    Sessions sessions(frames, withVideo(module));
    Browser leader(sessions, {"shared", Role::Lead});
    Browser watcher(sessions, {"shared", Role::Watch});
    tellAbility(leader, true);
    tellAbility(watcher, true);
    Follower ofLeader;
    Follower ofWatcher;
    bool haveBoth = false;
    for (std::uint64_t view = 1; view <= kManyViews && !haveBoth; ++view) {
        leader.look(view);
        const auto led = leader.nextFrame();
        const auto watched = watcher.nextFrame();
        ASSERT_TRUE(led && watched);
        EXPECT_TRUE(ofLeader.canShow(*led));
        EXPECT_TRUE(ofWatcher.canShow(*watched));
        haveBoth = led->has_h264() && led->h264() == watched->h264() &&
                   led->video().picture() == watched->video().picture();
        std::this_thread::sleep_for(milliseconds(40));
        watcher.acknowledge(watched->frame_number());
        leader.acknowledge(led->frame_number());
    }
    EXPECT_TRUE(haveBoth);
    EXPECT_EQ(module.streams, 1);
}

TEST(SessionVideo, CanBeShownByWhoLeavesOutPictures) {
    FakeFrameSource frames;
    const FakeVideo module;
    Sessions sessions(frames, withVideo(module));
    Browser leader(sessions, {"shared", Role::Lead});
    Browser watcher(sessions, {"shared", Role::Watch});
    tellAbility(leader, true);
    tellAbility(watcher, true);
    Follower ofLeader;
    Follower ofWatcher;
    int videos = 0;
    for (std::uint64_t view = 1; view <= 60; ++view) {
        leader.look(view);
        const auto frame = frameOverSlowLink(leader);
        ASSERT_TRUE(frame);
        EXPECT_TRUE(ofLeader.canShow(*frame));
        videos += frame->has_h264() ? 1 : 0;
        if (view % 3 != 0)
            continue;
        const auto watched = frameOverSlowLink(watcher);
        ASSERT_TRUE(watched);
        EXPECT_TRUE(ofWatcher.canShow(*watched));
    }
    EXPECT_GT(videos, 0);
}

}  // namespace
}  // namespace eyrie::stream
