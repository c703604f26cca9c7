// SPDX-License-Identifier: Apache-2.0
#include "wire/png.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <gtest/gtest.h>
#include <png.h>

#include "fabric/pixel_hash.h"

namespace eyrie::wire {
namespace {

fabric::Image noise(int width, int height) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, {}, false);
    std::uint32_t state = 7;
    for (fabric::Rgba& pixel : image.colour) {
        state = state * 1664525u + 1013904223u;
        pixel = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
                 static_cast<std::uint8_t>(state >> 28), static_cast<std::uint8_t>(state >> 8)};
    }
    return image;
}

/// What libpng reads, opaque.
fabric::Image readByLibpng(const std::vector<std::byte>& bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) << png.message;
    EXPECT_EQ(png.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
    EXPECT_EQ(png.warning_or_error, 0u) << png.message;
    png.format = PNG_FORMAT_RGBA;
    fabric::Image image = fabric::makeImage(
        {0, 0, static_cast<int>(png.width), static_cast<int>(png.height)}, {}, false);
    // A negative stride has libpng put the file's first row, the top one, last.
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.colour.data(),
                                      -static_cast<png_int_32>(png.width * 4), nullptr))
        << png.message;
    return image;
}

/// Few values in grey, which come again in twos and threes everywhere.
fabric::Image greyNoise(int width, int height) {
    fabric::Image image = noise(width, height);
    for (fabric::Rgba& pixel : image.colour) {
        const auto grey = static_cast<std::uint8_t>(pixel.r / 16 * 16);
        pixel = {grey, grey, grey, 255};
    }
    return image;
}

fabric::Image slopes(int width, int height) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, {}, false);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        const std::size_t x = i % static_cast<std::size_t>(width);
        const std::size_t y = i / static_cast<std::size_t>(width);
        image.colour[i] = {static_cast<std::uint8_t>(x / 3), static_cast<std::uint8_t>(y / 2),
                           static_cast<std::uint8_t>(x + y), 255};
    }
    return image;
}

fabric::Image flat(int width, int height) {
    return fabric::makeImage({0, 0, width, height}, {1, 2, 3, 255}, false);
}

/// Fails where libpng does not read what was drawn.
void expectExact(fabric::Image image, const char* what) {
    const auto bytes = encodePng(image);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    for (fabric::Rgba& pixel : image.colour) pixel.a = 255;
    EXPECT_EQ(readByLibpng(*bytes), image)
        << what << ", " << image.area.width << "x" << image.area.height;
}

TEST(Png, BringsEveryPixelBackBitForBit) {
    constexpr std::pair<int, int> kSizes[] = {{1, 1},     {2, 1},     {1, 2},     {3, 2},
                                              {7, 3},     {1, 5000},  {1280, 2},  {87, 400},
                                              {320, 200}, {401, 333}, {16384, 13}};
    for (const auto& [width, height] : kSizes) {
        expectExact(noise(width, height), "noise");
        expectExact(greyNoise(width, height), "grey noise");
        expectExact(slopes(width, height), "slopes");
        expectExact(flat(width, height), "one colour");
    }
}

/// The guess of a byte is the nearest of three, however they lie to each other.
TEST(Png, BringsEveryCornerOfFourBack) {
    constexpr int kLevels[] = {0, 1, 2, 127, 128, 129, 254, 255};
    fabric::Image image = fabric::makeImage({0, 0, 128, 64}, {}, false);
    for (std::size_t i = 0; i < 8 * 8 * 8 * 8; ++i) {
        const auto level = [&](std::size_t digit) {
            return static_cast<std::uint8_t>(kLevels[i >> 3 * digit & 7]);
        };
        const std::size_t at = i / 64 % 32 * 256 + i % 64 * 2;
        image.colour[at] = {level(0), level(1), level(2), 255};
        image.colour[at + 1] = {level(1), level(2), level(3), 255};
        image.colour[at + 128] = {level(2), level(3), level(0), 255};
        image.colour[at + 129] = {level(3), level(0), level(1), 255};
    }
    expectExact(image, "corners");
}

/// Deflate reaches 32768 bytes back, which is 10922 pixels and two thirds.
TEST(Png, TakesNothingFromFartherAwayThanDeflateReaches) {
    for (const std::size_t apart : {10922u, 10923u}) {
        fabric::Image image = flat(16384, 1);
        const fabric::Image piece = noise(20, 1);
        std::copy(piece.colour.begin(), piece.colour.end(), image.colour.begin() + 100);
        std::copy(piece.colour.begin(), piece.colour.end(),
                  image.colour.begin() + 100 + static_cast<std::ptrdiff_t>(apart));
        expectExact(image, "a piece that comes again");
    }
}

TEST(Png, IsTheSameByBandsAsAtOnce) {
    constexpr int kWidth = 1000, kHeight = 250;  // three blocks
    const fabric::Image image = greyNoise(kWidth, kHeight);
    PngWriter writer(kWidth, kHeight, PngColours::Unsaid);
    std::vector<std::byte> bytes;
    for (int top = kHeight, rows = 1; top > 0; top -= rows, rows = std::min(3 * rows, top)) {
        fabric::Image band = fabric::makeImage({0, top - rows, kWidth, rows}, {}, false);
        std::copy_n(image.colour.begin() + std::ptrdiff_t{kWidth} * (top - rows),
                    band.colour.size(), band.colour.begin());
        writer.append(band, bytes);
    }
    EXPECT_EQ(bytes, *encodePng(image));
}

TEST(Png, SaysThatColoursAreSrgbWhereAsked) {
    fabric::Image image = slopes(300, 20);
    PngWriter writer(300, 20, PngColours::Srgb);
    std::vector<std::byte> bytes;
    writer.append(image, bytes);
    EXPECT_EQ(readByLibpng(bytes), image);
    EXPECT_EQ(bytes[33 + 4], std::byte{'s'});
    EXPECT_EQ(bytes.size(), encodePng(image)->size() + 13);
}

TEST(Png, IsSmallWhereThereIsLittle) {
    EXPECT_LT(encodePng(flat(640, 480))->size(), 10'000u);
    EXPECT_LT(encodePng(slopes(640, 480))->size(), 20'000u);
    EXPECT_LT(encodePng(greyNoise(640, 480))->size(), 640u * 480u) << "4 bits a pixel, twice";
}

TEST(Png, GrowsLittleWhereNothingComesAgain) {
    EXPECT_LT(encodePng(noise(640, 480))->size(), 640u * 480u * 3u * 101 / 100);
}

TEST(Png, IsTheSameBytesEachTime) {
    EXPECT_EQ(*encodePng(greyNoise(401, 333)), *encodePng(greyNoise(401, 333)));
}

TEST(Png, RefusesWhatIsNoPicture) {
    EXPECT_TRUE(absl::IsInvalidArgument(encodePng({}).status()));
    fabric::Image image = noise(4, 4);
    image.colour.pop_back();
    EXPECT_TRUE(absl::IsInvalidArgument(encodePng(image).status()));
}

TEST(PixelHash, TellsPicturesWithOneOtherPixelApart) {
    const fabric::Image image = noise(33, 17);
    const std::uint32_t hash = fabric::pixelHash(image);
    for (std::size_t i = 0; i < image.colour.size(); ++i) {
        fabric::Image other = image;
        other.colour[i].g ^= 1u;
        EXPECT_NE(fabric::pixelHash(other), hash);
        other.colour[i] = image.colour[i];
        other.colour[i].a ^= 1u;
        EXPECT_EQ(fabric::pixelHash(other), hash) << "alpha is not sent";
    }
}

/// The page's test has the same numbers.
TEST(PixelHash, IsTheOneThatThePageKnows) {
    fabric::Image image = fabric::makeImage({0, 0, 2, 2}, {}, false);
    image.colour = {{1, 2, 3, 255}, {4, 5, 6, 255}, {250, 128, 0, 255}, {255, 255, 255, 255}};
    EXPECT_EQ(fabric::pixelHash(image), 1337354147u);
}

}  // namespace
}  // namespace eyrie::wire
