// SPDX-License-Identifier: Apache-2.0
#include "renderer/mesh/image_codec.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/mesh/vertex_packing.h"

namespace eyrie::mesh {
namespace {

using fabric::Rgba;

TEST(ImageCodec, KeepsSmoothImagesOfAnySizeWithinTheErrorThatItSays) {
    for (const ImageShape& shape :
         {ImageShape{1, 1, 0}, {3, 5, kHasAlpha}, {64, 33, 0}, {17, 128, kHasAlpha}, {256, 1, 0}}) {
        std::vector<Rgba> texels;
        for (std::uint32_t y = 0; y < shape.height; ++y)
            for (std::uint32_t x = 0; x < shape.width; ++x)
                texels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(2 * y),
                                  120, static_cast<std::uint8_t>(255 - y)});
        const Image image = encodeImage(shape, texels);
        ASSERT_EQ(image.blocks.size(), shape.bytesFrom(0));
        EXPECT_LT(image.shape.rmsError, 3);
        const std::vector<Rgba> coded = decodeLevel(image.shape, image.blocks, 0);
        double ofColours = 0, ofAlpha = 0;
        for (std::uint32_t y = 0; y < shape.height; ++y)
            for (std::uint32_t x = 0; x < shape.width; ++x) {
                const Rgba& a = texels[y * shape.width + x];
                const Rgba& b = coded[y * ((shape.width + 3) / 4 * 4) + x];
                for (const auto& [own, other] :
                     {std::pair(a.r, b.r), std::pair(a.g, b.g), std::pair(a.b, b.b)})
                    ofColours += std::pow(own - other, 2) / 3;
                ofAlpha += shape.hasAlpha() ? std::pow(a.a - b.a, 2) : 0;
            }
        EXPECT_NEAR(image.shape.rmsError,
                    std::sqrt(std::max(ofColours, ofAlpha) / static_cast<double>(texels.size())),
                    1e-4);
    }
}

/// Palettes, of which each triangle shows one texel.
TEST(ImageCodec, KeepsTheColoursOfEachTexelOfSmallImages) {
    std::mt19937 random(7);
    for (const ImageShape& shape :
         {ImageShape{8, 8, 0}, {64, 64, kHasAlpha}, {2, 2, 0}, {5, 3, kClampsU}}) {
        std::vector<Rgba> texels(std::size_t{shape.width} * shape.height);
        for (Rgba& texel : texels)
            texel = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                     static_cast<std::uint8_t>(random()), 255};
        const Image image = encodeImage(shape, texels);
        ASSERT_EQ(image.shape.width, 4 * shape.width);
        ASSERT_EQ(image.shape.height, 4 * shape.height);
        EXPECT_EQ(image.shape.flags, shape.flags);
        ASSERT_EQ(image.blocks.size(), image.shape.bytesFrom(0));
        EXPECT_LT(image.shape.rmsError, 2);
        const std::vector<Rgba> coded = decodeLevel(image.shape, image.blocks, 0);
        for (std::size_t i = 0; i < coded.size(); ++i) {
            const Rgba& own = texels[i / (16 * shape.width) * shape.width + i / 4 % shape.width];
            EXPECT_NEAR(coded[i].r, own.r, 4);
            EXPECT_NEAR(coded[i].g, own.g, 4);
            EXPECT_NEAR(coded[i].b, own.b, 4);
        }
    }
}

/// What is smooth, or large, is filtered as its source would be.
TEST(ImageCodec, EnlargesOnlySmallImagesThatLoseByCoding) {
    std::mt19937 random(7);
    std::vector<Rgba> ramp, noise;
    for (int i = 0; i < 64; ++i)
        ramp.push_back(
            {static_cast<std::uint8_t>(4 * i), 0, static_cast<std::uint8_t>(255 - i), 255});
    for (int i = 0; i < 65 * 4; ++i)
        noise.push_back({static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                         static_cast<std::uint8_t>(random()), 255});
    EXPECT_EQ(encodeImage({64, 1, 0}, ramp).shape.width, 64U);
    EXPECT_EQ(encodeImage({65, 4, 0}, noise).shape.width, 65U);
}

/// A leaf of noise in a corner of what else lets all through.
TEST(ImageCodec, ErrorsAreOfTexelsThatShow) {
    const auto errorOf = [](std::uint32_t side) {
        std::mt19937 random(5);
        std::vector<Rgba> texels(std::size_t{side} * side, Rgba{0, 0, 0, 0});
        for (std::uint32_t y = 0; y < 32; ++y)
            for (std::uint32_t x = 0; x < 32; ++x)
                texels[y * side + x] = {static_cast<std::uint8_t>(random()),
                                        static_cast<std::uint8_t>(random()),
                                        static_cast<std::uint8_t>(random()), 255};
        return encodeImage({side, side, kHasAlpha}, std::move(texels)).shape.rmsError;
    };
    EXPECT_GT(errorOf(96), 20);
    EXPECT_NEAR(errorOf(256), errorOf(96), 1e-4);
}

/// By squares, by area where a side is odd, and by alpha.
TEST(ImageCodec, CoarserTexelsAreMeansOfWhatTheyCover) {
    const auto coarsest = [](std::uint32_t width, std::uint32_t flags, std::vector<Rgba> texels) {
        const auto height = static_cast<std::uint32_t>(texels.size()) / width;
        return unpackColour(
            encodeImage({width, height, flags}, std::move(texels)).shape.meanColour);
    };
    const Rgba white{255, 255, 255, 255}, black{0, 0, 0, 255}, clear{0, 0, 0, 0};
    EXPECT_EQ(coarsest(2, 0, {white, black}), (Rgba{180, 180, 180, 255}));
    EXPECT_EQ(coarsest(3, 0, {white, black, black}), (Rgba{147, 147, 147, 255}));
    EXPECT_EQ(coarsest(3, 0, {white, white, white, black, black, black}),
              (Rgba{180, 180, 180, 255}));
    EXPECT_EQ(coarsest(2, kHasAlpha, {white, clear}), (Rgba{255, 255, 255, 128}));
    EXPECT_EQ(coarsest(2, 0, {white, clear}), (Rgba{180, 180, 180, 255}));
    EXPECT_EQ(coarsest(2, kHasAlpha, {{100, 0, 0, 0}, {100, 0, 0, 0}}), (Rgba{100, 0, 0, 0}));
}

TEST(ImageCodec, DecodesAnyBlocks) {
    std::mt19937 engine(3);
    for (const ImageShape& shape : {ImageShape{7, 9, kHasAlpha}, {5, 2, 0}}) {
        std::vector<std::byte> blocks(shape.bytesFrom(0));
        for (int round = 0; round < 200; ++round) {
            for (std::byte& byte : blocks) byte = static_cast<std::byte>(engine());
            for (std::uint32_t level = 0; level < shape.levels(); ++level)
                EXPECT_EQ(decodeLevel(shape, blocks, level).size() % 16, 0U);
        }
    }
}

}  // namespace
}  // namespace eyrie::mesh
