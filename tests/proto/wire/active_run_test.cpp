// SPDX-License-Identifier: Apache-2.0
#include "wire/active_run.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "wire/transport.h"

namespace eyrie::wire {
namespace {

using fabric::Image;
using fabric::PixelViewport;
using Bands = std::vector<std::string>;

Bands encode(const Image& image) {
    Bands bands;
    for (BandEncoder encoder(image); !encoder.isDone();) encoder.next(bands.emplace_back());
    return bands;
}

std::size_t sizeOf(const Bands& bands) {
    std::size_t size = 0;
    for (const std::string& band : bands) size += band.size();
    return size;
}

/// With pixels that are not the picture's, to see that each is written.
Image blank(const PixelViewport& area, bool hasDepth) {
    Image image = fabric::makeImage(area, {1, 2, 3, 4}, hasDepth);
    std::fill(image.depth.begin(), image.depth.end(), -7.0F);
    return image;
}

absl::StatusOr<Image> decode(const Bands& bands, const PixelViewport& area, bool hasDepth) {
    Image image = blank(area, hasDepth);
    BandDecoder decoder(image);
    for (const std::string& band : bands)
        if (const absl::Status status = decoder.take(band); !status.ok())
            return status;
    EXPECT_TRUE(decoder.isDone());
    return image;
}

bool isSame(const Image& one, const Image& other) {
    const auto equal = [](const auto& a, const auto& b) {
        return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
    };
    return one.area == other.area && equal(one.colour, other.colour) &&
           equal(one.depth, other.depth);
}

bool comesBack(const Image& image) {
    const absl::StatusOr<Image> decoded = decode(encode(image), image.area, image.hasDepth());
    return decoded.ok() && isSame(*decoded, image);
}

/// Runs of every kind of pixel: nothing, any bits, smooth surfaces, all kinds of odd numbers.
Image oddPicture(const PixelViewport& area, bool hasDepth, std::uint32_t seed) {
    constexpr std::array<std::uint32_t, 7> kOdd = {0x7fc00001, 0xffffffff, 0x80000000, 0x00000001,
                                                   0x7f800000, 0xff800000, 0x3f800000};
    std::mt19937 twister(seed);
    const auto random = [&] { return static_cast<std::uint32_t>(twister()); };
    Image image = fabric::makeImage(area, {9, 8, 7, 6}, hasDepth);
    for (std::size_t i = 0; i < image.colour.size();) {
        const std::uint32_t kind = random() % 4;
        const std::uint32_t start = random();
        const std::uint32_t slope = random() % 64;
        const std::size_t end =
            std::min<std::size_t>(image.colour.size(), i + 1 + random() % (2U << random() % 9));
        for (; i < end && kind != 0; ++i) {
            const std::uint32_t bits = kind == 1   ? random()
                                       : kind == 2 ? start + slope * static_cast<std::uint32_t>(i)
                                                   : kOdd[random() % kOdd.size()];
            image.colour[i] = std::bit_cast<fabric::Rgba>(bits | (kind == 2 ? 0xff000000U : 0));
            if (hasDepth)
                image.depth[i] = std::bit_cast<float>(bits);
        }
        i = end;
    }
    return image;
}

/// A ball seen from nearby, reversed depth and shades of grey, in a picture that is half full.
Image ball(int width, int height) {
    Image image = fabric::makeImage({0, 0, width, height}, {}, true);
    const double radius = std::sqrt(0.5 * width * height / M_PI);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = (x - 0.5 * width) / radius;
            const double v = (y - 0.5 * height) / radius;
            const double w = std::sqrt(std::max(0.0, 1 - u * u - v * v));
            if (w == 0)
                continue;
            const auto i = static_cast<std::size_t>(y * width + x);
            const auto shade = static_cast<std::uint8_t>(40 + 200 * w);
            image.colour[i] = {shade, shade, static_cast<std::uint8_t>(shade / 2), 255};
            image.depth[i] = static_cast<float>(0.01 / (3 - w));
        }
    return image;
}

RC_GTEST_PROP(ActiveRun, AnyPictureComesBackToTheBit, (std::uint32_t seed, bool hasDepth)) {
    const PixelViewport area{*rc::gen::inRange(0, 9), *rc::gen::inRange(0, 9),
                             *rc::gen::inRange(1, 300), *rc::gen::inRange(1, 9)};
    RC_ASSERT(comesBack(oddPicture(area, hasDepth, seed)));
}

TEST(ActiveRun, PicturesOfAnyShapeComeBackToTheBit) {
    EXPECT_TRUE(comesBack(oddPicture({0, 0, 16384, 40}, true, 1)));
    EXPECT_TRUE(comesBack(oddPicture({5, 0, 1, 16384}, true, 2)));
    EXPECT_TRUE(comesBack(oddPicture({16383, 16383, 1, 1}, false, 3)));
    EXPECT_TRUE(comesBack(oddPicture({3, 4, 513, 700}, true, 4)));
    EXPECT_TRUE(comesBack(fabric::makeImage({0, 0, 640, 360}, {1, 2, 3, 4}, true)));
    EXPECT_TRUE(comesBack(ball(320, 180)));
    EXPECT_TRUE(BandEncoder(Image{}).isDone());
    Image none;
    EXPECT_TRUE(BandDecoder(none).isDone());
}

TEST(ActiveRun, NothingDrawnTakesTwoBytesARow) {
    EXPECT_EQ(sizeOf(encode(fabric::makeImage({0, 0, 1000, 100}, {1, 2, 3, 4}, true))),
              12U + 100 * 2);
}

TEST(ActiveRun, APictureHalfFullOfASmoothSurfaceTakesLessThanAFifth) {
    EXPECT_LT(sizeOf(encode(ball(1280, 720))), 1280U * 720 * 8 / 5);
}

TEST(ActiveRun, NoiseTakesNoMoreThanItsPixelsAndAHeader) {
    Image noise = fabric::makeImage({0, 0, 700, 500}, {}, true);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < noise.colour.size(); ++i) {
        noise.colour[i] = std::bit_cast<fabric::Rgba>(static_cast<std::uint32_t>(random()));
        noise.depth[i] = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    }
    const Bands bands = encode(noise);
    EXPECT_LE(sizeOf(bands), 700U * 500 * 8 + bands.size() * kBandOverheadBytes);
    EXPECT_TRUE(comesBack(noise));
}

TEST(ActiveRun, ABandHasAChunkOfPixelsAtMost) {
    for (const std::string& band : encode(oddPicture({0, 0, 1280, 720}, true, 7)))
        EXPECT_LE(band.size(), kChunkBytes + kBandOverheadBytes);
    EXPECT_EQ(encode(fabric::makeImage({0, 0, 16384, 9}, {}, true)).size(), 2U);
}

/// Bands that were damaged are refused or give other pixels; they touch no memory but the picture's
/// (which the sanitizers see) and never hang.
RC_GTEST_PROP(ActiveRun, DamagedBandsDoNoHarm, (std::uint32_t seed, bool hasDepth)) {
    const PixelViewport area{0, 0, *rc::gen::inRange(1, 200), *rc::gen::inRange(1, 6)};
    Bands bands = encode(oddPicture(area, hasDepth, seed));
    std::string& band = bands.front();
    if (*rc::gen::inRange(0, 4) == 0)
        band.resize(*rc::gen::inRange<std::size_t>(0, band.size()));
    for (int flips = *rc::gen::inRange(0, 4); flips > 0 && !band.empty(); --flips)
        band[*rc::gen::inRange<std::size_t>(0, band.size())] = *rc::gen::arbitrary<char>();
    Image image = blank(area, hasDepth);
    const absl::Status status = BandDecoder(image).take(band);
    RC_ASSERT(status.ok() || absl::IsDataLoss(status));
    RC_ASSERT(static_cast<std::int64_t>(image.colour.size()) == area.area());
}

RC_GTEST_PROP(ActiveRun, BytesThatAreNoBandDoNoHarm, (std::string bytes)) {
    Image image = blank({0, 0, 20, 3}, true);
    const absl::Status status = BandDecoder(image).take(bytes);
    RC_ASSERT(status.ok() || absl::IsDataLoss(status));
}

std::string refusal(std::string band) {
    Image image = blank({0, 0, 64, 2}, true);
    const absl::Status status = BandDecoder(image).take(band);
    EXPECT_TRUE(absl::IsDataLoss(status));
    return std::string(status.message());
}

TEST(ActiveRun, WhatIsWrongWithABandIsSaid) {
    const std::string band = encode(ball(64, 2)).front();
    const auto with = [&](std::size_t at, char value) {
        std::string changed = band;
        changed[at] = value;
        return changed;
    };
    using testing::HasSubstr;
    EXPECT_THAT(refusal("abc"), HasSubstr("3 bytes, too few for a header"));
    EXPECT_THAT(refusal(with(2, 3)), HasSubstr("3 rows, where 2 are left"));
    EXPECT_THAT(refusal(with(2, 0)), HasSubstr("0 rows"));
    EXPECT_THAT(refusal(with(0, 9)), HasSubstr("form is 9"));
    EXPECT_THAT(refusal(with(0, 0)), HasSubstr("have 1024 bytes, not"));
    EXPECT_THAT(refusal(with(11, 1)), HasSubstr("its blocks have"));
    EXPECT_THAT(refusal(with(12, 15)), HasSubstr("bytes of 15"));
    EXPECT_THAT(refusal(with(14, 33)), HasSubstr("depths of 33"));
    EXPECT_THAT(refusal(band.substr(0, band.size() - 1)), HasSubstr("ends amid runs"));
    EXPECT_THAT(refusal(band + "x"), HasSubstr("1 bytes follow its last row"));
}

}  // namespace
}  // namespace eyrie::wire
