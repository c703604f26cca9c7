// SPDX-License-Identifier: Apache-2.0
#include "wire/jpeg.h"

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace eyrie::wire {
namespace {

using testing::HasSubstr;

/// Smooth in both directions, bright at the top (the last rows), red to the right.
fabric::Image gradient(int width, int height) {
    fabric::Image image = fabric::makeImage({0, 0, width, height}, {}, false);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image.colour[static_cast<std::size_t>(y * width + x)] = {
                static_cast<std::uint8_t>(255 * x / width),
                static_cast<std::uint8_t>(255 * y / height), 40, 255};
    return image;
}

int worstDifference(const fabric::Image& a, const fabric::Image& b) {
    int worst = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i) {
        worst = std::max(worst, std::abs(a.colour[i].r - b.colour[i].r));
        worst = std::max(worst, std::abs(a.colour[i].g - b.colour[i].g));
        worst = std::max(worst, std::abs(a.colour[i].b - b.colour[i].b));
    }
    return worst;
}

TEST(Jpeg, BringsAPictureBackTheSameWayUp) {
    const fabric::Image image = gradient(130, 67);  // no multiple of a block
    for (const auto subsampling : {ChromaSubsampling::Half, ChromaSubsampling::None}) {
        const auto bytes = encodeJpeg(image, 95, subsampling);
        ASSERT_TRUE(bytes.ok()) << bytes.status();
        const auto back = decodeJpeg(*bytes);
        ASSERT_TRUE(back.ok()) << back.status();
        EXPECT_EQ(back->area, image.area);
        // Quality 95 of a smooth picture stays within a few levels; upside down it would be 200.
        EXPECT_LE(worstDifference(image, *back), 12);
    }
}

TEST(Jpeg, SpendsMoreBytesOnHigherQuality) {
    const fabric::Image image = gradient(320, 200);
    EXPECT_LT(encodeJpeg(image, 75, ChromaSubsampling::Half)->size(),
              encodeJpeg(image, 95, ChromaSubsampling::None)->size());
}

TEST(Jpeg, KeepsColourEdgesOnlyWithoutSubsampling) {
    fabric::Image stripes = fabric::makeImage({0, 0, 64, 64}, {255, 0, 0, 255}, false);
    for (std::size_t i = 0; i < stripes.colour.size(); i += 2) stripes.colour[i] = {0, 0, 255, 255};
    const auto difference = [&](ChromaSubsampling subsampling) {
        return worstDifference(stripes, *decodeJpeg(*encodeJpeg(stripes, 95, subsampling)));
    };
    EXPECT_LE(difference(ChromaSubsampling::None), 40);
    EXPECT_GE(difference(ChromaSubsampling::Half), 90);
}

TEST(Jpeg, RefusesWhatIsNoImage) {
    fabric::Image image = gradient(8, 8);
    EXPECT_THAT(encodeJpeg({}, 75, ChromaSubsampling::Half).status().ToString(), HasSubstr("0x0"));
    EXPECT_FALSE(encodeJpeg(image, 0, ChromaSubsampling::Half).ok());
    EXPECT_FALSE(encodeJpeg(image, 101, ChromaSubsampling::Half).ok());
    image.colour.pop_back();
    EXPECT_THAT(encodeJpeg(image, 75, ChromaSubsampling::Half).status().ToString(),
                HasSubstr("63 pixels of colour"));
}

TEST(Jpeg, RefusesTruncatedAndForeignBytes) {
    const std::vector<std::byte> bytes = *encodeJpeg(gradient(64, 64), 75, ChromaSubsampling::Half);
    for (std::size_t size = 0; size < bytes.size() - 2; size += 7)
        EXPECT_FALSE(decodeJpeg(std::span(bytes).first(size)).ok()) << size;
    EXPECT_FALSE(decodeJpeg(std::vector<std::byte>(100, std::byte{'x'})).ok());
}

}  // namespace
}  // namespace eyrie::wire
