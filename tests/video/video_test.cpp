// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/video/decoded.h"
#include "video/load.h"

namespace eyrie::video {
namespace {

const Module& module() {
    static const auto kModule = load();
    EXPECT_TRUE(kModule.ok()) << kModule.status();
    return **kModule;
}

TEST(VideoStream, ShowsEachPictureAtOnceAndAsItWas) {
    auto stream = module().makeStream({160, 96, 20});
    ASSERT_TRUE(stream.ok()) << stream.status();
    Decoder decoder;
    for (int time = 0; time < 12; ++time) {
        const fabric::Image image = movingPicture(160, 96, time);
        const auto picture = (*stream)->encode(image, false);
        ASSERT_TRUE(picture.ok()) << picture.status();
        EXPECT_EQ(picture->isKey, time == 0);
        const Frame frame = decoder.decode(picture->bytes);
        ASSERT_NE(frame, nullptr) << "of picture " << time;

        EXPECT_EQ(frame->colorspace, AVCOL_SPC_BT709);
        EXPECT_EQ(frame->color_range, AVCOL_RANGE_MPEG);
        EXPECT_GT(psnr(*frame, image), 30) << "of picture " << time;
    }
}

TEST(VideoStream, IsWorseAndSmallerAtAHigherRateFactor) {
    std::array<std::size_t, 2> bytes{};
    std::array<double, 2> decibels{};
    for (std::size_t i = 0; i < 2; ++i) {
        auto stream = module().makeStream({160, 96, i == 0 ? 18 : 36});
        ASSERT_TRUE(stream.ok()) << stream.status();
        Decoder decoder;
        for (int time = 0; time < 6; ++time) {
            const fabric::Image image = movingPicture(160, 96, time);
            const auto picture = (*stream)->encode(image, false);
            ASSERT_TRUE(picture.ok()) << picture.status();
            bytes[i] += picture->bytes.size();
            const Frame frame = decoder.decode(picture->bytes);
            ASSERT_NE(frame, nullptr);
            decibels[i] = psnr(*frame, image);
        }
    }
    EXPECT_GT(bytes[0], bytes[1]);
    EXPECT_GT(decibels[0], decibels[1]);
}

TEST(VideoStream, CanBeJoinedAtAKey) {
    auto stream = module().makeStream({160, 96, 24});
    ASSERT_TRUE(stream.ok()) << stream.status();
    for (int time = 0; time < 3; ++time)
        ASSERT_TRUE((*stream)->encode(movingPicture(160, 96, time), false).ok());
    const fabric::Image image = movingPicture(160, 96, 3);
    const auto key = (*stream)->encode(image, true);
    ASSERT_TRUE(key.ok()) << key.status();
    EXPECT_TRUE(key->isKey);
    Decoder decoder;
    const Frame frame = decoder.decode(key->bytes);
    ASSERT_NE(frame, nullptr);
    EXPECT_GT(psnr(*frame, image), 28);
}

TEST(VideoStream, RepeatsTheLastColumnAndRowOfOddSides) {
    auto stream = module().makeStream({61, 47, 16});
    ASSERT_TRUE(stream.ok()) << stream.status();
    const fabric::Image image = movingPicture(61, 47, 5);
    const auto picture = (*stream)->encode(image, false);
    ASSERT_TRUE(picture.ok()) << picture.status();
    Decoder decoder;
    const Frame frame = decoder.decode(picture->bytes);
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->width, 62);
    EXPECT_EQ(frame->height, 48);
    EXPECT_GT(psnr(*frame, image), 28);
}

TEST(VideoStream, RefusesWhatItCannotCode) {
    EXPECT_TRUE(absl::IsInvalidArgument(module().makeStream({8, 64, 24}).status()));
    EXPECT_TRUE(absl::IsInvalidArgument(module().makeStream({4096, 4096, 24}).status()));
    auto stream = module().makeStream({64, 64, 24});
    ASSERT_TRUE(stream.ok()) << stream.status();
    EXPECT_TRUE(
        absl::IsInvalidArgument((*stream)->encode(movingPicture(64, 48, 0), false).status()));
}

/// A file in memory, as a MovieSink fills it.
struct MemoryFile {
    std::vector<std::byte> bytes;

    MovieSink sink() {
        return [this](std::uint64_t offset, std::span<const std::byte> part) {
            bytes.resize(std::max<std::size_t>(bytes.size(), offset + part.size()));
            std::copy(part.begin(), part.end(),
                      bytes.begin() + static_cast<std::ptrdiff_t>(offset));
            return absl::OkStatus();
        };
    }
};

TEST(Movie, IsWrittenInEveryFormat) {
    for (const std::string ending : {"mp4", "mkv", "webm"}) {
        MemoryFile file;
        auto movie = module().makeMovie({ending, 64, 48, 25}, file.sink());
        ASSERT_TRUE(movie.ok()) << movie.status();
        for (int time = 0; time < 5; ++time)
            ASSERT_TRUE((*movie)->add(movingPicture(64, 48, time)).ok());
        EXPECT_FALSE((*movie)->add(movingPicture(48, 48, 5)).ok());
        ASSERT_TRUE((*movie)->finish().ok()) << ending;
        const std::string path = testing::TempDir() + "eyrie_video_test." + ending;
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(file.bytes.data()),
                   static_cast<std::streamsize>(file.bytes.size()));
        const std::vector<Frame> frames = framesOfFile(path);
        std::remove(path.c_str());
        ASSERT_EQ(frames.size(), 5u) << ending;
        for (int time = 0; time < 5; ++time)
            EXPECT_GT(psnr(*frames[static_cast<std::size_t>(time)], movingPicture(64, 48, time)),
                      28)
                << ending << ", picture " << time;
    }
}

TEST(Movie, TellsWhatItsFileSaid) {
    auto movie =
        module().makeMovie({"mkv", 64, 48, 25}, [](std::uint64_t, std::span<const std::byte>) {
            return absl::Status(absl::ResourceExhaustedError("the disk is full"));
        });
    absl::Status status = movie.status();
    for (int time = 0; time < 5 && status.ok(); ++time)
        status = (*movie)->add(movingPicture(64, 48, time));
    if (status.ok())
        status = (*movie)->finish();
    EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
}

TEST(Movie, RefusesOddSidesAndOtherFormats) {
    const auto refused = [](const MovieSettings& settings) {
        MemoryFile file;
        return absl::IsInvalidArgument(module().makeMovie(settings, file.sink()).status());
    };
    EXPECT_TRUE(refused({"mp4", 63, 48, 25}));
    EXPECT_TRUE(refused({"mp4", 64, 48, 0}));
    EXPECT_TRUE(refused({"avi", 64, 48, 25}));
    EXPECT_FALSE(refused({"mp4", 64, 48, 25}));
}

}  // namespace
}  // namespace eyrie::video
