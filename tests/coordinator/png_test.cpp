// SPDX-License-Identifier: Apache-2.0
#include "wire/png.h"

#include <cstdint>

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

TEST(Png, BringsEveryPixelBackBitForBit) {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {1, 200}, {1280, 2}, {320, 200}}) {
        fabric::Image image = noise(width, height);
        const auto bytes = encodePng(image);
        ASSERT_TRUE(bytes.ok()) << bytes.status();
        for (fabric::Rgba& pixel : image.colour) pixel.a = 255;
        EXPECT_EQ(readByLibpng(*bytes), image) << width << "x" << height;
    }
}

TEST(Png, IsSmallWhereThereIsLittle) {
    const auto bytes = encodePng(fabric::makeImage({0, 0, 640, 480}, {1, 2, 3, 255}, false));
    EXPECT_LT(bytes->size(), 10'000u);
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
