// SPDX-License-Identifier: Apache-2.0
// Texture pages as they were written, and of any bytes at all: those must end in DataLoss or in as
// many blocks as were asked for (the sanitizers see to the bounds).
#include "renderer/terrain/imagery/texture_page.h"

#include <cstring>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

std::vector<Bc1Block> blocksOf(std::size_t count, std::uint64_t seed, bool isSmooth) {
    std::vector<Bc1Block> blocks(count);
    std::uint64_t state = seed * 2 + 1;
    for (std::size_t k = 0; k < count; ++k) {
        state = state * 6364136223846793005 + 1442695040888963407;
        const auto noise = static_cast<std::uint32_t>(state >> 32);
        blocks[k] = isSmooth ? Bc1Block{static_cast<std::uint16_t>(0x8410 + k % 7),
                                        static_cast<std::uint16_t>(0x4208 + k % 3), noise & 0x55}
                             : Bc1Block{static_cast<std::uint16_t>(noise),
                                        static_cast<std::uint16_t>(state >> 16), noise * 31};
    }
    return blocks;
}

absl::StatusOr<TexturePage> decoded(std::span<const std::byte> bytes, std::int32_t blocksX,
                                    std::int32_t blocksY) {
    return TexturePage::decode(bytes, blocksX, blocksY, "damaged.eyt: tile 7");
}

RC_GTEST_PROP(TexturePage, IsWhatWasEncoded, ()) {
    const auto blocksX = *rc::gen::inRange<std::int32_t>(1, 131);
    const auto blocksY = *rc::gen::inRange<std::int32_t>(1, 131);
    const std::vector<Bc1Block> blocks =
        blocksOf(static_cast<std::size_t>(blocksX * blocksY), *rc::gen::arbitrary<std::uint64_t>(),
                 *rc::gen::arbitrary<bool>());
    const auto page = decoded(TexturePage::encode(blocks, blocksX), blocksX, blocksY);
    RC_ASSERT(page.ok());
    RC_ASSERT(std::vector(page->blocks().begin(), page->blocks().end()) == blocks);
    RC_ASSERT(page->blocksX() == blocksX);
    RC_ASSERT(page->blocksY() == blocksY);
}

TEST(TexturePage, TakesLittleWhereNeighboursAreAlike) {
    const std::vector<Bc1Block> blocks = blocksOf(std::size_t{130} * 130, 1, true);
    EXPECT_LT(TexturePage::encode(blocks, 130).size(), blocks.size() * sizeof(Bc1Block) / 3);
}

TEST(TexturePage, OfNoiseIsHardlyLargerThanItsBlocks) {
    const std::vector<Bc1Block> blocks = blocksOf(std::size_t{130} * 130, 1, false);
    EXPECT_LT(TexturePage::encode(blocks, 130).size(), blocks.size() * sizeof(Bc1Block) * 21 / 20);
}

TEST(TexturePage, CutOffAnywhereIsDataLoss) {
    const std::vector<std::byte> bytes = TexturePage::encode(blocksOf(12 * 9, 3, true), 12);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const auto page = decoded(std::span(bytes).first(length), 12, 9);
        ASSERT_EQ(page.status().code(), absl::StatusCode::kDataLoss) << length;
        EXPECT_NE(page.status().ToString().find("damaged.eyt: tile 7"), std::string::npos);
    }
}

TEST(TexturePage, OfAnotherSizeIsDataLoss) {
    const std::vector<std::byte> bytes = TexturePage::encode(blocksOf(12 * 9, 3, true), 12);
    for (const auto& [x, y] : {std::pair{12, 8}, {12, 10}, {1, 1}, {130, 130}})
        EXPECT_EQ(decoded(bytes, x, y).status().code(), absl::StatusCode::kDataLoss)
            << x << ' ' << y;
}

TEST(TexturePage, WithAnyBitFlippedIsRefusedOrHasTheSizeAskedFor) {
    for (const bool isSmooth : {false, true}) {
        std::vector<std::byte> bytes = TexturePage::encode(blocksOf(12 * 9, 3, isSmooth), 12);
        for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
            bytes[bit / 8] ^= std::byte{1} << (bit % 8);
            const auto page = decoded(bytes, 12, 9);
            if (page.ok())
                ASSERT_EQ(page->blocks().size(), 12U * 9U) << bit;
            else
                ASSERT_EQ(page.status().code(), absl::StatusCode::kDataLoss) << bit;
            bytes[bit / 8] ^= std::byte{1} << (bit % 8);
        }
    }
}

RC_GTEST_PROP(TexturePage, OfAnyBytesIsDataLossOrHasTheSizeAskedFor, ()) {
    const auto bytes = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
    const auto page = decoded(std::as_bytes(std::span(bytes)), 3, 2);
    const bool isRight = page.ok() ? page->blocks().size() == 6
                                   : page.status().code() == absl::StatusCode::kDataLoss;
    RC_ASSERT(isRight);
}

}  // namespace
}  // namespace eyrie::terrain
