// SPDX-License-Identifier: Apache-2.0
// How pictures get from a renderer to who asked for them.
#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <span>
#include <vector>

#include <gmock/gmock.h>

#include "render_server_fixture.h"
#include "wire/frame.h"
#include "wire/jpeg.h"
#include "wire/picture_header.h"

namespace eyrie::service {
namespace {

using coordinator::ChannelRenderer;
using RenderAnswersTest = RenderServerTest;

TEST_F(RenderAnswersTest, APictureOfTwentyMegabytesArrivesAsItWasDrawn) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const fabric::ChannelTask large = task(2000, 1300, true);
    const auto result = renderer_->render(large, soon());
    ASSERT_TRUE(result.ok()) << result.status();
    const fabric::ChannelResult expected = FakeDrawer::picture(frameData(), large);
    EXPECT_TRUE(arrivedIn(*result) == expected.image);
    EXPECT_EQ(result->statistics, expected.statistics);
}

TEST_F(RenderAnswersTest, ChunksAreOfOneMebibyteAtMost) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(1000, 700, true));
    grpc::ClientContext context;
    const auto reader = stub_->RenderChannel(&context, request);
    v1::RenderChannelResponse part;
    ASSERT_TRUE(reader->Read(&part));
    EXPECT_EQ(part.header().pixel_bytes(), 1000U * 700 * 8);
    std::size_t bytes = 0;
    while (reader->Read(&part)) {
        EXPECT_LE(part.chunk().size(), wire::kChunkBytes);
        bytes += part.chunk().size();
    }
    EXPECT_EQ(bytes, 1000U * 700 * 8);
    EXPECT_TRUE(reader->Finish().ok());
}

/// Expected are the pixels of what was drawn and, beside it, the scene's background, within what a
/// JPEG changes.
TEST_F(RenderAnswersTest, AChannelComesAsAJpegOfAllOfItWhereItIsWantedSo) {
    fabric::Scene scene;
    scene.background = {200, 100, 0, 255};
    ASSERT_TRUE(renderer_->openScene(scene, soon()).ok());
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->image = fabric::makeImage({40, 30, 100, 60}, {10, 20, 230, 255}, false);
    fabric::ChannelTask asked = task(320, 200, false);
    asked.pixelViewport = {20, 10, 250, 150};
    asked.jpegQuality = 90;
    const auto result = renderer_->render(asked, soon());
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->image.area, control_->image->area);
    const auto picture = wire::decodeJpeg(result->jpeg);
    ASSERT_TRUE(picture.ok()) << picture.status();
    ASSERT_EQ(picture->area, (fabric::PixelViewport{0, 0, 250, 150}));
    const auto at = [&](int x, int y) {
        return picture->colour[static_cast<std::size_t>((y - 10) * 250 + x - 20)];
    };
    for (const auto& [x, y] : {std::pair(25, 15), {200, 150}, {90, 110}})
        EXPECT_NEAR(at(x, y).r, 200, 4) << x << ',' << y;
    EXPECT_NEAR(at(90, 60).b, 230, 4);
    EXPECT_NEAR(at(60, 40).r, 10, 4);
}

TEST_F(RenderAnswersTest, AJpegOfDepthIsRefused) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    fabric::ChannelTask asked = task(64, 48, true);
    asked.jpegQuality = 90;
    const absl::Status status = renderer_->render(asked, soon()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("a JPEG has no depth"));
}

using HardCase24 = RenderServerTest;

/// Any bits at all, also such that are no number, less than none or next to none.
fabric::Image noise(const fabric::PixelViewport& area, std::uint32_t seed) {
    std::mt19937 random(seed);
    fabric::Image image = fabric::makeImage(area, {}, true);
    constexpr std::array<std::uint32_t, 6> kOdd = {0x7fc00000, 0xffffffff, 0x80000000,
                                                   0x00000001, 0x7f800000, 0xff800000};
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        image.colour[i] = std::bit_cast<fabric::Rgba>(static_cast<std::uint32_t>(random()));
        image.depth[i] = std::bit_cast<float>(i % 3 == 0 ? kOdd[random() % kOdd.size()]
                                                         : static_cast<std::uint32_t>(random()));
    }
    return image;
}

/// Every other pixel of `image` as nothing that was drawn.
fabric::Image checkered(fabric::Image image) {
    for (std::size_t i = 0; i < image.colour.size(); ++i)
        if ((i % static_cast<std::size_t>(image.area.width) +
             i / static_cast<std::size_t>(image.area.width)) %
                2 ==
            0) {
            image.colour[i] = {};
            image.depth[i] = 0;
        }
    return image;
}

/// Expected is what was drawn, to the bit: colour and depth, as active runs, and colour alone, over
/// a Unix socket, raw, and over TCP; and in memory, where it fits.
TEST_F(HardCase24, WhateverBitsWereDrawnArriveInPicturesOfAnyShape) {
    const auto overTcp = RenderServer::start("127.0.0.1:0", *thread_).value();
    const auto far = coordinator::connectRenderer(overTcp->address(), {}, nullptr, false);
    const auto near = coordinator::connectRenderer(server_->address(), {}, nullptr, false);
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    ASSERT_TRUE(far->setFrameData(frameData(), soon()).ok());
    for (const fabric::Image& drawn :
         {noise({0, 0, 640, 360}, 1), noise({0, 0, 16384, 1}, 2), noise({7, 0, 1, 16384}, 3),
          noise({16383, 16383, 1, 1}, 4), checkered(noise({3, 5, 511, 257}, 5)),
          fabric::makeImage({0, 0, 640, 360}, {9, 8, 7, 6}, true),
          // A chunk's bytes of colour, and four more.
          noise({0, 0, 512, 512}, 6), noise({0, 0, 37, 7085}, 7), fabric::Image{}}) {
        control_->image = drawn;
        fabric::ChannelTask whole = task(16384, 16384, true);
        if (!drawn.area.isEmpty())
            whole.pixelViewport = drawn.area;
        const auto isSame = [](const auto& one, const auto& other) {
            return std::ranges::equal(std::as_bytes(std::span(one)),
                                      std::as_bytes(std::span(other)));
        };
        for (ChannelRenderer* renderer : {renderer_.get(), near.get(), far.get()})
            for (const auto& [wantsDepth, usesRoom] :
                 {std::pair(true, false), {false, false}, {true, true}, {false, true}}) {
                control_->usesRoom = usesRoom;
                whole.wantsDepth = wantsDepth;
                if (!wantsDepth)
                    control_->image->depth.clear();
                const auto arrived = renderer->render(whole, soon());
                ASSERT_TRUE(arrived.ok()) << arrived.status();
                const fabric::Image picture = arrivedIn(*arrived);
                EXPECT_EQ(picture.area, drawn.area);
                EXPECT_TRUE(isSame(picture.colour, drawn.colour));
                EXPECT_TRUE(isSame(picture.depth, control_->image->depth));
                control_->image = drawn;
            }
    }
}

TEST_F(RenderAnswersTest, WhetherAPictureCameInMemoryOrMessagesIsCounted) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto telemetry = std::make_shared<observe::Telemetry>();
    for (const bool offersMemory : {true, false})
        ASSERT_TRUE(coordinator::connectRenderer(server_->address(), {}, telemetry, offersMemory)
                        ->render(task(640, 360, true), soon())
                        .ok());
    const std::string text = telemetry->metrics.text({}, {});
    EXPECT_THAT(text, testing::HasSubstr("eyrie_renderer_pictures_total{way=\"memory\"} 1"));
    EXPECT_THAT(text, testing::HasSubstr("eyrie_renderer_pictures_total{way=\"messages\"} 1"));
}

/// Expected is the message form of what could not go into memory.
TEST_F(RenderAnswersTest, MemoryThatIsNotThereIsAnsweredInMessages) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    const auto memory = wire::PictureMemory::create(64 * 64 * 4).value();
    v1::RenderChannelRequest request;
    *request.mutable_task() = wire::toMessage(task(64, 64, false));
    *request.mutable_memory() = wire::toMessage(memory->offer());
    const auto answer = [&] {
        grpc::ClientContext context;
        const auto reader = stub_->RenderChannel(&context, request);
        v1::RenderChannelResponse part;
        EXPECT_TRUE(reader->Read(&part));
        const bool isInMemory = part.header().is_in_memory();
        std::size_t bytes = 0;
        while (reader->Read(&part)) bytes += part.chunk().size();
        EXPECT_TRUE(reader->Finish().ok());
        EXPECT_EQ(bytes, isInMemory ? 0U : 64U * 64 * 4);
        return isInMemory;
    };
    EXPECT_TRUE(answer());
    EXPECT_TRUE(fabric::copied(memory->picture({0, 0, 64, 64}, false).value()) ==
                FakeDrawer::picture(frameData(), task(64, 64, false)).image);
    request.mutable_memory()->set_bytes(64 * 64 * 4 + 1);
    EXPECT_FALSE(answer());
    *request.mutable_memory() = wire::toMessage(memory->offer());
    request.mutable_memory()->set_key(std::string(32, 'x'));
    EXPECT_FALSE(answer());
    const auto small = wire::PictureMemory::create(64 * 64 * 4 - 1).value();
    *request.mutable_memory() = wire::toMessage(small->offer());
    EXPECT_FALSE(answer());
}

TEST_F(RenderAnswersTest, PixelsDrawnIntoTheMemoryAreInItAndThoseThatDoNotFitAreInMessages) {
    ASSERT_TRUE(renderer_->setFrameData(frameData(), soon()).ok());
    control_->usesRoom = true;
    const fabric::Image drawn = FakeDrawer::picture(frameData(), task(64, 64, true)).image;
    for (const bool fits : {true, false}) {
        const auto memory = wire::PictureMemory::create(64 * 64 * 8 - (fits ? 0 : 1)).value();
        v1::RenderChannelRequest request;
        *request.mutable_task() = wire::toMessage(task(64, 64, true));
        *request.mutable_memory() = wire::toMessage(memory->offer());
        grpc::ClientContext context;
        const auto reader = stub_->RenderChannel(&context, request);
        v1::RenderChannelResponse part;
        ASSERT_TRUE(reader->Read(&part));
        EXPECT_EQ(part.header().is_in_memory(), fits);
        EXPECT_TRUE(part.header().has_depth());
        std::size_t bytes = 0;
        while (reader->Read(&part)) bytes += part.chunk().size();
        EXPECT_TRUE(reader->Finish().ok());
        EXPECT_EQ(bytes, fits ? 0U : 64U * 64 * 8);
        if (fits) {
            EXPECT_TRUE(fabric::copied(memory->picture(drawn.area, true).value()) == drawn);
        }
    }
}
}  // namespace
}  // namespace eyrie::service
