// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/imagery_index.h"

#include <limits>

#include <gtest/gtest.h>

namespace eyrie::terrain {
namespace {

constexpr std::uint64_t kPagesEnd = 1'000'000;

ImageryIndex sampleImagery(const Quadtree& quadtree) {
    ImageryIndex imagery;
    imagery.pyramid = TexturePyramid(quadtree.columns(), quadtree.rows(), 1);
    imagery.psnrDb = 41.5;
    imagery.coveredTexels = 1234;
    for (std::uint32_t k = 0; k < imagery.pyramid.tileCount(); ++k)
        imagery.tiles.push_back({100 * k, k % 3 == 0 ? 0 : 50 + k, k * 77});
    return imagery;
}

TEST(ImageryIndex, IsWhatWasWritten) {
    const Quadtree quadtree(1500, 700);
    const ImageryIndex imagery = sampleImagery(quadtree);
    const auto read = imageryFrom(bytesOf(imagery), quadtree, kPagesEnd, "a.eyt");
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->pyramid.texelShift(), 1);
    EXPECT_EQ(read->psnrDb, imagery.psnrDb);
    EXPECT_EQ(read->coveredTexels, imagery.coveredTexels);
    EXPECT_EQ(read->tiles, imagery.tiles);
    EXPECT_FALSE(read->has({0, 0, 0}));
    EXPECT_TRUE(read->has({0, 1, 0}));
}

TEST(ImageryIndex, CutOffOrTooLongIsDataLoss) {
    const Quadtree quadtree(1500, 700);
    std::vector<std::byte> bytes = bytesOf(sampleImagery(quadtree));
    bytes.resize(bytes.size() + 24);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
        if (size == bytes.size() - 24)
            continue;
        const auto read = imageryFrom(std::span(bytes).first(size), quadtree, kPagesEnd, "a.eyt");
        ASSERT_EQ(read.status().code(), absl::StatusCode::kDataLoss) << size;
        EXPECT_NE(read.status().ToString().find("a.eyt"), std::string::npos);
    }
}

TEST(ImageryIndex, OfImpossibleNumbersIsDataLoss) {
    const Quadtree quadtree(1500, 700);
    const auto codeOf = [&](const ImageryIndex& imagery) {
        return imageryFrom(bytesOf(imagery), quadtree, kPagesEnd, "a.eyt").status().code();
    };
    ImageryIndex imagery = sampleImagery(quadtree);
    imagery.psnrDb = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(codeOf(imagery), absl::StatusCode::kDataLoss);
    imagery = sampleImagery(quadtree);
    imagery.coveredTexels = imagery.finestTexels() + 1;
    EXPECT_EQ(codeOf(imagery), absl::StatusCode::kDataLoss);
    imagery = sampleImagery(quadtree);
    imagery.tiles[2].offset = kPagesEnd - 10;
    EXPECT_EQ(codeOf(imagery), absl::StatusCode::kDataLoss);
    imagery = sampleImagery(quadtree);
    imagery.tiles[2].offset = std::numeric_limits<std::uint64_t>::max();
    EXPECT_EQ(codeOf(imagery), absl::StatusCode::kDataLoss);
    EXPECT_EQ(imageryFrom(bytesOf(sampleImagery(quadtree)), Quadtree(9000, 700), kPagesEnd, "a.eyt")
                  .status()
                  .code(),
              absl::StatusCode::kDataLoss);
}

/// The checksum of the index is checked before; what passes it by chance must not lead astray.
TEST(ImageryIndex, WithAnyBitFlippedIsRefusedOrStaysWithinThePages) {
    const Quadtree quadtree(600, 300);
    std::vector<std::byte> bytes = bytesOf(sampleImagery(quadtree));
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
        const auto read = imageryFrom(bytes, quadtree, kPagesEnd, "a.eyt");
        if (read.ok()) {
            ASSERT_EQ(read->tiles.size(), read->pyramid.tileCount());
            for (const PageRecord& tile : read->tiles)
                ASSERT_LE(tile.offset + tile.bytes, kPagesEnd) << bit;
        } else {
            ASSERT_EQ(read.status().code(), absl::StatusCode::kDataLoss) << bit;
        }
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    }
}

}  // namespace
}  // namespace eyrie::terrain
