// SPDX-License-Identifier: Apache-2.0
// One picture for links of different width.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/stream/picture_encoder.h"
#include "coordinator/stream/quality.h"
#include "coordinator/stream/shrink.h"
#include "tests/coordinator/fake_frame_source.h"
#include "wire/jpeg.h"

namespace eyrie::stream {
namespace {

fabric::Image noise(int width, int height) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, {}, false);
    std::minstd_rand random(7);
    for (fabric::Rgba& pixel : image.colour)
        pixel = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                 static_cast<std::uint8_t>(random()), 255};
    return image;
}

/// How much of [begin, begin + 1) lies in [from, to).
double overlap(double begin, double from, double to) {
    return std::max(0.0, std::min(begin + 1, to) - std::max(begin, from));
}

/// The mean over the area of pixel (x, y) of a picture of `width` times `height`.
std::array<double, 3> meanOver(const fabric::Image& image, int x, int y, int width, int height) {
    const double wide = static_cast<double>(image.area.width) / width;
    const double high = static_cast<double>(image.area.height) / height;
    std::array<double, 3> sum{};
    for (int v = 0; v < image.area.height; ++v)
        for (int u = 0; u < image.area.width; ++u) {
            const double weight =
                overlap(u, x * wide, (x + 1) * wide) * overlap(v, y * high, (y + 1) * high);
            const fabric::Rgba& pixel =
                image.colour[static_cast<std::size_t>(v * image.area.width + u)];
            sum[0] += weight * pixel.r;
            sum[1] += weight * pixel.g;
            sum[2] += weight * pixel.b;
        }
    for (double& each : sum) each /= wide * high;
    return sum;
}

TEST(Shrunk, IsTheMeanOverEachPixelsArea) {
    const fabric::Image image = noise(23, 17);
    for (const auto& [width, height] :
         {std::pair{1, 1}, {23, 17}, {12, 9}, {17, 13}, {22, 5}, {7, 16}}) {
        const fabric::Image small = shrunk(image, width, height);
        ASSERT_EQ(small.area, (fabric::PixelViewport{0, 0, width, height}));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const fabric::Rgba& pixel = small.colour[static_cast<std::size_t>(y * width + x)];
                const auto mean = meanOver(image, x, y, width, height);
                EXPECT_NEAR(pixel.r, mean[0], 1) << x << ',' << y << " of " << width;
                EXPECT_NEAR(pixel.g, mean[1], 1);
                EXPECT_NEAR(pixel.b, mean[2], 1);
            }
    }
    EXPECT_TRUE(shrunk(image, 23, 17).colour == image.colour);
}

Picture pictureOf(int width, int height, int level) {
    Picture picture;
    picture.view.frame.width = width;
    picture.view.frame.height = height;
    auto frame = std::make_shared<coordinator::RenderedFrame>();
    frame->image = fabric::makeImage({0, 0, width, height}, {40, 120, 200, 255}, false);
    picture.frame = frame;
    picture.level = level;
    return picture;
}

TEST(EncodePicture, ShrinksForWorseLinksWhatWasDrawnForTheBest) {
    const Picture picture = pictureOf(320, 200, 0);
    for (int level = 0; level < QualityControl::levelCount(); ++level) {
        const auto encoded = encodePicture(picture, {Fineness::Moving, level});
        ASSERT_TRUE(encoded.ok()) << encoded.status();
        const Level& wanted = QualityControl::level(level);
        EXPECT_EQ(encoded->width, std::lround(320 * wanted.scale));
        EXPECT_EQ(encoded->height, std::lround(200 * wanted.scale));
        EXPECT_EQ(encoded->quality, wanted.quality);
        const auto decoded = wire::decodeJpeg(encoded->bytes);
        ASSERT_TRUE(decoded.ok());
        EXPECT_EQ(decoded->area.width, encoded->width);
        EXPECT_NEAR(decoded->colour.front().b, 200, 6);
    }
}

TEST(EncodePicture, LeavesWhatWasDrawnSmallAndWhatIsStillAsItIs) {
    const Picture drawnSmall = [] {
        Picture picture = pictureOf(160, 100, 6);
        picture.view.frame.width = 320;  // asked for
        picture.view.frame.height = 200;
        return picture;
    }();
    const auto worse = encodePicture(drawnSmall, {Fineness::Moving, 8});
    ASSERT_TRUE(worse.ok());
    EXPECT_EQ(worse->width, 160);
    EXPECT_EQ(worse->quality, QualityControl::level(8).quality);
    for (const Fineness fineness : {Fineness::Fine, Fineness::Exact}) {
        const auto still = encodePicture(pictureOf(320, 200, 0), {fineness, 0});
        ASSERT_TRUE(still.ok());
        EXPECT_EQ(still->width, 320);
    }
}

constexpr QualityClass kAsTiles{Fineness::Moving, 2, Codec::Jpeg, 0, true};

/// A left and a right half, which renderers encoded for a level.
Picture pictureOfTiles(int level) {
    Picture picture = pictureOf(320, 200, level);
    auto frame = std::make_shared<coordinator::RenderedFrame>();
    frame->image.area = {0, 0, 320, 200};
    for (const auto& [x, width, blue] : {std::tuple(0, 200, 40), {200, 120, 220}}) {
        const fabric::Image half = fabric::makeImage(
            {0, 0, width, 200}, {90, 90, static_cast<std::uint8_t>(blue), 255}, false);
        frame->tiles.push_back({{x, 0, width, 200},
                                wire::encodeJpeg(half, QualityControl::level(level).quality,
                                                 wire::ChromaSubsampling::Half)
                                    .value()});
    }
    picture.frame = frame;
    return picture;
}

TEST(EncodePicture, TilesThatRenderersEncodedForAClassAreThatClasss) {
    const Picture picture = pictureOfTiles(2);
    const auto encoded = encodePicture(picture, kAsTiles);
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    const auto& tiles = picture.frame->tiles;
    EXPECT_EQ(encoded->tiles, (std::vector<JpegTile>{{0, 0, tiles[0].jpeg.size()},
                                                     {200, 0, tiles[1].jpeg.size()}}));
    std::vector<std::byte> both = tiles[0].jpeg;
    both.insert(both.end(), tiles[1].jpeg.begin(), tiles[1].jpeg.end());
    EXPECT_EQ(encoded->bytes, both);
    EXPECT_EQ(encoded->width, 320);
    EXPECT_EQ(encoded->quality, QualityControl::level(2).quality);
}

TEST(EncodePicture, TilesAreCountedFromTheTop) {
    Picture picture = pictureOfTiles(2);
    auto frame = std::make_shared<coordinator::RenderedFrame>(*picture.frame);
    frame->image.area = {0, 0, 200, 500};
    frame->tiles[0].area = {0, 0, 200, 200};
    frame->tiles[1].area = {0, 200, 200, 300};
    picture.frame = frame;
    const auto encoded = encodePicture(picture, kAsTiles);
    ASSERT_TRUE(encoded.ok());
    EXPECT_EQ(encoded->tiles.at(0).y, 300);
    EXPECT_EQ(encoded->tiles.at(1).y, 0);
}

TEST(EncodePicture, OneTileIsAnOrdinaryJpeg) {
    Picture picture = pictureOfTiles(2);
    auto frame = std::make_shared<coordinator::RenderedFrame>(*picture.frame);
    frame->tiles.pop_back();
    picture.frame = frame;
    const auto encoded = encodePicture(picture, kAsTiles);
    ASSERT_TRUE(encoded.ok());
    EXPECT_TRUE(encoded->tiles.empty());
    EXPECT_EQ(encoded->bytes, frame->tiles.front().jpeg);
}

TEST(EncodePicture, TilesAreDecodedForWorseLinksAndNeverCalledExact) {
    const Picture picture = pictureOfTiles(0);
    const int worst = QualityControl::levelCount() - 1;
    const auto encoded = encodePicture(picture, {Fineness::Moving, worst});
    ASSERT_TRUE(encoded.ok()) << encoded.status();
    EXPECT_TRUE(encoded->tiles.empty());
    EXPECT_LT(encoded->width, 320);
    const auto decoded = wire::decodeJpeg(encoded->bytes);
    ASSERT_TRUE(decoded.ok());
    EXPECT_NEAR(decoded->colour.front().b, 40, 8);
    EXPECT_NEAR(decoded->colour.back().b, 220, 8);
    for (const Fineness fineness : {Fineness::Fine, Fineness::Exact})
        EXPECT_EQ(encodePicture(picture, {fineness, 0}).status().code(),
                  absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace eyrie::stream
