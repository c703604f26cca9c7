// SPDX-License-Identifier: Apache-2.0
#include "wire/jpeg.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wire/jpeg_halves.h"

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

/// The picture's first rows, from below.
fabric::Image rowsOf(const fabric::Image& image, int begin, int end) {
    const int width = image.area.width;
    fabric::Image part = fabric::makeImage({0, 0, width, end - begin}, {}, false);
    std::copy_n(image.colour.begin() + static_cast<std::ptrdiff_t>(begin) * width,
                part.colour.size(), part.colour.begin());
    return part;
}

std::size_t restartsIn(std::span<const std::byte> jpeg) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 1 < jpeg.size(); ++i)
        if (jpeg[i] == std::byte{0xFF} && (jpeg[i + 1] & std::byte{0xF8}) == std::byte{0xD0})
            ++count;
    return count;
}

TEST(Jpeg, IsOfTwoHalvesThatNeedNothingOfEachOther) {
    const fabric::Image image = gradient(700, 301);
    const auto bytes = encodeJpeg(image, 95, ChromaSubsampling::None);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    EXPECT_EQ(restartsIn(*bytes), 1u);
    const fabric::Image back = *decodeJpeg(*bytes);
    ASSERT_EQ(back.area, image.area);
    // Of 38 rows of blocks the upper half has 19.
    constexpr int kCut = 301 - 19 * 8;
    for (const auto& [begin, end] : {std::pair(0, kCut), std::pair(kCut, 301)}) {
        const fabric::Image alone = rowsOf(image, begin, end);
        const auto encoded = encodeJpeg(alone, 95, ChromaSubsampling::None);
        ASSERT_TRUE(encoded.ok()) << encoded.status();
        EXPECT_EQ(worstDifference(*decodeJpeg(*encoded), rowsOf(back, begin, end)), 0) << begin;
    }
}

TEST(Jpeg, HasNoSeamBetweenItsHalves) {
    for (const auto& [width, height] : {std::pair(1280, 720), std::pair(333, 241)}) {
        const fabric::Image image = gradient(width, height);
        const auto bytes = encodeJpeg(image, 95, ChromaSubsampling::Half);
        ASSERT_TRUE(bytes.ok()) << bytes.status();
        EXPECT_EQ(restartsIn(*bytes), 1u);
        EXPECT_LE(worstDifference(image, *decodeJpeg(*bytes)), 12);
    }
}

TEST(Jpeg, IsWholeWhereHalvesWouldBeSmallOrHaveMoreBlocksThanCanBeCounted) {
    const auto restarts = [](int width, int height) {
        return restartsIn(*encodeJpeg(gradient(width, height), 75, ChromaSubsampling::None));
    };
    EXPECT_EQ(restarts(255, 256), 0u);
    EXPECT_EQ(restarts(256, 256), 1u);
    // Of 8188 blocks a row, nine rows are too many.
    EXPECT_EQ(restarts(65500, 128), 1u);
    EXPECT_EQ(restarts(65500, 129), 0u);
}

TEST(Jpeg, JoinsOnlyHalvesThatWereMadeAlike) {
    const std::vector<std::byte> half = *encodeJpeg(gradient(64, 32), 75, ChromaSubsampling::Half);
    const std::vector<std::byte> finer = *encodeJpeg(gradient(64, 32), 95, ChromaSubsampling::Half);
    EXPECT_TRUE(joined(half, half, 64, 8).ok());
    EXPECT_THAT(joined(half, finer, 64, 8).status().ToString(), HasSubstr("different tables"));
    for (std::size_t size = 0; size < half.size(); ++size)
        EXPECT_FALSE(joined(half, std::span(half).first(size), 64, 8).ok()) << size;
}

TEST(Jpeg, RefusesTruncatedAndForeignBytes) {
    const std::vector<std::byte> bytes = *encodeJpeg(gradient(64, 64), 75, ChromaSubsampling::Half);
    for (std::size_t size = 0; size < bytes.size() - 2; size += 7)
        EXPECT_FALSE(decodeJpeg(std::span(bytes).first(size)).ok()) << size;
    EXPECT_FALSE(decodeJpeg(std::vector<std::byte>(100, std::byte{'x'})).ok());
}

}  // namespace
}  // namespace eyrie::wire
