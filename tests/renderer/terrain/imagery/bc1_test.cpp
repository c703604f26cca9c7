// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/imagery/bc1.h"

#include <cmath>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyrie::terrain {
namespace {

using fabric::Rgba;

BlockTexels filled(const Rgba& texel) {
    BlockTexels block;
    block.fill(texel);
    return block;
}

int largestDifference(const BlockTexels& a, const BlockTexels& b) {
    int most = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        most = std::max({most, std::abs(a[k].r - b[k].r), std::abs(a[k].g - b[k].g),
                         std::abs(a[k].b - b[k].b)});
    return most;
}

TEST(Bc1, DecodesAsTheSpecificationSays) {
    // Red and blue; texel 0 shows the first, 1 the second, 2 and 3 the two between.
    const Bc1Block four{0xf800, 0x001f, 0b11100100};
    const BlockTexels texels = decodeBc1(four);
    EXPECT_EQ(texels[0], (Rgba{255, 0, 0, 255}));
    EXPECT_EQ(texels[1], (Rgba{0, 0, 255, 255}));
    EXPECT_EQ(texels[2], (Rgba{170, 0, 85, 255}));
    EXPECT_EQ(texels[3], (Rgba{85, 0, 170, 255}));
    EXPECT_EQ(texels[4], texels[0]);

    const BlockTexels three = decodeBc1({0x001f, 0xf800, 0b11100100});
    EXPECT_EQ(three[2], (Rgba{128, 0, 128, 255}));
    EXPECT_EQ(three[3], (Rgba{0, 0, 0, 0}));
}

RC_GTEST_PROP(Bc1, OneColourIsKeptToItsFiveOrSixBits, ()) {
    const Rgba texel{*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint8_t>(),
                     *rc::gen::arbitrary<std::uint8_t>(), 255};
    RC_ASSERT(largestDifference(decodeBc1(encodeBc1(filled(texel))), filled(texel)) <= 4);
}

RC_GTEST_PROP(Bc1, KeepsHolesWhereTheyAre, ()) {
    BlockTexels texels;
    for (Rgba& texel : texels)
        texel = {*rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint8_t>(),
                 *rc::gen::arbitrary<std::uint8_t>(), *rc::gen::arbitrary<std::uint8_t>()};
    const BlockTexels drawn = decodeBc1(encodeBc1(texels));
    for (std::size_t k = 0; k < texels.size(); ++k)
        RC_ASSERT(drawn[k].a == (texels[k].a < 128 ? 0 : 255));
}

/// A block whose colours lie on a line, which BC1 is made for.
RC_GTEST_PROP(Bc1, KeepsAGradientWithinAThirdOfItsSteps, ()) {
    const int low = *rc::gen::inRange(0, 100);
    const int high = *rc::gen::inRange(110, 256);
    BlockTexels texels;
    for (std::size_t k = 0; k < texels.size(); ++k) {
        const auto value = static_cast<std::uint8_t>(low + (high - low) * static_cast<int>(k) / 15);
        texels[k] = {value, value, value, 255};
    }
    RC_ASSERT(largestDifference(decodeBc1(encodeBc1(texels)), texels) <= (high - low) / 6 + 8);
}

TEST(Bc1, DecodesManyBlocksAsOneByOne) {
    std::vector<Bc1Block> blocks;
    for (std::uint32_t k = 0; k < 15; ++k)
        blocks.push_back({static_cast<std::uint16_t>(k * 4001), static_cast<std::uint16_t>(k * 777),
                          k * 2654435761U});
    constexpr std::int32_t kAcross = 5;
    std::vector<Rgba> texels(16 * blocks.size());
    decodeBc1(blocks, kAcross, texels);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const BlockTexels block = decodeBc1(blocks[k]);
        for (std::size_t t = 0; t < 16; ++t) {
            const std::size_t x = k % kAcross * 4 + t % 4;
            const std::size_t y = k / kAcross * 4 + t / 4;
            EXPECT_EQ(texels[y * 4 * kAcross + x], block[t]) << k << ' ' << t;
        }
    }
}

}  // namespace
}  // namespace eyrie::terrain
