// SPDX-License-Identifier: Apache-2.0
// Pictures that come from renderers encoded, for viewers that can show them so.

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/stream/quality.h"
#include "coordinator/stream/sessions.h"
#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/coordinator/viewer_browser.h"
#include "wire/jpeg.h"

namespace eyrie::stream {
namespace {

using coordinator::FakeFrameSource;
using coordinator::FrameRequest;
using coordinator::RenderedFrame;

const Joining kLead{"shared", Role::Lead};
const Joining kWatch{"shared", Role::Watch};

/// An upper and a lower half, encoded where they may be.
RenderedFrame halves(const FrameRequest& request) {
    RenderedFrame frame = coordinator::plainFrame(request, {90, 120, 60, 255});
    if (request.jpegQuality == 0)
        return frame;
    const int cut = request.height / 3;
    for (const auto& [y, height] : {std::pair(0, cut), {cut, request.height - cut}}) {
        const fabric::Image half =
            fabric::makeImage({0, 0, request.width, height}, {90, 120, 60, 255}, false);
        frame.tiles.push_back(
            {{0, y, request.width, height},
             wire::encodeJpeg(half, request.jpegQuality, wire::ChromaSubsampling::Half).value()});
    }
    frame.image.colour.clear();
    return frame;
}

void able(Browser& browser, bool tiles) {
    v1::ViewerRequest request;
    request.mutable_abilities()->set_tiles(tiles);
    browser.send(request);
}

std::size_t bytesOfTiles(const v1::Frame& frame) {
    std::size_t bytes = 0;
    for (const v1::JpegTile& tile : frame.tiles()) bytes += tile.bytes();
    return bytes;
}

TEST(EncodedTiles, GoToAViewerThatShowsThemAsTheyAre) {
    FakeFrameSource frames;
    frames.setDraw(halves);
    Browser browser(frames, moving(2));
    able(browser, true);
    browser.look(1);
    const auto frame = browser.nextFrame();
    ASSERT_TRUE(frame.has_value());
    ASSERT_EQ(frame->tiles_size(), 2);
    EXPECT_EQ(frame->tiles(0).y(), frame->height() - frame->height() / 3);
    EXPECT_EQ(frame->tiles(1).y(), 0);
    EXPECT_EQ(bytesOfTiles(*frame), frame->picture_bytes());
    EXPECT_EQ(frame->quality(), frames.requests().front().jpegQuality);
    EXPECT_EQ(frame->quality(), QualityControl::level(0).quality);
}

TEST(EncodedTiles, AreNotAskedForWhereAViewerDoesNotSayThatItShowsThem) {
    FakeFrameSource frames;
    frames.setDraw(halves);
    Browser browser(frames, moving(2));
    browser.look(1);
    const auto frame = browser.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->tiles_size(), 0);
    EXPECT_EQ(frames.requests().front().jpegQuality, 0);
}

TEST(EncodedTiles, AreNotAskedForWhereOneOfTheViewersDoesNotShowThem) {
    FakeFrameSource frames;
    frames.setDraw(halves);
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    Browser watcher(sessions, kWatch);
    able(leader, true);
    leader.look(1);
    ASSERT_TRUE(leader.nextFrame() && watcher.nextFrame());
    EXPECT_EQ(frames.requests().front().jpegQuality, 0);
    able(watcher, true);
    leader.acknowledge(1);
    watcher.acknowledge(1);
    leader.look(2);
    const auto led = leader.nextFrame();
    const auto seen = watcher.nextFrame();
    ASSERT_TRUE(led && seen);
    EXPECT_EQ(led->tiles_size(), 2);
    EXPECT_EQ(led->jpeg(), seen->jpeg());
}

TEST(EncodedTiles, AreDrawnAnewAtRestAndThenExact) {
    FakeFrameSource frames;
    frames.setDraw(halves);
    Browser browser(frames, resting());
    able(browser, true);
    browser.look(1);
    std::vector<v1::Frame> given;
    while (given.empty() || !given.back().has_png()) {
        auto frame = browser.nextFrame();
        ASSERT_TRUE(frame.has_value());
        browser.receiveWhole(*frame);
        given.push_back(*frame);
    }
    EXPECT_FALSE(given.front().still());
    EXPECT_EQ(given.front().tiles_size(), 2);
    for (std::size_t i = 1; i < given.size(); ++i) EXPECT_EQ(given[i].tiles_size(), 0);
    const std::vector<FrameRequest> requests = frames.requests();
    ASSERT_EQ(requests.size(), 2U);
    EXPECT_GT(requests[0].jpegQuality, 0);
    EXPECT_EQ(requests[1].jpegQuality, 0);
}

TEST(EncodedTiles, AreGivenToWhoCameMeanwhileAndDoesNotShowThemAsOneJpeg) {
    FakeFrameSource frames;
    frames.setDraw(halves);
    Sessions sessions(frames, moving(2));
    Browser leader(sessions, kLead);
    able(leader, true);
    leader.look(1);
    ASSERT_TRUE(leader.nextFrame().has_value());
    Browser late(sessions, kWatch);
    const auto frame = late.nextFrame();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->tiles_size(), 0);
    const auto picture = wire::decodeJpeg(bytesOf(frame->jpeg()));
    ASSERT_TRUE(picture.ok()) << picture.status();
    EXPECT_EQ(picture->area.height, frame->height());
    EXPECT_NEAR(picture->colour.front().g, 120, 6);
}

}  // namespace
}  // namespace eyrie::stream
