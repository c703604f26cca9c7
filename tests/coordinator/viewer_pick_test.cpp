// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "eyrie/v1/pick.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using std::chrono::milliseconds;
using testing::HasSubstr;

v1::ViewerRequest pickMessage(std::uint64_t sequence, double x) {
    v1::ViewerRequest request;
    request.mutable_pick()->set_sequence(sequence);
    v1::PickRequest& pick = *request.mutable_pick()->mutable_request();
    *pick.mutable_camera() = viewMessage(1, 5).view().camera();
    pick.set_view_width(64);
    pick.set_view_height(48);
    pick.set_x(x);
    pick.set_y(20);
    return request;
}

std::optional<v1::ViewerPicked> nextPicked(Browser& browser) {
    while (const std::optional<v1::ViewerResponse> response = browser.next())
        if (response->has_picked())
            return response->picked();
    return std::nullopt;
}

TEST(ViewerPicks, AreAnsweredWhileAFrameIsBeingDrawn) {
    FakeFrameSource frames;
    frames.setPick([](const fabric::PickRequest& request) {
        fabric::PickedPoint point;
        point.worldMetres = {request.place, 7};
        point.elevationMetres = 1234.5;
        return fabric::Picked(point);
    });
    Browser browser(frames);
    frames.hold(true);
    browser.look(1);
    ASSERT_TRUE(frames.waitForRequests(1));
    browser.send(pickMessage(3, 10.5));
    const auto picked = nextPicked(browser);
    ASSERT_TRUE(picked.has_value());
    EXPECT_EQ(picked->sequence(), 3U);
    EXPECT_EQ(picked->point().position().x(), 10.5);
    EXPECT_EQ(picked->point().elevation(), 1234.5);
    EXPECT_EQ(picked->problem(), "");
    frames.hold(false);
}

TEST(ViewerPicks, OfPlacesOutsideThePictureAreAnsweredWithWhatIsWrong) {
    FakeFrameSource frames;
    Browser browser(frames);
    browser.send(pickMessage(4, 65));
    auto picked = nextPicked(browser);
    ASSERT_TRUE(picked.has_value());
    EXPECT_THAT(picked->problem(), HasSubstr("not in the view"));
    EXPECT_FALSE(picked->has_point());
    frames.setPick([](const auto&) { return absl::DataLossError("t.eyt: page 7 is damaged"); });
    browser.send(pickMessage(5, 6));
    picked = nextPicked(browser);
    ASSERT_TRUE(picked.has_value());
    EXPECT_EQ(picked->sequence(), 5U);
    EXPECT_THAT(picked->problem(), HasSubstr("page 7"));
}

TEST(ViewerPicks, ThatWaitAreReplacedByNewerOnes) {
    FakeFrameSource frames;
    Browser browser(frames);
    frames.holdPicks(true);
    browser.send(pickMessage(1, 1));
    ASSERT_TRUE(frames.waitForPicks(1));
    for (std::uint64_t i = 2; i <= 5; ++i) browser.send(pickMessage(i, static_cast<double>(i)));
    frames.holdPicks(false);
    std::uint64_t last = 0;
    while (last != 5) {
        const auto picked = nextPicked(browser);
        ASSERT_TRUE(picked.has_value());
        last = picked->sequence();
    }
    EXPECT_EQ(frames.picks().size(), 2U);
}

v1::ViewerRequest profileMessage(std::uint64_t sequence, int samples) {
    v1::ViewerRequest request;
    v1::ViewerProfile& profile = *request.mutable_profile();
    profile.set_sequence(sequence);
    profile.mutable_from()->set_x(10);
    profile.mutable_to()->set_x(50);
    profile.mutable_to()->set_y(30);
    profile.set_samples(samples);
    return request;
}

std::optional<v1::ViewerProfiled> nextProfiled(Browser& browser) {
    while (const std::optional<v1::ViewerResponse> response = browser.next())
        if (response->has_profiled())
            return response->profiled();
    return std::nullopt;
}

TEST(ViewerProfiles, LookStraightDownAtEvenlySpacedPlaces) {
    FakeFrameSource frames;
    frames.setPick([](const fabric::PickRequest& request) -> absl::StatusOr<fabric::Picked> {
        EXPECT_TRUE(fabric::validate(request).ok());
        EXPECT_EQ(request.camera.eye.x, request.camera.target.x);
        EXPECT_EQ(request.camera.eye.y, request.camera.target.y);
        EXPECT_GT(request.camera.eye.z, 10) << "the scene is 10 m high";
        EXPECT_EQ(request.exaggeration, 1);
        if (request.camera.eye.x > 45)
            return fabric::Picked();
        fabric::PickedPoint point;
        point.worldMetres = {request.camera.eye.x, request.camera.eye.y, 7};
        return fabric::Picked(point);
    });
    Browser browser(frames);
    browser.send(profileMessage(3, 5));
    const auto profiled = nextProfiled(browser);
    ASSERT_TRUE(profiled.has_value());
    EXPECT_EQ(profiled->sequence(), 3U);
    ASSERT_EQ(profiled->samples_size(), 5);
    for (int i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(profiled->samples(i).point().position().x(), 10 + 10 * i);
        EXPECT_DOUBLE_EQ(profiled->samples(i).point().position().y(), 7.5 * i);
    }
    EXPECT_FALSE(profiled->samples(4).has_point()) << "there is nothing";
}

TEST(ViewerProfiles, AreRefusedWithMorePointsThanTheLimit) {
    FakeFrameSource frames;
    Browser browser(frames);
    for (const int samples : {-1, 0, 1, 513, 2'000'000'000}) {
        browser.send(profileMessage(1, samples));
        EXPECT_THAT(nextProfiled(browser)->problem(), HasSubstr("2 to 512"));
    }
    EXPECT_TRUE(frames.picks().empty());
}

TEST(ViewerProfiles, SayThatNoSceneIsOpen) {
    FakeFrameSource frames;
    coordinator::Status opening = coordinator::readyStatus();
    opening.sceneInfo = {};
    frames.setStatus(opening);
    Browser browser(frames);
    browser.send(profileMessage(1, 2));
    EXPECT_THAT(nextProfiled(browser)->problem(), HasSubstr("no scene is open yet"));
    opening.problem = "opening the scene";
    frames.setStatus(opening);
    browser.send(profileMessage(2, 2));
    EXPECT_THAT(nextProfiled(browser)->problem(), HasSubstr("opening the scene"));
    EXPECT_TRUE(frames.picks().empty());
}

TEST(ViewerProfiles, LetPicksGoFirst) {
    FakeFrameSource frames;
    Browser browser(frames);
    frames.holdPicks(true);
    browser.send(profileMessage(1, 100));
    ASSERT_TRUE(frames.waitForPicks(1));
    browser.send(pickMessage(2, 10));
    frames.holdPicks(false);
    ASSERT_TRUE(nextProfiled(browser).has_value());
    EXPECT_EQ(frames.picks()[1].viewWidth, 64) << "the pick, after the profile's first point";
    EXPECT_EQ(frames.picks().size(), 101u);
}

}  // namespace
}  // namespace eyrie::stream
