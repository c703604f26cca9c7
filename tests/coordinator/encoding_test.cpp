// SPDX-License-Identifier: Apache-2.0
// One picture for links of different width.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>

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

}  // namespace
}  // namespace eyrie::stream
